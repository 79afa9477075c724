// Expected values follow from timings that are a power of the size.
#include "experiments/studies/timing/timing_records.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiments;

// total = c V^1.2 is 1000 / 30 ms at 50,000 vertices.
double total_ms(double vertices)
{
    return 1e3 / 30.0 * std::pow(vertices / 50e3, 1.2);
}

TEST(RealTimeEnd, IsWhereAFrameTakesAThirtieth)
{
    for (const std::vector<double>& sizes : {std::vector<double>{1e3, 1e4, 1e5}, {1e5, 1e3, 1e4}}) {
        std::vector<double> ms;
        for (const double vertices : sizes) ms.push_back(total_ms(vertices));
        const RealTimeEnd end = real_time_end(sizes, ms);
        EXPECT_NEAR(end.vertices, 50e3, 1e-6);
        EXPECT_NEAR(end.exponent, 1.2, 1e-10);
        EXPECT_FALSE(end.beyond);
    }
}

TEST(RealTimeEnd, BeyondTheMeasuredSizesIsMarked)
{
    const RealTimeEnd above = real_time_end({1e3, 1e4}, {total_ms(1e3), total_ms(1e4)});
    EXPECT_NEAR(above.vertices, 50e3, 1e-6);
    EXPECT_TRUE(above.beyond);
    EXPECT_TRUE(real_time_end({1e5, 1e6}, {total_ms(1e5), total_ms(1e6)}).beyond);
}

}  // namespace
