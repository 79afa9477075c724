// Rows of judged cases. Truth: the form of a row as documented, and figures put in by hand.
#include "analysis/case_row.hpp"

#include <gtest/gtest.h>

namespace {

using namespace analysis;

TEST(CaseRow, PrintsWhatRoundingLeftOverAsZero)
{
    CaseJudgement judged;
    judged.scene = "bend";
    judged.sweep = true;
    judged.least = -2.361;
    judged.most = 3.63e-6;
    EXPECT_EQ(case_row(Claim{}, judged).measured, "-2.36 to 0 %");
}

TEST(CaseRow, OfASweepSaysAtWhichAngles)
{
    CaseJudgement judged;
    judged.sweep = true;
    EXPECT_EQ(case_row(Claim{}, judged).holds, "at no angle");
    judged.angles = {{0.0, 55.0}, {60.0, 60.0}};
    judged.last_angle_deg = 150.0;
    judged.holding_with_inverted_tets = 2;
    EXPECT_EQ(case_row(Claim{}, judged).holds, "at 0 to 55, 60 of 150 deg (inverted tets in 2 of the frames within)");
    EXPECT_EQ(case_row(Claim{}, judged).interval, "");
}

TEST(CaseRow, OfAClipGivesTheIntervalOfWhatItsRuleAsks)
{
    CaseJudgement judged;
    judged.frames = 573;
    judged.mean = {-1.33, -1.4, -1.2, 0.95, 573, 0};
    judged.share = {0.0, 0.0, 0.0254, 0.95, 573, 0};
    Claim claim;
    claim.rule = ClaimRule::share_within;
    EXPECT_EQ(case_row(claim, judged).interval, "0 % [0, 2.54] of 573 frames");
    claim.rule = ClaimRule::mean_within;
    EXPECT_EQ(case_row(claim, judged).interval, "mean [-1.4, -1.2] %");
}

}  // namespace
