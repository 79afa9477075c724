// The roofline and the interpolation follow their definitions. Measured limits are only checked to be finite and positive.
#include "experiments/studies/bench/machine_limits.hpp"

#include "experiments/studies/bench/machine_kernels.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using experiments::attainable_gflops;
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

TEST(MachineLimits, TheRoofIsTheLowerOfTheTwo)
{
    EXPECT_DOUBLE_EQ(attainable_gflops(100.0, 50.0, 0.5), 25.0);
    EXPECT_DOUBLE_EQ(attainable_gflops(100.0, 50.0, 10.0), 100.0);
}

TEST(MachineLimits, MultiplyAddsAreDoneAndCounted)
{
    float sum = 0.0f;
    const double flops = experiments::multiply_add<float>(10, 1.0f, 1.0f, 1.0f, sum);
    // Twelve chains of `lanes` numbers, chain c starting at 1 + c, are ten times incremented by one: the sum over chains is lanes (12 + 66
    // + 120).
    const double lanes = flops / (2.0 * 10 * 12);
    EXPECT_FLOAT_EQ(sum, float(lanes * 198.0));
    EXPECT_EQ(lanes, std::floor(lanes));
}

TEST(MachineLimits, CopyCopies)
{
    alignas(64) float from[128], to[128] = {};
    for (int i = 0; i < 128; ++i) from[i] = float(i);
    experiments::copy_floats(from, to, 128);
    for (int i = 0; i < 128; ++i) EXPECT_EQ(to[i], float(i));
}

TEST(MachineLimits, AnUpdateInPlaceScalesEveryNumber)
{
    alignas(64) float x[128];
    for (int i = 0; i < 128; ++i) x[i] = float(i);
    experiments::scale_floats(2.0f, x, 128);
    for (int i = 0; i < 128; ++i) EXPECT_EQ(x[i], 2.0f * float(i));
}

TEST(MachineLimits, AreFiniteAndPositive)
{
    const MachineLimits limits = experiments::measure_limits(1e-4, 1e5);
    EXPECT_GT(limits.gflops_f32, 0.0);
    EXPECT_GT(limits.gflops_f64, 0.0);
    ASSERT_GE(limits.memory.size(), 3u);
    for (const auto& point : limits.memory) EXPECT_TRUE(std::isfinite(point.gb_s) && point.gb_s > 0.0);
}

}  // namespace
