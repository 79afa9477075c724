// Reference: GitHub's documented workflow commands; % \r \n are escaped in messages, and also : and , in properties.
#include "analysis/check/github_report.hpp"

#include <gtest/gtest.h>

using analysis::CheckCase;
using analysis::CheckState;
using analysis::CheckSuite;

namespace {

std::vector<CheckSuite> suite_of(CheckState state)
{
    CheckCase check{"arm", "a: b, 5 %", state, "frame 3: 7 %,\nsecond | line", 3, 7.0, "check.toml", 12, 0.0};
    return {CheckSuite{"arm", 1.0, {}, {check}}};
}

}  // namespace

TEST(GithubReport, AFailureIsAnErrorAtTheBoundsLine)
{
    EXPECT_EQ(github_annotations(suite_of(CheckState::failed)),
              "::error file=check.toml,line=12,title=arm a%3A b%2C 5 %25::frame 3: 7 %25,%0Asecond | line\n");
}

TEST(GithubReport, LeftOutIsAWarningAndWhatHoldsIsSilent)
{
    EXPECT_TRUE(github_annotations(suite_of(CheckState::left_out)).starts_with("::warning "));
    EXPECT_TRUE(github_annotations(suite_of(CheckState::broke_down)).starts_with("::error "));
    EXPECT_EQ(github_annotations(suite_of(CheckState::held)), "");
}

TEST(GithubReport, TheSummaryIsATableOfOneLineACase)
{
    const std::string text = github_summary(suite_of(CheckState::failed));
    EXPECT_TRUE(text.starts_with("### pbskin: 0 hold, 1 fail, 0 left out\n")) << text;
    EXPECT_NE(text.find("| FAILS | arm | a: b, 5 % | frame 3: 7 %,  second \\| line |\n"), std::string::npos) << text;
}
