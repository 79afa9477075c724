// Reference: the ranks of a few points made by hand.
#include "experiments/studies/work_precision/wins.hpp"

#include "tests/support/comparison_records.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace experiments;
using test_support::hand_case;
using test_support::hand_diagrams;
using test_support::hand_reference;

SettingKey plain_key(const std::string& deformer)
{
    return {.deformer = deformer, .precision = "f64"};
}

// With a bound of 1 %. In the first pose LBS is the only one within 0.1 ms, and PBS leads XPBD by a factor of 2 within 1 ms and longer. In
// the second pose delta mush is nearest within 1 ms, undecided against PBS. The third pose trains, and XPBD is nearest there.
std::vector<Diagram> diagrams_with_wins()
{
    const auto of = [](const std::string& pose, double lbs, double mush, double pbs, double xpbd, Half half) {
        return hand_case({.body = "limb", .pose = pose},
                         {{plain_key("lbs"), 0.1, lbs},
                          {plain_key("delta_mush"), 0.5, mush},
                          {plain_key("pbs"), 1.0, pbs},
                          {plain_key("xpbd"), 1.0, xpbd},
                          hand_reference()},
                         half, 1.0);
    };
    return hand_diagrams({of("a", 60.0, 30.0, 10.0, 20.0, Half::evaluation), of("b", 60.0, 9.5, 10.0, 40.0, Half::evaluation),
                          of("c", 60.0, 30.0, 20.0, 1.0, Half::training)});
}

const Win& win_of_group(const std::vector<Win>& wins, const std::string& group)
{
    return *std::ranges::find(wins, group, &Win::group);
}

TEST(Wins, AreTheDecidedPlacesWithTheLargestLead)
{
    const std::vector<Win> wins = wins_of(diagrams_with_wins());
    ASSERT_EQ(wins.size(), 4u) << "groups without points are left out";
    const Win &pbs = win_of_group(wins, "pbs"), &mush = win_of_group(wins, "delta_mush"), &lbs = win_of_group(wins, "lbs");
    ASSERT_TRUE(pbs.nearest && mush.nearest && lbs.nearest);
    EXPECT_EQ(pbs.nearest->diagram, "limb_a");
    EXPECT_EQ(pbs.nearest->budget_ms, 1.0);
    EXPECT_EQ(pbs.nearest->decision, analysis::PairDecision::decided);
    EXPECT_EQ(pbs.next, "xpbd");
    EXPECT_EQ(pbs.places, 2 * 4) << "two comparisons, and the budgets of 1, 3, 10 and 100 ms";
    EXPECT_EQ(mush.nearest->diagram, "limb_b");
    EXPECT_EQ(mush.nearest->undecided_against, std::vector<std::string>{"pbs"});
    EXPECT_FALSE(lbs.nearest->decision) << "it is the only one within 0.1 ms";
}

TEST(Wins, AreNoneWhereAnotherGroupIsAlwaysNearer)
{
    EXPECT_FALSE(win_of_group(wins_of(diagrams_with_wins()), "xpbd").nearest) << "it is nearest in a training pose alone";
    const std::string text = wins_text(diagrams_with_wins());
    EXPECT_NE(text.find("| XPBD | none | | | | | | 0 |"), std::string::npos) << text;
    EXPECT_NE(text.find("| PBS | limb_a | packed_f32 | 1 | 10.0 | XPBD: 20.0 | decided | 8 |"), std::string::npos) << text;
    EXPECT_NE(text.find("| delta mush | limb_b | packed_f32 | 1 | 9.5 | PBS: 10.0 | undecided against PBS | 8 |"), std::string::npos)
        << text;
    EXPECT_NE(text.find("| LBS | limb_a | packed_f32 | 0.1 | 60.0 |  | it is the only one | 4 |"), std::string::npos) << text;
}

}  // namespace
