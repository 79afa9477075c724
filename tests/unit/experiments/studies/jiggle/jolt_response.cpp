// Reference: necessary behaviour. Flesh that does not jiggle follows the bones; flesh without constraints stays behind, at rest; a jolt in
// the opposite direction gives the mirror image.
#include "experiments/studies/jiggle/jolt_response.hpp"

#include "experiments/studies/jiggle/jiggle_settings.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/character/overlap_and_jiggle.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/step_rounding.hpp"

#include <gtest/gtest.h>

namespace {

class JoltResponseOfLimb : public testing::Test {
protected:
    JoltResponseOfLimb()
    {
        options().precision = pbs::Precision::f64;
        jolt.direction = pbs::Vec3::UnitX();
        jolt.steps = 40;
    }
    pbs::PbsOptions& options() { return experiments::options_of<pbs::PbsOptions>(spec); }
    experiments::JoltResponse response() const { return experiments::jolt_response(limb, spec, probe, jolt); }

    pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 400});
    std::vector<int> probe = pbs::zone_contents(limb).pieces.front();
    experiments::DeformerSpec spec = experiments::default_spec("pbs");
    experiments::Jolt jolt;
};

TEST_F(JoltResponseOfLimb, NothingSwingsWithoutJiggle)
{
    options().jiggle.reset();
    const auto still = response();
    // Every step begins with LBS, so that two steps differ by their roundings alone.
    const double rounding_m = 2.0 * test_support::step_rounding_m(test_support::two_bones_in(limb.mesh), options());
    EXPECT_LT(still.peak_over_jolt, rounding_m / jolt.length_m);
    EXPECT_FALSE(still.swing.found());
}

TEST_F(JoltResponseOfLimb, FreeFleshStaysBehind)
{
    options().k_stretch = options().k_volume = options().k_bind = 0.0;
    options().jiggle = pbs::Jiggle{.k_stretch = 0.0};
    const auto free = response();
    const double rounding_m = test_support::mean_error(probe.size(), jolt.length_m);
    for (const double excursion_m : free.excursion_m) EXPECT_NEAR(excursion_m, -jolt.length_m, rounding_m);
    EXPECT_EQ(free.left_over_peak, 1.0);  // all excursions are equal
    EXPECT_EQ(free.overshoot_over_jolt, 0.0);
}

// The motion from step to step does not depend on time (Algorithm 1, lines 7, 8 and 16). A quarter of a time step and four times a velocity
// are exact.
TEST_F(JoltResponseOfLimb, WithoutWeightTheSeriesIsTheSameAtEveryTimeStep)
{
    spec = experiments::jiggling(spec, {});
    const auto slow = response();
    jolt.time_step_s /= 4.0;
    const auto quick = response();
    EXPECT_EQ(quick.excursion_m, slow.excursion_m);
}

// The bones hold the skin: it swings about the place to which they move it, and comes to rest.
TEST_F(JoltResponseOfLimb, HeldFleshSwingsAndCalmsDown)
{
    spec = experiments::jiggling(spec, {});
    const auto held = response();
    EXPECT_TRUE(held.finished);
    EXPECT_GT(held.peak_over_jolt, 0.05);
    EXPECT_LT(held.peak_over_jolt, 1.0);
    EXPECT_LT(held.left_over_peak, 0.5);
    EXPECT_LT(held.speed_growth, 1.0);
}

}  // namespace
