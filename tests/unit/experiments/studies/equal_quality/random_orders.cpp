// The order `ordered` gives an answer that is no worse than the median of random orders. Reference: `plain` in the five random sequences of
// the study, on two of its bodies.
#include "experiments/studies/equal_quality/order_report.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using namespace experiments;

std::vector<OrderSummary> summaries_of(const std::string& body, double angle_deg)
{
    EqualQualityCase of;
    of.of = {.body = body, .motion = "twist", .angle_deg = angle_deg};
    of.scene = read_scene("limb_twist", {"motion.angle_deg=" + std::to_string(angle_deg), "motion.frames=2"});
    of.frame = 1;
    of.is_tapered = body == "tapered_limb";
    of.random = {1, 2, 3, 4, 5};
    of.most_iterations = paper_iterations;
    of.rounds = {.seconds = 0.0, .fewest = 1, .most = 1};
    return summaries(order_rows(of.of, measure_orders(of)));
}

void expect_no_worse_than_random(const std::vector<OrderSummary>& summaries)
{
    int seen = 0;
    for (const OrderSummary& summary : summaries) {
        if (summary.of.order != "ordered" && summary.of.order != "poses") continue;
        EXPECT_LE(summary.volume_to_random_plain, 1.0) << summary.of.order << ", " << summary.of.precision;
        ++seen;
    }
    EXPECT_EQ(seen, 4);  // two orders with the same bits, two precisions
}

// The order `grouped` is faster, and its answer is worse than that of random orders.
TEST(RandomOrders, OrderedIsNoWorseThanTheirMedianOnTheTwistedLimbAndGroupedIs)
{
    const std::vector<OrderSummary> summaries = summaries_of("limb", 150.0);
    expect_no_worse_than_random(summaries);
    for (const OrderSummary& summary : summaries)
        if (summary.of.order == "grouped") {
            EXPECT_GT(summary.volume_to_random_plain, 1.0) << summary.of.precision;
        }
}

TEST(RandomOrders, OrderedIsNoWorseThanTheirMedianOnTheTaperedLimb)
{
    expect_no_worse_than_random(summaries_of("tapered_limb", 165.0));
}

}  // namespace
