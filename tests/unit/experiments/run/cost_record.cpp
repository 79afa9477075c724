// The cost of a run. Reference: parts that take at least a known time, and memory that is allocated.
#include "experiments/run/cost_record.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

namespace {

using namespace experiments;

void wait_ms(int ms)
{
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

TEST(CostRecord, AddsUpAPartAlsoOfOneThatThrowsAndHandsItsResultOn)
{
    CostRecord cost;
    EXPECT_EQ(*cost.time("metrics", [] { return wait_ms(5), std::make_unique<int>(7); }), 7)
        << "a result that cannot be copied";
    cost.time("metrics", [] { wait_ms(5); });
    EXPECT_GE(cost.seconds("metrics"), 0.010);
    EXPECT_EQ(cost.seconds("frames"), 0.0);
    const auto throw_late = [] { wait_ms(3), throw std::runtime_error("disk full"); };
    EXPECT_THROW(cost.time("frames", throw_late), std::runtime_error);
    EXPECT_GE(cost.seconds("frames"), 0.003);
}

TEST(CostRecord, ADeformersPartIsTheRunsToo)
{
    CostRecord cost;
    cost.time("step", "lbs", [] { wait_ms(2); });
    cost.time("step", "pbs", [] { wait_ms(4); });
    const nlohmann::json seconds = cost.json().at("seconds");
    EXPECT_GE(seconds.at("deformers").at("pbs").at("step").get<double>(), 0.004);
    EXPECT_GE(seconds.at("step").get<double>(),
              0.999 * (seconds.at("deformers").at("lbs").at("step").get<double>() + 0.004));
    EXPECT_GE(seconds.at("total").get<double>(), seconds.at("step").get<double>());
}

TEST(CostRecord, WaitingTakesNoProcessor)
{
    CostRecord cost;
    cost.time("wait", [] { wait_ms(50); });
    const nlohmann::json json = cost.json();
    EXPECT_LT(json.at("cpu_seconds").at("wait").get<double>(), 0.5 * json.at("seconds").at("wait").get<double>());
}

TEST(CostRecord, PeakMemoryStaysWhenItIsGivenBack)
{
    const CostRecord cost;
    const double before_mb = cost.json().at("peak_memory_mb").get<double>();
    std::vector<char>(64'000'000, 1);
    EXPECT_GE(cost.json().at("peak_memory_mb").get<double>(), before_mb + 50.0);
    EXPECT_GT(cost.json().at("shared_objects").get<int>(), 0);
}

}  // namespace
