// Reference: distances of a few points by hand.
#include "experiments/run/run_records.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using experiments::DistanceRecord;

pbs::Positions two_points(double x_m)
{
    pbs::Positions points = pbs::Positions::Zero(2, 3);
    points(1, 0) = x_m;  // the first point does not move
    return points;
}

TEST(DistanceRecord, EachPairOfAFrameOnce)
{
    DistanceRecord record;
    record.add(0, 0.0, "lbs", "mesh", two_points(0.0));
    record.add(0, 0.0, "pbs", "mesh", two_points(0.004));
    record.add(0, 0.0, "pbs_jiggle", "mesh", two_points(0.001));
    const analysis::CsvTable& table = record.table();
    ASSERT_EQ(table.rows(), 3);
    EXPECT_EQ(table.text_at(2, "deformer"), "pbs_jiggle");
    EXPECT_EQ(table.text_at(2, "other"), "pbs");
    // Two coordinates of at most 4 mm and their difference are rounded; then there are square, mean, root and unit, and two roundings here.
    const double rounding_mm = test_support::rounding_error(3 + 6 + 2, 4.0);
    EXPECT_NEAR(table.number(2, "largest_mm"), 3.0, rounding_mm);
    EXPECT_NEAR(table.number(2, "rms_mm"), 3.0 / std::sqrt(2.0), rounding_mm);
    EXPECT_EQ(table.integer(2, "points"), 2);
}

TEST(DistanceRecord, FramesAreNotComparedWithEachOther)
{
    DistanceRecord record;
    record.add(0, 0.0, "pbs", "mesh", two_points(0.0));
    record.add(10, 0.1, "lbs", "mesh", two_points(1.0));
    EXPECT_EQ(record.table().rows(), 0);
    record.add(10, 0.1, "pbs", "mesh", two_points(1.0));
    ASSERT_EQ(record.table().rows(), 1);
    EXPECT_EQ(record.table().integer(0, "frame"), 10);
    EXPECT_EQ(record.table().number(0, "largest_mm"), 0.0);
}

}  // namespace
