// Reference: order statistics of a few frames by hand, linear between them.
#include "analysis/frame_statistics.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using analysis::CsvTable;
using analysis::frame_statistics;

CsvTable metrics()
{
    return CsvTable({"scene", "deformer", "variant", "order", "precision", "iterations", "frame", "volume_change_pct",
                     "volume_abs_change_pct", "error_joint_pct"});
}

TEST(FrameStatistics, OfEachSettingByItself)
{
    CsvTable table = metrics();
    for (int frame = 0; frame <= 10; ++frame) {  // 0, -1, ... -10; the order of frames does not matter
        table.add_row({"limb", "pbs", "default", "ordered", "f32", 24, frame, -1.0 * ((7 * frame) % 11), 2.0, std::nullopt});
        table.add_row({"limb", "pbs", "default", "ordered", "f32", 1, frame, 5.0, 3.0, std::nullopt});
    }
    const CsvTable statistics = frame_statistics(table);
    ASSERT_EQ(statistics.rows(), 2);
    EXPECT_EQ(statistics.text_at(0, "iterations"), "24");
    EXPECT_EQ(statistics.integer(0, "frames"), 11);
    EXPECT_EQ(statistics.number(0, "volume_change_least_pct"), -10.0);
    EXPECT_DOUBLE_EQ(statistics.number(0, "volume_change_p10_pct"), -9.0);
    EXPECT_DOUBLE_EQ(statistics.number(0, "volume_change_median_pct"), -5.0);
    EXPECT_DOUBLE_EQ(statistics.number(0, "volume_change_p90_pct"), -1.0);
    EXPECT_EQ(statistics.number(0, "volume_change_most_pct"), 0.0);
    EXPECT_EQ(statistics.number(0, "volume_abs_change_median_pct"), 2.0);
    EXPECT_EQ(statistics.number(1, "volume_change_median_pct"), 5.0);
}

TEST(FrameStatistics, FramesWithoutAValueAreLeftOut)
{
    CsvTable table = metrics();
    table.add_row({"walk", "lbs", "default", "", "f64", std::nullopt, 0, 1.0, 1.0, std::nullopt});
    table.add_row({"walk", "lbs", "default", "", "f64", std::nullopt, 1, std::numeric_limits<double>::quiet_NaN(), 1.0, 30.0});
    const CsvTable statistics = frame_statistics(table);
    ASSERT_EQ(statistics.rows(), 1);
    EXPECT_EQ(statistics.number(0, "volume_change_median_pct"), 1.0);
    EXPECT_EQ(statistics.number(0, "error_joint_median_pct"), 30.0);
    EXPECT_FALSE(statistics.number_or_nothing(0, "error_l2_median_pct"));  // a run without a reference has no such column
}

}  // namespace
