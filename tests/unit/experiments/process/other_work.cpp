// Processors kept busy, from texts of /proc/stat. Reference: the columns of proc(5), added by hand.
#include "experiments/process/machine.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using experiments::busy_processors;
using experiments::processor_ticks;
using experiments::ProcessorTicks;

// user nice system idle iowait irq softirq steal guest guest_nice
const std::string before_it = "cpu  100 10 20 1000 5 1 2 3 50 0\ncpu0 50 5 10 500 2 0 1 1 25 0\ncpu1 50 5 10 500 3 1 1 2 25 0\nctxt 7\n";
const std::string after_it = "cpu  130 15 25 1050 11 2 3 7 60 0\ncpu0 65 8 12 525 5 1 2 3 30 0\ncpu1 65 7 13 525 6 1 1 4 30 0\nctxt 9\n";

TEST(OtherWork, IsTheBusyShareOfAllProcessors)
{
    const auto before = processor_ticks(before_it), after = processor_ticks(after_it);
    ASSERT_TRUE(before && after);
    EXPECT_EQ(before->busy, 136.0);
    EXPECT_EQ(before->idle, 1005.0);
    EXPECT_EQ(before->processors, 2);
    // 46 ticks busy and 56 idle on two processors.
    EXPECT_DOUBLE_EQ(*busy_processors(*before, *after), 2.0 * 46.0 / 102.0);
}

TEST(OtherWork, OldKernelsReportFourColumns)
{
    const auto ticks = processor_ticks("cpu 10 20 30 40\ncpu0 10 20 30 40\n");
    ASSERT_TRUE(ticks);
    EXPECT_EQ(ticks->busy, 60.0);
    EXPECT_EQ(ticks->idle, 40.0);
}

TEST(OtherWork, IsUnknownWithoutProcessorsOrTicks)
{
    EXPECT_FALSE(processor_ticks(""));
    EXPECT_FALSE(processor_ticks("cpu 10 20 30\ncpu0 10 20 30\n"));
    EXPECT_FALSE(processor_ticks("cpu 10 20 30 40\ncpufreq 1\n"));
    EXPECT_FALSE(processor_ticks("intr 10 20 30 40\n"));
    const ProcessorTicks moment{1.0, 2.0, 4};
    EXPECT_FALSE(busy_processors(moment, moment));
}

}  // namespace
