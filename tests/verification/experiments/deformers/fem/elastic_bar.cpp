// Reference: objectivity of the laws; the independence of an equilibrium from the path to it; the small-strain limit, which is the linear
// reference; the motions that the bind constraint allows and prevents. The body is the bar of two bones.
#include "experiments/deformers/fem/fem_deformers.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/newton_rounding.hpp"

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
    static const pbs::Character character = test_support::bar_character({12, 2, 2});
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

// If the whole pose and gravity are rotated, the solution rotates with them. Tolerance: the error that Newton's method leaves in each of
// the two solutions, and the rounding of positions that the motion carries away.
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
    const double error_m = test_support::newton_error_m(bar(), options, bent, here);
    EXPECT_LT(largest_distance(deformed(along, {moved}), there), 2.0 * error_m + test_support::frame_rounding_m(there));
    EXPECT_LT(error_m, 1e-5) << "a bound that would let another shape of the bar of 2 m pass proves nothing";
}

// Below the load at which the flesh buckles there is one equilibrium. Tolerance: the error that Newton's method leaves in each solution.
TEST_P(ElasticBar, DoesNotRememberTheWay)
{
    const pbs::Pose end = turned(60.0, Vec3::UnitZ());
    const Positions jumped = deformed(options, {end});
    const Positions stepped =
        deformed(options, {turned(20.0, Vec3::UnitZ()), turned(50.0, Vec3::UnitY()), turned(30.0, Vec3::UnitZ()), end});
    EXPECT_LT(largest_distance(jumped, stepped), 2.0 * test_support::newton_error_m(bar(), options, end, jumped));
}

INSTANTIATE_TEST_SUITE_P(Laws, ElasticBar,
                         testing::Combine(testing::Values(Model::stable_neo_hookean, Model::corotational, Model::neo_hookean),
                                          testing::Values(FemAttachment::embedded, FemAttachment::nodes)));

// The nonlinear part is c a^2 (1 + d a + ...) of the angle a: a quarter at half the angle, except for the factor (1 + d a) / (1 + d a / 2),
// which is within 10 % of 1 for |d| < 6 at a = 2 degrees = 0.035. The strains are at most of the order of a, so d is of order one. A
// part of first or third order would give 2 or 8.
class SmallAngles : public testing::TestWithParam<Model> {};

TEST_P(SmallAngles, TheDifferenceFromTheLinearReferenceIsOfSecondOrder)
{
    for (const int order : {1, 2}) {
        FemOptions options{.model = GetParam(), .element_order = order}, linear = options;
        linear.model = Model::linear;
        std::vector<double> difference;
        for (const double angle_deg : {2.0, 1.0}) {
            const std::vector<pbs::Pose> frames = {turned(angle_deg, Vec3::UnitZ())};
            const Positions nonlinear = deformed(options, frames);
            difference.push_back(largest_distance(nonlinear, deformed<LinearFemDeformer>(linear, frames)));
            EXPECT_LT(test_support::newton_error_m(bar(), options, frames.back(), nonlinear), 1e-3 * difference.back());
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
    const Positions displacement = deformed(options, frames);
    EXPECT_LT(largest_distance(displacement, deformed(mean, frames)),
              2.0 * test_support::newton_error_m(bar(), options, frames.back(), displacement));
}

// The bind constraint only keeps distances to the bone. A rotation about the bone itself moves no bind point, so the flesh does not move.
// Tolerance: the rounding of the bind points, whose forces Newton's method accepts at rest.
TEST(BoundBar, ATwistAboutTheBoneIsHeldByNothing)
{
    FemOptions bound{.model = Model::stable_neo_hookean, .element_order = 1, .attachment = FemAttachment::bind};
    EXPECT_LT(largest_distance(deformed(bound, {turned(90.0, Vec3::UnitX())}), bar().mesh.rest),
              test_support::frame_rounding_m(bar().mesh.rest));
}

}  // namespace
