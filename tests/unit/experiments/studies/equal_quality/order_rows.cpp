// Reference: paths of iterations that are defined by formulas, whose times and targets are found by hand.
#include "experiments/studies/equal_quality/order_rows.hpp"

#include "tests/support/iteration_paths.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace {

using namespace experiments;
using test_support::path_by;
using test_support::path_to_floor;

MeasuredOrder measured(const std::string& order, const std::string& sequence, IterationPath path, double ms)
{
    return {order, "f32", sequence, std::move(path), {ms, ms, ms, 5}};
}

// 4, 2, 4/3, 1 ...: at or below 1 from iteration 3 on.
IterationPath falling(int most)
{
    return path_by(most, [](int n) { return 4.0 / (n + 1); });
}

TEST(FirstWithin, TheFirstLookNotAboveTheBound)
{
    EXPECT_EQ(first_within(falling(10), &Look::combined, 1.0), 3);
    EXPECT_EQ(first_within(falling(10), &Look::combined, 4.0), 0);
}

TEST(FirstWithin, NothingWhereItIsNeverReached)
{
    EXPECT_EQ(first_within(falling(10), &Look::combined, 0.1), std::nullopt);
    EXPECT_EQ(first_within({}, &Look::combined, 1.0), std::nullopt);
}

// A path that falls below the bound and rises again has reached it.
TEST(FirstWithin, ARisingPathHasReachedIt)
{
    EXPECT_EQ(first_within(path_by(10, [](int n) { return std::abs(n - 5.0); }), &Look::combined, 1.0), 4);
}

TEST(FirstWithin, NotANumberIsNotReached)
{
    EXPECT_EQ(first_within(path_by(3, [](int) { return std::numeric_limits<double>::quiet_NaN(); }), &Look::combined, 1.0), std::nullopt);
}

TEST(TargetRows, IterationsAndTimeToPlainsResidual)
{
    const analysis::CaseKey of = {.body = "limb"};
    // plain: 4 / 25 = 0.16 after 24 iterations; the other order halves its value in each iteration: 4, 2, 1, 1/2, 1/4, 1/8.
    const std::vector<MeasuredOrder> all = {measured("plain", file_sequence, falling(100), 2.0),
                                            measured("ordered", "random_1", path_to_floor(100, 0.0, 4.0, 0.5), 0.25)};
    const std::vector<TargetRow> rows = target_rows(of, all);
    ASSERT_EQ(rows.size(), 2u * 4);
    EXPECT_EQ(rows[0].target, "residual_of_plain");
    EXPECT_DOUBLE_EQ(rows[0].bound, 0.16);
    EXPECT_EQ(rows[0].iterations, 24);
    EXPECT_DOUBLE_EQ(*rows[0].ms, 48.0);
    EXPECT_EQ(rows[4].of.order, "ordered");
    EXPECT_EQ(rows[4].sequence, "random_1");
    EXPECT_EQ(rows[4].iterations, 5);
    EXPECT_DOUBLE_EQ(*rows[4].ms, 1.25);
}

TEST(TargetRows, AnOrderWithAHigherLimitNeverReachesIt)
{
    const std::vector<MeasuredOrder> all = {measured("plain", file_sequence, falling(100), 2.0),
                                            measured("grouped", file_sequence, path_to_floor(100, 1.0, 3.0, 0.5), 0.2)};
    const std::vector<TargetRow> rows = target_rows({}, all);
    ASSERT_EQ(rows.size(), 8u);
    for (std::size_t i = 4; i < 8; ++i) {
        const bool within = rows[i].bound >= 1.0;  // 2 % alone is above its limit
        EXPECT_EQ(rows[i].reached, within) << rows[i].target;
        EXPECT_EQ(rows[i].iterations.has_value(), within);
        EXPECT_EQ(rows[i].ms.has_value(), within);
        EXPECT_NEAR(rows[i].limit, 1.0, 1e-15);
    }
}

TEST(TargetRows, WithoutPlainInFileOrderThereIsNoTarget)
{
    EXPECT_THROW(target_rows({}, {measured("plain", spread_sequence, falling(30), 1.0)}), std::logic_error);
}

TEST(OrderRows, ValuesAfter24AndInTheLimit)
{
    const std::vector<OrderRow> rows = order_rows({.body = "limb"}, {measured("plain", file_sequence, falling(100), 2.0)});
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_DOUBLE_EQ(rows[0].residual_24, 4.0 / 25);
    EXPECT_DOUBLE_EQ(rows[0].volume_abs_change_limit_pct, 4.0 / 101);
    EXPECT_DOUBLE_EQ(rows[0].volume_abs_change_half_pct, 4.0 / 51);
    EXPECT_EQ(rows[0].iterations, 100);
    EXPECT_EQ(rows[0].of.order, "plain");
}

// A table is read as it was written.
TEST(OrderRows, TablesAreReadBack)
{
    const std::vector<MeasuredOrder> all = {measured("plain", file_sequence, falling(30), 2.0)};
    const std::vector<TargetRow> read = rows_of(target_columns, table_of(target_columns, target_rows({.body = "limb"}, all)));
    ASSERT_EQ(read.size(), 4u);
    EXPECT_EQ(read[0].iterations, 24);
    EXPECT_EQ(read[3].iterations, 7);  // 4 / 8 = 0.5
}

}  // namespace
