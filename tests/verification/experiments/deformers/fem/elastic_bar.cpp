// Reference: objectivity of the laws; the independence of an equilibrium from the path to it; the small-strain limit,
// which is the linear reference; the motions that the bind constraint allows and prevents. The body is the bar of two
// bones.
#include "tests/support/fem_bar.hpp"
#include "tests/support/newton_rounding.hpp"

namespace elastic_bar_tests {
namespace {

using namespace experiments;
using namespace test_support;
using pbs::Positions;
using pbs::Vec3;
using reference_fem::Formulation;
using reference_fem::Model;

const pbs::Character& bar()
{
    static const pbs::Character character = bar_character({12, 2, 2});
    return character;
}

using Case = std::tuple<Model, FemAttachment>;
class ElasticBar : public testing::TestWithParam<Case> {
protected:
    FemOptions options{.model = std::get<0>(GetParam()),
                       .element_order = 1,
                       .attachment = std::get<1>(GetParam()),
                       .core_radius = 1.0};
};

// If the whole pose and gravity are rotated, the solution rotates with them. Tolerance: the error that Newton's method
// leaves in each of the two solutions, and the rounding of positions that the motion carries away.
TEST_P(ElasticBar, IsObjective)
{
    FemOptions along = options;
    options.gravity_m_s2 = Vec3(0, -1, 0.2);
    along.gravity_m_s2 = rigid_motion.linear() * options.gravity_m_s2;
    const pbs::Pose bent = turned(40.0);
    const Positions here = deformed(bar(), options, {bent}), there = moved(here);
    const double error_m = newton_error_m(bar(), options, bent, here);
    EXPECT_LT(largest_distance(deformed(bar(), along, {moved(bent)}), there), 2.0 * error_m + frame_rounding_m(there));
    EXPECT_LT(error_m, 1e-5) << "a bound that would let another shape of the bar of 2 m pass proves nothing";
}

// Below the load at which the flesh buckles there is one equilibrium. Tolerance: the error that Newton's method leaves
// in each solution.
TEST_P(ElasticBar, DoesNotRememberTheWay)
{
    const pbs::Pose end = turned(60.0);
    const Positions jumped = deformed(bar(), options, {end});
    const Positions stepped = deformed(bar(), options, {turned(20.0), turned(50.0, Vec3::UnitY()), turned(30.0), end});
    EXPECT_LT(largest_distance(jumped, stepped), 2.0 * newton_error_m(bar(), options, end, jumped));
}

INSTANTIATE_TEST_SUITE_P(Laws, ElasticBar,
                         testing::Combine(testing::Values(Model::stable_neo_hookean, Model::corotational,
                                                          Model::neo_hookean),
                                          testing::Values(FemAttachment::embedded, FemAttachment::nodes)));

// The nonlinear part is c a^2 (1 + d a + ...) of the angle a: a quarter at half the angle, except for the factor (1 + d
// a) / (1 + d a / 2), which is within 10 % of 1 for |d| < 6 at a = 2 degrees = 0.035. The strains are at most of the
// order of a, so d is of order one. A part of first or third order would give 2 or 8.
TEST(SmallAngles, TheDifferenceFromTheLinearReferenceIsOfSecondOrder)
{
    for (const Model model :
         {Model::corotational, Model::stable_neo_hookean, Model::neo_hookean, Model::st_venant_kirchhoff})
        for (const int order : {1, 2}) {
            const FemOptions options{.model = model, .element_order = order}, linear{.element_order = order};
            std::vector<double> difference;
            for (const double angle_deg : {2.0, 1.0}) {
                const pbs::Pose pose = turned(angle_deg);
                const Positions nonlinear = deformed(bar(), options, {pose});
                difference.push_back(largest_distance(nonlinear, deformed(bar(), linear, {pose})));
                EXPECT_LT(newton_error_m(bar(), options, pose, nonlinear), 1e-3 * difference.back());
            }
            EXPECT_NEAR(difference[0] / difference[1], 4.0, 0.4) << name_of(model) << ", order " << order;
        }
}

TEST(MeanDilatation, OnLinearTetsItIsTheDisplacementFormulation)
{
    FemOptions options{.model = Model::stable_neo_hookean, .element_order = 1, .poisson = 0.49}, mean = options;
    mean.formulation = Formulation::mean_dilatation;
    const std::vector<pbs::Pose> frames = {turned(30.0)};
    const Positions displacement = deformed(bar(), options, frames);
    EXPECT_LT(largest_distance(displacement, deformed(bar(), mean, frames)),
              2.0 * newton_error_m(bar(), options, frames.back(), displacement));
}

// The bind constraint only keeps distances to the bone. A rotation about the bone itself moves no bind point, so the
// flesh does not move. Tolerance: the rounding of the bind points, whose forces Newton's method accepts at rest.
TEST(BoundBar, ATwistAboutTheBoneIsHeldByNothing)
{
    FemOptions bound{.model = Model::stable_neo_hookean, .element_order = 1, .attachment = FemAttachment::bind};
    EXPECT_LT(largest_distance(deformed(bar(), bound, {turned(90.0, Vec3::UnitX())}), bar().mesh.rest),
              frame_rounding_m(bar().mesh.rest));
}

// Reference: dimensional analysis. With displacement data, free surfaces and no body force, every force is proportional
// to Young's modulus (also those of the attachment's springs, whose density is q E / r^2). The positions therefore do
// not depend on it, and twist and bend can only determine nu. Multiplied by an even power of two, Young's modulus
// changes no digit of a force, of a root in Cholesky's factorisation or of a quotient of forces, and Newton's stopping
// criterion is relative to the forces: the positions are equal to the bit.

class YoungCancels : public testing::TestWithParam<std::tuple<Model, int, FemAttachment>> {
protected:
    // How far the positions with the joint twisted and bent at once are from each other for two of Young's moduli.
    double difference(FemOptions one, FemOptions other, double young_pa, double other_young_pa, double angle_deg) const
    {
        one.young_pa = young_pa;
        other.young_pa = other_young_pa;
        const std::vector<pbs::Pose> frames = {turned(angle_deg, Vec3(1, 0, 1).normalized())};
        return largest_distance(deformed(thick_bar, one, frames), deformed(thick_bar, other, frames));
    }

