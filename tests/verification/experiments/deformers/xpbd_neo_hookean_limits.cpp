// Reference: finite elements (deal.II, Newton's method), which share neither the energy nor the solver with XPBD. With multipliers kept
// over the steps it has to converge to the same solution on the same mesh; as published it does not.
#include "tests/support/flesh_reference.hpp"

namespace {

using experiments::DeformerSpec;
using test_support::FleshReference;

DeformerSpec xpbd(int iterations, double poisson, const std::vector<std::string>& more = {})
{
    std::vector<std::string> settings{
        "deformers.use=[\"xpbd_neo_hookean\"]", "reference.name=\"\"", "xpbd_neo_hookean.precision=f64",
        "xpbd_neo_hookean.iterations=" + std::to_string(iterations), "xpbd_neo_hookean.poisson=" + std::to_string(poisson)};
    settings.insert(settings.end(), more.begin(), more.end());
    return experiments::spec_of(experiments::read_scene("limb_twist", settings), "xpbd_neo_hookean");
}

// Four times the iterations lower the difference at least to a half until it is below 1e-6.
void expect_convergence(const FleshReference& reference, double poisson)
{
    double last = 2.0;
    for (const int iterations : {16, 64, 256, 1024}) {
        const double difference = reference.difference(xpbd(iterations, poisson));
        if (last > 1e-6) {
            EXPECT_LT(difference, 0.5 * last) << iterations << " iterations, nu " << poisson;
        }
        last = difference;
    }
    EXPECT_LT(last, 1e-6);
}

class XpbdNeoHookeanLimits : public testing::TestWithParam<double> {};

TEST_P(XpbdNeoHookeanLimits, OfTheTwistedLimb)
{
    expect_convergence({"limb_twist", {"motion.angle_deg=90", "motion.frames=2", "character.vertices=600"}, 1, GetParam()}, GetParam());
}

TEST_P(XpbdNeoHookeanLimits, OfTheBentLimb)
{
    expect_convergence({"limb_bend", {"motion.angle_deg=60", "motion.frames=2", "character.vertices=600"}, 1, GetParam()}, GetParam());
}

TEST_P(XpbdNeoHookeanLimits, OfTheHumansCrouch)
{
    expect_convergence({"human_01_01", {}, 164, GetParam()}, GetParam());
}

INSTANTIATE_TEST_SUITE_P(PoissonsRatios, XpbdNeoHookeanLimits, testing::Values(0.3, 0.45));

// The control: the multipliers of each step begin at zero and the residual is neglected, or they are reset in each iteration.
TEST(XpbdNeoHookeanControls, AsPublishedOrWithResetMultipliersItStopsElsewhere)
{
    const FleshReference reference("limb_twist", {"motion.angle_deg=90", "motion.frames=2", "character.vertices=600"}, 1, 0.45);
    for (const std::string multipliers : {"of_step", "reset"}) {
        const std::vector<std::string> control{"xpbd_neo_hookean.multipliers=\"" + multipliers + "\"",
                                               "xpbd_neo_hookean.iterations_per_step=4"};
        EXPECT_GT(reference.difference(xpbd(1024, 0.45, control)), 1e-3) << multipliers;
    }
}

}  // namespace
