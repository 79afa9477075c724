// The figures of C09 from made-up responses. Truth: the ratios and ranks of the frequencies put in.
#include "experiments/jiggle/jiggle_settings.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using experiments::JiggleSetting;
using experiments::MeasuredJiggle;

MeasuredJiggle swinging(const JiggleSetting& setting, double hz)
{
    MeasuredJiggle measured{setting, {}};
    measured.response.swing.outcome = analysis::OscillationOutcome::found;
    measured.response.swing.frequency_hz = {hz, 0.9 * hz, 1.1 * hz};
    measured.response.swing.damping_ratio = {0.1, 0.08, 0.12};
    return measured;
}

std::vector<analysis::Measurement> of_quantity(const std::vector<MeasuredJiggle>& measured, const std::string& quantity)
{
    std::vector<analysis::Measurement> chosen;
    for (const auto& figure : experiments::jiggle_figures("limb", measured))
        if (figure.quantity == quantity) chosen.push_back(figure);
    return chosen;
}

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

TEST(JiggleSettings, RatioIsOfTheHalvedStepOverTheWhole)
{
    const auto ratios = of_quantity({swinging({}, 6.0), swinging({.time_step_s = 0.005}, 12.0), swinging({.iterations = 48}, 9.0)},
                                    "frequency at half the time step over at the whole");
    ASSERT_EQ(ratios.size(), 1u);
    EXPECT_DOUBLE_EQ(ratios[0].value, 2.0);
    EXPECT_NEAR(ratios[0].low, 2.0 * 0.9 / 1.1, 1e-12);
    EXPECT_NEAR(ratios[0].high, 2.0 * 1.1 / 0.9, 1e-12);
    EXPECT_NE(ratios[0].of.find("10 ms"), std::string::npos);
}

TEST(JiggleSettings, RatioOfTwiceTheIterations)
{
    const auto ratios =
        of_quantity({swinging({}, 6.0), swinging({.iterations = 48}, 9.0)}, "frequency at twice the iterations over at the once");
    ASSERT_EQ(ratios.size(), 1u);
    EXPECT_DOUBLE_EQ(ratios[0].value, 1.5);
}

TEST(JiggleSettings, CorrelationIsOfRanksAndTakesTheLeastWithoutOne)
{
    std::vector<MeasuredJiggle> measured = {swinging({.k_stretch = 0.05}, 2.0), swinging({}, 3.0), swinging({.k_stretch = 0.2}, 50.0),
                                            swinging({.k_stretch = 0.5}, 51.0)};
    const char* const quantity = "rank correlation of frequency and k_stretch";
    ASSERT_EQ(of_quantity(measured, quantity).size(), 1u);
    EXPECT_DOUBLE_EQ(of_quantity(measured, quantity)[0].value, 1.0);
    EXPECT_DOUBLE_EQ(of_quantity(measured, quantity)[0].low, 1.0);
    measured.push_back(swinging({.k_stretch = 1.0}, 1.0));
    EXPECT_NEAR(of_quantity(measured, quantity)[0].value, 0.0, 1e-12);  // sum of squared rank differences 20: 1 - 6 * 20 / (5 * 24)
    EXPECT_LT(of_quantity(measured, quantity)[0].low, 0.0);
}

TEST(JiggleSettings, WhatDoesNotSwingHasNoFigures)
{
    MeasuredJiggle creeping = swinging({}, 3.0);
    creeping.response.swing.outcome = analysis::OscillationOutcome::overdamped;
    EXPECT_TRUE(experiments::jiggle_figures("limb", {creeping}).empty());
    EXPECT_TRUE(experiments::jiggle_figures("limb", {}).empty());
}

}  // namespace
