// Truth: paths made up from formulas; iterations to tolerance of a rate r are ceil(log 0.05 / log r).
#include "experiments/convergence/convergence_figures.hpp"

#include "tests/support/iteration_paths.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace experiments;
using analysis::Measurement;
using test_support::starts_at_rates;

std::vector<Measurement> figures_named(const std::vector<Measurement>& all, const std::string& quantity)
{
    std::vector<Measurement> named;
    for (const Measurement& measured : all)
        if (measured.quantity == quantity) named.push_back(measured);
    return named;
}

TEST(ConvergenceFigures, ValueIsOfTheFirstSettingAndTheOthersItsInterval)
{
    const ConvergenceResult result{{starts_at_rates(1780, {0.9, 0.95, 0.9, 0.8}), starts_at_rates(1900, {0.88, 0.95, 0.9, 0.8}),
                                    starts_at_rates(1650, {0.91, 0.95, 0.9, 0.8})},
                                   false,
                                   ""};
    const auto iterations = figures_named(convergence_figures(result), "iterations to tolerance");
    ASSERT_EQ(iterations.size(), 2u);  // by residual; by volume, which stays at 1 %
    EXPECT_EQ(iterations[0].value, 29.0);
    EXPECT_EQ(iterations[0].low, 24.0);
    EXPECT_EQ(iterations[0].high, 32.0);
    EXPECT_EQ(iterations[1].value, 1000.0);
    EXPECT_NE(iterations[1].of.find("more than so much"), std::string::npos);
}

TEST(ConvergenceFigures, StartsAreComparedWithLbs)
{
    const ConvergenceResult result{{starts_at_rates(1780, {0.9, 0.95, 0.9, 0.8})}, false, ""};
    const auto all = convergence_figures(result);
    EXPECT_EQ(figures_named(all, "iterations to tolerance, from the previous frame over from LBS").at(0).value, 59.0 / 29.0);
    EXPECT_EQ(figures_named(all, "iterations to tolerance, from the rest pose over from LBS").at(0).value, 1.0);
    EXPECT_EQ(figures_named(all, "iterations to tolerance, from the rigid bind over from LBS").at(0).value, 14.0 / 29.0);
}

TEST(ConvergenceFigures, AStartThatNeverArrivesGivesABound)
{
    ConvergencePaths paths = starts_at_rates(1780, {0.9, 0.9, 0.9, 0.9});
    paths.paths[2] = test_support::path_to_floor(1000, 2.0, 1.0, 0.9);
    const auto ratio =
        figures_named(convergence_figures({{paths}, false, ""}), "iterations to tolerance, from the rest pose over from LBS");
    ASSERT_EQ(ratio.size(), 1u);
    EXPECT_EQ(ratio[0].value, 1000.0 / 29.0);
    EXPECT_NE(ratio[0].of.find("at least so much"), std::string::npos);
}

TEST(ConvergenceFigures, WhereNeitherArrivesThereIsNone)
{
    for (const Measurement& measured : convergence_figures({{starts_at_rates(1780, {0.9, 0.9, 0.9, 0.9})}, false, ""}))
        EXPECT_TRUE(measured.claim != "C03" || measured.of.find("volume change") == std::string::npos) << measured.of;
}

// Rates exp(-1 / sqrt(vertices)) need log 20 sqrt(vertices) iterations, rounded up: 1 of 67 at most, 1.5 % at one end of a factor of 64.
TEST(ConvergenceFigures, ExponentOfALadderIsThatOfTheFormula)
{
    ConvergenceResult ladder;
    ladder.ladder = true;
    for (const int vertices : {500, 2000, 8000, 32000})
        ladder.all.push_back(starts_at_rates(vertices, {std::exp(-1.0 / std::sqrt(vertices)), 0.5, 0.5, 0.5}, 4000));
    const auto exponent = figures_named(convergence_figures(ladder), "exponent of iterations to tolerance over vertices");
    ASSERT_EQ(exponent.size(), 1u);
    EXPECT_NEAR(exponent[0].value, 0.5, 0.015 / std::log(64.0) * 2.0);
    EXPECT_LE(exponent[0].low, exponent[0].value);
    EXPECT_GE(exponent[0].high, exponent[0].value);
    EXPECT_EQ(figures_named(convergence_figures(ladder), "iterations to tolerance").size(), 8u);  // each size its own, by two tolerances
}

TEST(ConvergenceFigures, ErrorsOfNoReferenceAreLeftOut)
{
    ConvergencePaths paths = starts_at_rates(1780, {0.9, 0.9, 0.9, 0.9});
    for (IterationPath& path : paths.paths)
        for (Look& look : path.looks) look.error_joint_pct = std::numeric_limits<double>::quiet_NaN();
    for (const Measurement& measured : convergence_figures({{paths}, false, ""}))
        EXPECT_FALSE(measured.quantity.starts_with("error")) << measured.quantity;
}

}  // namespace
