// Reference: the definition of one-at-a-time variation, and the paper's own method (all masses 1, every vertex bound).
#include "experiments/studies/jiggle/jiggle_settings.hpp"
#include "pbs/solver/options.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using experiments::JiggleSetting;

TEST(JiggleSettings, ChangeOneThingAtATimeAndHoldPairs)
{
    const auto settings = experiments::jiggle_settings();
    ASSERT_EQ(settings.front(), JiggleSetting{});
    for (const JiggleSetting& s : settings) {
        const JiggleSetting base;
        EXPECT_LE((s.k_stretch != base.k_stretch) + (s.time_step_s != base.time_step_s) + (s.iterations != base.iterations) +
                      (s.masses != base.masses) + (s.k_bind != base.k_bind),
                  1);
    }
    for (const int twice : {12, 24, 48, 96})
        EXPECT_TRUE(std::any_of(settings.begin(), settings.end(), [&](const auto& s) { return s.iterations == twice / 2; })) << twice;
}

TEST(JiggleSettings, LooseFleshAndLumpedMassesAreNotThePapers)
{
    EXPECT_TRUE(experiments::is_of_the_paper({.k_stretch = 0.9, .time_step_s = 0.04, .iterations = 96}));
    EXPECT_FALSE(experiments::is_of_the_paper({.k_bind = 0.0}));
    EXPECT_FALSE(experiments::is_of_the_paper({.masses = pbs::Masses::lumped}));
}

TEST(JiggleSettings, LeaveGravityAsItIs)
{
    experiments::DeformerSpec spec = experiments::default_spec("pbs");
    experiments::options_of<pbs::PbsOptions>(spec).gravity_m_s2 = {0.0, -9.81, 0.0};
    const auto jiggling = experiments::options_of<pbs::PbsOptions>(experiments::jiggling(spec, {.iterations = 6}));
    EXPECT_EQ(jiggling.gravity_m_s2, pbs::Vec3(0.0, -9.81, 0.0));
    EXPECT_EQ(jiggling.iterations, 6);
}

}  // namespace
