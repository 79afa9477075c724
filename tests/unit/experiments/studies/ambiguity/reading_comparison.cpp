// Reference: an invented measurement that counts its calls.
#include "experiments/studies/ambiguity/claim_changes.hpp"

#include <gtest/gtest.h>

namespace {

using experiments::Reading;
using experiments::ReadingValues;

std::vector<Reading> readings()
{
    Reading own = {.place = "", .name = "own", .baseline = "own", .options = {}}, lumped = own, softer = own;
    lumped.place = softer.place = "a place";
    lumped.name = "lumped";
    lumped.options.masses = pbs::Masses::lumped;
    softer.name = "softer";
    softer.options.k_volume = 0.5;
    return {own, lumped, softer};
}

TEST(ReadingComparison, MeasuresWhatTouchesTheClaimAndItsBaselineOnce)
{
    experiments::ReadingComparison comparison("limb", readings());
    std::vector<std::string> measured;
    comparison.measure({"C10"}, [&](const std::vector<Reading>& touching) {
        std::vector<ReadingValues> values;
        for (const Reading& reading : touching) {
            measured.push_back(reading.name);
            const double ms = reading.name == "own" ? 2.0 : 3.0;
            values.push_back({{{"C10", "ms", {.body = "limb"}, "ms", "", ms, analysis::Extent::whole}}, false});
        }
        return values;
    });
    EXPECT_EQ(measured, (std::vector<std::string>{"own", "lumped"}));
    ASSERT_EQ(comparison.changes().size(), 2u);
    EXPECT_EQ(comparison.changes()[0].b_over_a, 1.5);
    EXPECT_EQ(comparison.changes()[1].verdict_flips, "not_touched");
    EXPECT_TRUE(comparison.breakdown().empty());
}

TEST(ReadingComparison, SaysWhichReadingBreaksDown)
{
    experiments::ReadingComparison comparison("limb", readings());
    comparison.measure({"C10"}, [](const std::vector<Reading>& touching) {
        return std::vector<ReadingValues>(touching.size(), ReadingValues{{}, true});
    });
    EXPECT_NE(comparison.breakdown().find("lumped (C10)"), std::string::npos);
    EXPECT_EQ(comparison.changes().at(0).reason, "B breaks down");
}

}  // namespace
