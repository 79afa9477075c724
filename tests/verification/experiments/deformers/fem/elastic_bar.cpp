// Reference: objectivity of the laws; the independence of an equilibrium from the path to it; the small-strain limit, which is the linear
// reference; the motions that the bind constraint allows and prevents. The body is the bar of two bones.
#include "experiments/deformers/fem/elastic_fem_deformer.hpp"
#include "experiments/deformers/fem/linear_fem_deformer.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;
using pbs::Positions;
using pbs::Vec3;
using reference_fem::Formulation;
using reference_fem::Model;

const Eigen::Isometry3d motion = Eigen::Translation3d(3, -1, 2) * Eigen::AngleAxisd(2.0, Vec3(1, 2, -3).normalized());

const pbs::Character& bar()
{
    static const pbs::Character character = test_support::bar_character({24, 4, 4});
    return character;
}

pbs::Pose turned(double angle_deg, const Vec3& axis)
{
    return pbs::joint_sweep(bar().skeleton, 1, axis, angle_deg, 2, 0.01).steps.back();
}

template <typename Fem = ElasticFemDeformer>
Positions deformed(const FemOptions& options, const std::vector<pbs::Pose>& frames)
{
    Fem fem(options);
    fem.reset(bar());
    for (const pbs::Pose& pose : frames) EXPECT_EQ(fem.advance(pose, 0.01).outcome, pbs::Outcome::finished);
    return fem.positions();
}

double largest_distance(const Positions& a, const Positions& b)
{
    return (a - b).rowwise().norm().maxCoeff();
}

using Case = std::tuple<Model, FemAttachment>;
class ElasticBar : public testing::TestWithParam<Case> {
protected:
    FemOptions options{.model = std::get<0>(GetParam()), .element_order = 1, .attachment = std::get<1>(GetParam()), .core_radius = 1.0};
};

// If the whole pose and gravity are rotated, the solution rotates with them. Newton stops at 1e-8 of the forces. The softest motion of a
// bar with E = 1e5 Pa, 2 m long and with free ends, is some 1e3 times that of a uniform strain with this stress: 1e-8 * 1e3 * 2 m = 2e-5 m.
TEST_P(ElasticBar, IsObjective)
{
    FemOptions along = options;
    options.gravity_m_s2 = Vec3(0, -1, 0.2);
    along.gravity_m_s2 = motion.linear() * options.gravity_m_s2;
    const pbs::Pose bent = turned(40.0, Vec3::UnitZ());
    pbs::Pose moved = bent;
    for (auto& bone : moved) bone = motion * bone;
    const Positions here = deformed(options, {bent});
    const Positions there = (here * motion.linear().transpose()).rowwise() + motion.translation().transpose();
    EXPECT_LT(largest_distance(deformed(along, {moved}), there), 2e-5);
}

// Below the load at which the flesh buckles there is one equilibrium. The tolerance is the same.
TEST_P(ElasticBar, DoesNotRememberTheWay)
{
    const pbs::Pose end = turned(60.0, Vec3::UnitZ());
    const Positions jumped = deformed(options, {end});
    const Positions stepped =
        deformed(options, {turned(20.0, Vec3::UnitZ()), turned(50.0, Vec3::UnitY()), turned(30.0, Vec3::UnitZ()), end});
    EXPECT_LT(largest_distance(jumped, stepped), 2e-5);
}

INSTANTIATE_TEST_SUITE_P(Laws, ElasticBar,
                         testing::Combine(testing::Values(Model::stable_neo_hookean, Model::corotational, Model::neo_hookean),
                                          testing::Values(FemAttachment::embedded, FemAttachment::nodes)));

// The nonlinear part falls with the square of the angle: a quarter at half the angle, within 10 %.
class SmallAngles : public testing::TestWithParam<Model> {};

TEST_P(SmallAngles, TheDifferenceFromTheLinearReferenceIsOfSecondOrder)
{
    for (const int order : {1, 2}) {
        FemOptions options{.model = GetParam(), .element_order = order}, linear = options;
        linear.model = Model::linear;
        std::vector<double> difference;
        for (const double angle_deg : {2.0, 1.0}) {
            const std::vector<pbs::Pose> frames = {turned(angle_deg, Vec3::UnitZ())};
            difference.push_back(largest_distance(deformed(options, frames), deformed<LinearFemDeformer>(linear, frames)));
        }
        EXPECT_NEAR(difference[0] / difference[1], 4.0, 0.4) << "order " << order;
    }
}

INSTANTIATE_TEST_SUITE_P(Laws, SmallAngles,
                         testing::Values(Model::corotational, Model::stable_neo_hookean, Model::neo_hookean, Model::st_venant_kirchhoff));

TEST(MeanDilatation, OnLinearTetsItIsTheDisplacementFormulation)
{
    FemOptions options{.model = Model::stable_neo_hookean, .element_order = 1, .poisson = 0.49}, mean = options;
    mean.formulation = Formulation::mean_dilatation;
    const std::vector<pbs::Pose> frames = {turned(30.0, Vec3::UnitZ())};
    EXPECT_LT(largest_distance(deformed(options, frames), deformed(mean, frames)), 1e-9);
}

// The bind constraint only keeps distances to the bone. A rotation about the bone itself moves no bind point, so the flesh does not move.
TEST(BoundBar, ATwistAboutTheBoneIsHeldByNothing)
{
    FemOptions bound{.model = Model::stable_neo_hookean, .element_order = 1, .attachment = FemAttachment::bind};
    EXPECT_LT(largest_distance(deformed(bound, {turned(90.0, Vec3::UnitX())}), bar().mesh.rest), 1e-12);
}

}  // namespace
