// The interpolation follows its definition. Measured limits are only checked to be finite and positive.
#include "experiments/studies/bench/machine_limits.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using experiments::bandwidth_at;
using experiments::MachineLimits;

TEST(MachineLimits, BandwidthBetweenAndBeyondWhatWasMeasured)
{
    MachineLimits limits;
    limits.memory = {{1e4, 400.0}, {1e6, 100.0}, {1e8, 20.0}};
    EXPECT_DOUBLE_EQ(bandwidth_at(limits, 1e3), 400.0);
    EXPECT_DOUBLE_EQ(bandwidth_at(limits, 1e4), 400.0);
    EXPECT_DOUBLE_EQ(bandwidth_at(limits, 1e5), 250.0);  // half way in the logarithm
    EXPECT_DOUBLE_EQ(bandwidth_at(limits, 1e6), 100.0);
    EXPECT_DOUBLE_EQ(bandwidth_at(limits, 1e9), 20.0);
    EXPECT_DOUBLE_EQ(bandwidth_at({}, 1e6), 0.0);
}

TEST(MachineLimits, AreFiniteAndPositive)
{
    const MachineLimits limits = experiments::measure_limits(1e-4, 1e5);
    ASSERT_GE(limits.memory.size(), 3u);
    for (const auto& point : limits.memory) EXPECT_TRUE(std::isfinite(point.gb_s) && point.gb_s > 0.0);
}

}  // namespace
