// The values of C09 from invented responses. Reference: the ratios and ranks of the given frequencies.
#include "tests/support/jiggle_responses.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using experiments::MeasuredJiggle;
using test_support::creeping;
using test_support::swinging;

std::vector<analysis::Measurement> of_quantity(const std::vector<MeasuredJiggle>& measured, const std::string& quantity)
{
    std::vector<analysis::Measurement> chosen;
    for (const auto& measurement : experiments::jiggle_values("limb", measured))
        if (measurement.quantity == quantity) chosen.push_back(measurement);
    return chosen;
}

const char* const share = "share_of_settings_that_swing";
const char* const half_step = "frequency_ratio_at_half_time_step";
const char* const correlation = "rank_correlation_of_frequency_and_k_stretch";
const char* const range = "frequency_ratio_over_k_stretch";

TEST(JiggleFigures, WhatDoesNotSwingCountsInTheShare)
{
    const auto shares = of_quantity({swinging({}, 3.0), creeping({.iterations = 96}), creeping({.iterations = 48}),
                                     swinging({.k_stretch = 0.5}, 4.0), creeping({.masses = pbs::Masses::lumped})},
                                    share);
    ASSERT_EQ(shares.size(), 1u);
    EXPECT_DOUBLE_EQ(shares[0].value, 0.5);
    EXPECT_EQ(shares[0].of, analysis::CaseKey{.body = "limb"});
    EXPECT_EQ(shares[0].n, 4);
}

TEST(JiggleFigures, WhatDoesNotSwingHasNeitherFrequencyNorDamping)
{
    const auto measurements = experiments::jiggle_values("limb", {creeping({})});
    ASSERT_EQ(measurements.size(), 2u);  // share, amplitude
    EXPECT_EQ(measurements[0].value, 0.0);
    EXPECT_EQ(measurements[1].quantity, "amplitude");
    EXPECT_TRUE(experiments::jiggle_values("limb", {}).empty());
}

TEST(JiggleFigures, WhatBrokeDownHasNoAmplitude)
{
    MeasuredJiggle broken = creeping({});
    broken.response.finished = false;
    EXPECT_TRUE(of_quantity({broken}, "amplitude").empty());
    EXPECT_EQ(of_quantity({broken}, share).size(), 1u);
}

TEST(JiggleFigures, OtherReadingsHaveTheirOwnDampingRatio)
{
    const std::vector<MeasuredJiggle> measured = {swinging({}, 3.0), swinging({.k_bind = 0.0}, 3.0),
                                                  swinging({.masses = pbs::Masses::lumped}, 3.0)};
    EXPECT_EQ(of_quantity(measured, "damping_ratio").size(), 1u);
    EXPECT_EQ(of_quantity(measured, "damping_ratio_in_other_readings").size(), 2u);
    EXPECT_DOUBLE_EQ(of_quantity(measured, share)[0].value, 1.0);
}

TEST(JiggleFigures, HalfTheStepIsOneFigureWithTheRangeOverAllHalvings)
{
    const auto ratios = of_quantity({swinging({}, 6.0), swinging({.time_step_s = 0.005}, 12.0), swinging({.time_step_s = 0.0025}, 27.0),
                                     swinging({.time_step_s = 0.02}, 4.0), swinging({.iterations = 48}, 9.0)},
                                    half_step);
    ASSERT_EQ(ratios.size(), 1u);
    EXPECT_DOUBLE_EQ(ratios[0].value, 12.0 / 6.0);
    EXPECT_DOUBLE_EQ(ratios[0].low, 6.0 / 4.0);
    EXPECT_DOUBLE_EQ(ratios[0].high, 27.0 / 12.0);
    EXPECT_EQ(text_of(ratios[0].of), "limb, k_stretch 0.1, masses unit, iterations 24, time_step 0.01 s");
    EXPECT_EQ(ratios[0].n, 3);
}

