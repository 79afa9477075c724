// Reference: ratios and medians found by hand.
#include "experiments/studies/equal_quality/order_report.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace {

using namespace experiments;

OrderRow order_row(const std::string& order, const std::string& sequence, double ms, double volume_pct)
{
    OrderRow row;
    row.of = {.body = "limb", .order = order, .precision = "f32"};
    row.sequence = sequence;
    row.ms_iteration.median = ms;
    row.volume_abs_change_24_pct = volume_pct;
    row.residual_24 = 2.0 * volume_pct;
    return row;
}

TargetRow target_row(const std::string& order, const std::string& sequence, std::optional<double> ms)
{
    TargetRow row{{.body = "limb", .order = order, .precision = "f32"}, sequence, "volume_2_pct", 2.0};
    row.reached = ms.has_value();
    row.ms = ms;
    if (ms) row.iterations = 10;
    return row;
}

TEST(OrderSummaries, RatiosToTheSpreadBaselineAndToRandomPlain)
{
    const std::vector<OrderSummary> all =
        summaries({order_row("plain", "file", 8.0, 3.0), order_row("plain", "spread", 4.0, 3.5), order_row("plain", "random_1", 6.0, 4.0),
                   order_row("plain", "random_2", 6.0, 5.0), order_row("plain", "random_3", 6.0, 9.0),
                   order_row("ordered", "file", 0.5, 4.5), order_row("ordered", "random_1", 0.5, 4.6),
                   order_row("ordered", "random_2", 0.5, 4.8), order_row("ordered", "random_3", 0.5, 4.7)});
    ASSERT_EQ(all.size(), 2u);
    EXPECT_DOUBLE_EQ(all[0].ratio_to_plain_spread, 0.5);
    EXPECT_DOUBLE_EQ(all[0].volume_to_random_plain, 0.6);
    EXPECT_DOUBLE_EQ(all[1].ratio_to_plain_spread, 8.0);
    EXPECT_DOUBLE_EQ(all[1].volume_to_random_plain, 0.9);
    EXPECT_DOUBLE_EQ(all[1].residual_to_random_plain, 0.9);
    EXPECT_DOUBLE_EQ(all[1].random_low_pct, 4.6);
    EXPECT_DOUBLE_EQ(all[1].random_median_pct, 4.7);
    EXPECT_DOUBLE_EQ(all[1].random_high_pct, 4.8);
}

TEST(EqualAnswers, SpeedUpsAreRatiosOfTimesToTheTarget)
{
    const std::vector<EqualAnswer> all =
        equal_answers({target_row("plain", "file", 80.0), target_row("plain", "spread", 40.0), target_row("plain", "random_1", 60.0),
                       target_row("plain", "random_2", 50.0), target_row("ordered", "file", 10.0), target_row("ordered", "random_1", 11.0),
                       target_row("ordered", "random_2", 9.0)});
    ASSERT_EQ(all.size(), 2u);
    EXPECT_DOUBLE_EQ(*all[1].speedup_to_plain, 8.0);
    EXPECT_DOUBLE_EQ(*all[1].speedup_to_plain_spread, 4.0);
    EXPECT_DOUBLE_EQ(*all[1].random_speedup_to_plain, 5.5);
    EXPECT_EQ(all[1].random_reached, 2);
}

// Where either never reaches the target, there is no speed-up.
TEST(EqualAnswers, NeverReachedIsNoSpeedUp)
{
    const std::vector<EqualAnswer> all =
        equal_answers({target_row("plain", "file", 80.0), target_row("plain", "spread", {}), target_row("plain", "random_1", 60.0),
                       target_row("plain", "random_2", {}), target_row("ordered", "file", 10.0), target_row("ordered", "random_1", 10.0),
                       target_row("ordered", "random_2", 10.0), target_row("grouped", "file", {}), target_row("grouped", "random_1", {}),
                       target_row("grouped", "random_2", 9.0)});
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[1].speedup_to_plain, 8.0);
    EXPECT_EQ(all[1].speedup_to_plain_spread, std::nullopt);
    EXPECT_EQ(all[1].random_speedup_to_plain, std::nullopt);
    EXPECT_EQ(all[2].speedup_to_plain, std::nullopt);
    EXPECT_EQ(all[2].random_median_ms, std::nullopt);
    EXPECT_EQ(all[2].random_reached, 1);
    EXPECT_NE(order_report({}, all).find("\u2013"), std::string::npos);
}

TEST(EqualAnswers, WithoutTheSpreadBaselineThereIsNoRatio)
{
    EXPECT_THROW(summaries({order_row("plain", "file", 8.0, 3.0)}), std::out_of_range);
}

}  // namespace
