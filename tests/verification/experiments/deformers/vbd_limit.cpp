// Reference: finite elements (deal.II, Newton's method), which share neither the energy nor the solver with vertex block descent, on the
// same mesh, with the same attachment and material.
#include "tests/support/flesh_reference.hpp"

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