    const pbs::Character thick_bar = bar_character({12, 3, 3});
};

TEST_P(YoungCancels, WhereTheSkeletonIsAllThatActsButNotWhereAForceActs)
{
    const auto& [model, element_order, attachment] = GetParam();
    FemOptions options{.model = model, .element_order = element_order, .attachment = attachment, .core_radius = 1.0};
    const double angle_deg = model == Model::linear ? 5.0 : 40.0;
    EXPECT_EQ(difference(options, options, 1e3, 0x1p14 * 1e3, angle_deg), 0.0);
    options.gravity_m_s2 = Vec3(0, 0, -1);
    EXPECT_GT(difference(options, options, 1e5, 1e7, angle_deg), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Laws, YoungCancels,
                         testing::Combine(testing::Values(Model::linear, Model::stable_neo_hookean),
                                          testing::Values(1, 2),
                                          testing::Values(FemAttachment::embedded, FemAttachment::nodes)));

using YoungCancelsSprings = YoungCancels;

TEST_F(YoungCancelsSprings, OnlyBecauseTheirDensityGoesWithIt)
{
    const FemOptions stiff{.element_order = 1, .core_radius = 1.0, .spring_factor = 1e4};
    FemOptions same_springs = stiff;
    same_springs.spring_factor *= 1e3 / 1e7;
    EXPECT_GT(difference(stiff, same_springs, 1e3, 1e7, 5.0), 1e-5);
}

}  // namespace
}  // namespace elastic_bar_tests