TEST(JiggleFigures, RatioOfTwiceTheIterationsHasTheEndsOfBothIntervals)
{
    const auto ratios = of_quantity({swinging({}, 6.0), swinging({.iterations = 48}, 9.0)}, "frequency_ratio_at_twice_iterations");
    ASSERT_EQ(ratios.size(), 1u);
    EXPECT_DOUBLE_EQ(ratios[0].value, 1.5);
    // The ends, 1 -+ 0.1 times a frequency, go through three roundings each, and their ratio through one; the numbers here go through four.
    EXPECT_NEAR(ratios[0].low, 1.5 * 0.9 / 1.1, test_support::rounding_error(2 * 3 + 1 + 4, 1.5 * 0.9 / 1.1));
    EXPECT_NEAR(ratios[0].high, 1.5 * 1.1 / 0.9, test_support::rounding_error(2 * 3 + 1 + 4, 1.5 * 1.1 / 0.9));
}

// The correlation of ranks 1 to n is a sum of n products of differences from the mean over the sum of n squares, (n^3 - n) / 12. A
// difference of at most n goes through three roundings of the running mean for each of the n ranks, and so do sums and squares.
double correlation_error(int n)
{
    const double sum = n * (2.0 * 3.0 * n + 3.0) * double(n) * double(n);
    return test_support::rounding_error(2.0 * sum, 12.0 / (std::pow(n, 3) - n)) + test_support::rounding_error(4, 1.0);
}

TEST(JiggleFigures, CorrelationIsOfRanksAndTakesTheLeastWithoutOne)
{
    std::vector<MeasuredJiggle> measured = {swinging({.k_stretch = 0.05}, 2.0), swinging({}, 3.0), swinging({.k_stretch = 0.2}, 50.0),
                                            swinging({.k_stretch = 0.5}, 51.0)};
    ASSERT_EQ(of_quantity(measured, correlation).size(), 1u);
    EXPECT_DOUBLE_EQ(of_quantity(measured, correlation)[0].value, 1.0);
    measured.push_back(swinging({.k_stretch = 1.0}, 1.0));
    // The sum of squared differences of ranks is 20: 1 - 6 * 20 / (5 * 24).
    EXPECT_NEAR(of_quantity(measured, correlation)[0].value, 0.0, correlation_error(5));
    EXPECT_LT(of_quantity(measured, correlation)[0].low, 0.0);
}

// For any number of settings, rounding must neither move the correlation of a perfect order out of [-1, 1] nor the value out of its
// interval.
TEST(JiggleFigures, CorrelationOfAPerfectOrderIsOneAndInItsInterval)
{
    std::vector<MeasuredJiggle> measured;
    for (int n = 1; n <= 12; ++n) {
        measured.push_back(swinging({.k_stretch = 0.07 * n}, 1.0 + 0.1 * n));
        for (const auto& measurement : of_quantity(measured, correlation)) {
            EXPECT_LE(measurement.low, measurement.value) << n;
            EXPECT_GE(measurement.high, measurement.value) << n;
            EXPECT_LE(measurement.high, 1.0) << n;
            EXPECT_NEAR(measurement.value, 1.0, correlation_error(n)) << n;
        }
    }
}

TEST(JiggleFigures, RangeIsOfTheEndsThatSwing)
{
    std::vector<MeasuredJiggle> measured = {swinging({}, 3.0), swinging({.k_stretch = 1.0}, 12.0), swinging({.k_stretch = 0.05}, 2.0),
                                            swinging({.k_stretch = 0.5}, 4.0)};
    ASSERT_EQ(of_quantity(measured, range).size(), 1u);
    EXPECT_DOUBLE_EQ(of_quantity(measured, range)[0].value, 6.0);
    measured[1] = creeping({.k_stretch = 1.0});
    EXPECT_DOUBLE_EQ(of_quantity(measured, range)[0].value, 2.0);
    EXPECT_EQ(text_of(of_quantity(measured, range)[0].of), "limb, k_stretch 0.05 to 0.5");
    EXPECT_TRUE(of_quantity({swinging({}, 3.0)}, range).empty());
}

}  // namespace
