// The arithmetic of the cost table. Truth: medians, quartiles and ratios by hand, on rounds whose disturbances are known.
#include "experiments/studies/features/feature_table.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace {

using namespace experiments;

SceneCost cost(double frame_ms)
{
    return {.frame_ms = frame_ms,
            .frame_cpu_ms = frame_ms,
            .step_ms = 0.5 * frame_ms,
            .step_cpu_ms = 0.5 * frame_ms,
            .start_s = 0.1,
            .peak_mb = 40.0 + frame_ms,
            .shared_objects = 60};
}

FeatureRow row(const std::vector<double>& without, const std::vector<double>& with)
{
    FeatureRow made{.scene = "limb", .feature = "sleep", .without = {}, .with = {}, .change = {}};
    for (const double frame_ms : without) made.without.push_back(cost(frame_ms));
    for (const double frame_ms : with) made.with.push_back(cost(frame_ms));
    return made;
}

TEST(FeatureTable, RatioIsTheMedianOfTheRatiosWithinARound)
{
    // The machine halves its speed in the second round: both runs double, their ratio of 1.5 stays.
    const Compared compared = compare(row({2.0, 4.0, 2.0}, {3.0, 6.0, 3.0}), &SceneCost::frame_ms);
    EXPECT_EQ(compared.without.median, 2.0);
    EXPECT_EQ(compared.with.median, 3.0);
    EXPECT_EQ(compared.ratio.median, 1.5);
    EXPECT_EQ(compared.ratio.lower, 1.5);
    EXPECT_EQ(compared.ratio.upper, 1.5);
    EXPECT_EQ(compared.ratio.rounds, 3);
}

TEST(FeatureTable, SpreadIsTheQuartiles)
{
    const Compared compared = compare(row({1.0, 1.0, 1.0, 1.0, 1.0}, {1.0, 2.0, 3.0, 4.0, 5.0}), &SceneCost::frame_ms);
    EXPECT_EQ(compared.ratio.lower, 2.0);
    EXPECT_EQ(compared.ratio.median, 3.0);
    EXPECT_EQ(compared.ratio.upper, 4.0);
}

TEST(FeatureTable, RoundsWithAndWithoutBelongTogether)
{
    EXPECT_THROW(compare(row({1.0, 1.0}, {1.0}), &SceneCost::frame_ms), std::logic_error);
    EXPECT_THROW(compare(row({}, {}), &SceneCost::frame_ms), std::logic_error);
}

TEST(FeatureTable, OnlyAFeatureThatMovesTheAnswerHasAChange)
{
    FeatureRow moving = row({1.0}, {2.0});
    moving.change = AnswerChange{.distance_m = 2e-3, .volume_difference_pct = 0.25};
    const analysis::CsvTable table = features_csv({row({1.0}, {2.0}), moving});
    EXPECT_FALSE(table.number_or_nothing(0, "largest_distance_m").has_value());
    EXPECT_EQ(table.number(1, "largest_distance_m"), 2e-3);
    EXPECT_EQ(table.number(1, "peak_mb_with"), 42.0);
    EXPECT_EQ(table.number(1, "step_ms_without"), 0.5);
    const std::string text = features_markdown(table);
    EXPECT_NE(text.find("| limb | sleep | 1.00 | 2.00 | 2.00 [2.00, 2.00] |"), std::string::npos) << text;
    EXPECT_NE(text.find("| 2 mm, 0.25 % |"), std::string::npos) << text;
}

}  // namespace
