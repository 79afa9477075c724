// Reference: finite elements (deal.II, Newton's method), which share neither the energy nor the solver with these deformers. A deformer
// that minimises the energy of neo-Hookean flesh has to converge to the same solution on the same mesh.

#include "tests/support/flesh_reference.hpp"

namespace {

using experiments::default_spec;
using experiments::DeformerSpec;
using test_support::FleshReference;

// The deformer of a kind as a scene with these lines sets it.
DeformerSpec spec_of(const std::string& kind, const std::vector<std::string>& settings)
{
    std::vector<std::string> all = settings;
    all.insert(all.end(), {"deformers.use=[\"" + kind + "\"]", "reference.name=\"\""});
    return experiments::spec_of(experiments::read_scene("limb_twist", all), kind);
}

DeformerSpec quasi_newton(int iterations, double poisson, const std::string& start)
{
    return spec_of("quasi_newton",
                   {"quasi_newton.iterations=" + std::to_string(iterations), "quasi_newton.poisson=" + std::to_string(poisson),
                    "quasi_newton.start=\"" + start + "\"", "quasi_newton.precision=f64"});
}

// Four times the iterations lower the difference at least to a half until it is below 1e-6.
void expect_convergence(const FleshReference& reference, double poisson, const std::string& start)
{
    double last = 2.0;
    for (const int iterations : {4, 16, 64, 256, 1024}) {
        const double difference = reference.difference(quasi_newton(iterations, poisson, start));
        if (last > 1e-6) {
            EXPECT_LT(difference, 0.5 * last) << iterations << " iterations, nu " << poisson;
        }
        last = difference;
    }
    EXPECT_LT(last, 1e-6);
}

class FleshLimits : public testing::TestWithParam<double> {};

TEST_P(FleshLimits, QuasiNewtonOfTheTwistedLimb)
{
    expect_convergence({"limb_twist", {"motion.angle_deg=90", "motion.frames=2", "character.vertices=600"}, 1, GetParam()}, GetParam(),
                       "lbs");
}

TEST_P(FleshLimits, QuasiNewtonOfTheBentLimb)
{
    expect_convergence({"limb_bend", {"motion.angle_deg=60", "motion.frames=2", "character.vertices=600"}, 1, GetParam()}, GetParam(),
                       "smooth_dqs");
}

TEST_P(FleshLimits, QuasiNewtonOfTheHumansCrouch)
{
    expect_convergence({"human_01_01", {}, 164, GetParam()}, GetParam(), "smooth_dqs");
}

INSTANTIATE_TEST_SUITE_P(PoissonsRatios, FleshLimits, testing::Values(0.3, 0.45));

}  // namespace

// Reference: finite elements (deal.II, Newton's method), which share neither the energy nor the solver with vertex block descent, on the
// same mesh, with the same attachment and material.

namespace {

using test_support::FleshReference;

double difference_after(const FleshReference& reference, int sweeps, double poisson, const std::string& acceleration)
{
    const experiments::Scene scene =
        experiments::read_scene("limb_twist", {"deformers.use=[\"vbd\"]", "reference.name=\"\"", "vbd.iterations=" + std::to_string(sweeps),
                                               "vbd.poisson=" + std::to_string(poisson), "vbd.acceleration=\"" + acceleration + "\"",
                                               "vbd.precision=f64"});
    return reference.difference(experiments::spec_of(scene, "vbd"));
}

// Twice the sweeps lower the difference until it is below 1e-6. The rest is the tolerance of the reference's own iteration.
void expect_convergence(const FleshReference& reference, double poisson, const std::string& acceleration, int last_sweeps)
{
    double last = 2.0;
    for (int sweeps = 16; sweeps <= last_sweeps; sweeps *= 2) {
        const double difference = difference_after(reference, sweeps, poisson, acceleration);
        if (last > 1e-6) {
            EXPECT_LT(difference, 0.9 * last) << sweeps << " sweeps, nu " << poisson;
        }
        last = difference;
    }
    EXPECT_LT(last, 1e-6);
}

class VbdLimit : public testing::TestWithParam<double> {};

TEST_P(VbdLimit, OfTheTwistedLimbIsTheReference)
{
    const FleshReference reference("limb_twist", {"motion.angle_deg=90", "motion.frames=2", "character.vertices=600"}, 1, GetParam());
    expect_convergence(reference, GetParam(), "over_relaxation", 512);
    expect_convergence(reference, GetParam(), "chebyshev", 2048);
}

TEST_P(VbdLimit, OfTheBentLimbIsTheReference)
{
    const FleshReference reference("limb_bend", {"motion.angle_deg=60", "motion.frames=2", "character.vertices=600"}, 1, GetParam());
    expect_convergence(reference, GetParam(), "over_relaxation", 512);
}

TEST_P(VbdLimit, OfTheHumansCrouchIsTheReference)
{
    const FleshReference reference("human_01_01", {}, 164, GetParam());
    expect_convergence(reference, GetParam(), "over_relaxation", 512);
}

INSTANTIATE_TEST_SUITE_P(PoissonsRatios, VbdLimit, testing::Values(0.3, 0.45));

}  // namespace

// Reference: finite elements (deal.II, Newton's method), which share neither the energy nor the solver with XPBD. With multipliers kept
// over the steps it has to converge to the same solution on the same mesh; as published it does not.

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
