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
