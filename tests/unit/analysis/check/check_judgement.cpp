// Reference: the tables below, whose worst frame and differences are visible at a glance.

#include "analysis/check/check.hpp"
#include "tests/support/refusal.hpp"

namespace {

using namespace analysis;

CsvTable metrics(const std::string& second, const std::string& last = "0.1")
{
    return parse_csv("scene,deformer,frame,iterations,loss,step_ms\ns,pbs,0,24,0,1\ns,pbs,1,24," + second +
                         ",1\ns,pbs,2,24," + last + ",1\ns,lbs,0,,-9,1\n",
                     "metrics.csv");
}

CheckCase judged(double low, double high, const std::string& second, const std::vector<int>& frames = {},
                 const std::string& of = "pbs")
{
    return judge_bound({"b", "s", of, "loss", low, high, frames, "", 3}, "%", metrics(second), "check.toml");
}

CheckRules rules()
{
    return {"check.toml", {}, {}, {{"loss", 0.01, 0.0, "", 0}}};
}

CsvTable baseline_of(const CsvTable& table, int tets = 20)
{
    CsvTable baseline = baseline_columns(rules());
    add_baseline_rows(baseline, "s", table, 10, tets);
    return parse_csv(baseline.text(), "baseline.csv");
}

CheckCase compared(const std::string& now, const CsvTable& before)
{
    return compare_with_baseline(rules(), "s", baseline_of(metrics(now)), before, "baseline.csv").at(1);  // after lbs
}

TEST(CheckJudgement, TheFrameFarthestOutIsNamed)
{
    const CheckCase check = judged(-0.5, 0.5, "-0.7");
    EXPECT_EQ(check.state, CheckState::failed);
    EXPECT_EQ(check.frame, 1);
    EXPECT_EQ(check.message, "frame 1: loss of pbs = -0.7 %, expected -0.5 to 0.5 %");
    EXPECT_EQ(judged(-0.5, 0.05, "-0.7").message,
              "frame 1: loss of pbs = -0.7 %, expected -0.5 to 0.05 % (2 of 3 frames outside, the first is 1)");
}

TEST(CheckJudgement, TheBoundItselfHoldsNotANumberDoesNotAndWhatTheSceneHasNotIsRefused)
{
    EXPECT_EQ(judged(-0.5, 0.5, "-0.5").state, CheckState::held);
    for (const char* broken : {"nan", "inf"}) EXPECT_EQ(judged(-0.5, 0.5, broken).state, CheckState::failed) << broken;
    EXPECT_EQ(judged(-0.5, 0.5, "9", {2, 2}).state, CheckState::held);
    EXPECT_THROW(judged(0, 1, "0", {}, "dqs"), pbs::InputError);
    EXPECT_THROW(judged(0, 1, "0", {0, 3}), pbs::InputError);
}

TEST(CheckJudgement, OfABoundOnBothSidesThatHoldsTheExtremesAreNamed)
{
    const CheckCase check = judged(-3.5, 0.5, "-2");
    EXPECT_EQ(check.state, CheckState::held);
    EXPECT_EQ(check.message, "frames 1 and 2: loss of pbs = -2 to 0.1 %, expected -3.5 to 0.5 %");
    EXPECT_EQ(judged(-3.5, 0.5, "-2", {1, 1}).message, "frame 1: loss of pbs = -2 %, expected -3.5 to 0.5 %");
}

TEST(CheckBaseline, HoldsWithinTheToleranceAndForEqualCounts)
{
    EXPECT_EQ(compared("0.2", baseline_of(metrics("0.209"))).state, CheckState::held);
    const CheckCase check = compared("0.2", baseline_of(metrics("0.25")));
    EXPECT_EQ(check.state, CheckState::failed);
    EXPECT_EQ(check.message, "frame 1: loss was 0.25, is 0.2, tolerance 0.01 (1 of 3 frames differ)");
    EXPECT_EQ(compared("0.2", baseline_of(metrics("0.2"), 21)).message,
              "frame 0: tets was 21, is 20, tolerance 0 (3 of 3 frames differ)");
}

TEST(CheckBaseline, OfMoreOrFewerFramesFails)
{
    const CsvTable three = baseline_of(metrics("0.2"));
    const auto is_not_last = [](const CsvTable::Row& row) { return !row.has({{"deformer", "pbs"}, {"frame", 2}}); };
    const CsvTable two = three.where(is_not_last);
    EXPECT_EQ(compared("0.2", two).message, "3 frames, the baseline has 2");
    const CheckCase fewer = compare_with_baseline(rules(), "s", two, three, "baseline.csv").at(1);
    EXPECT_EQ(fewer.state, CheckState::failed);
    EXPECT_EQ(fewer.message, "2 frames, the baseline has 3");
}

TEST(CheckBaseline, ASceneThatTheRulesNoLongerHaveFails)
{
    const CheckRules known = {"check.toml", {{"s", "s", {}, "", 0}}, {}, {}};
    EXPECT_TRUE(scenes_gone(known, baseline_of(metrics("0.2")), "baseline.csv").empty());
    const std::vector<CheckCase> gone = scenes_gone(rules(), baseline_of(metrics("0.2")), "baseline.csv");
    ASSERT_EQ(gone.size(), 1u);
    EXPECT_EQ(gone[0].suite, "s");
    EXPECT_EQ(gone[0].state, CheckState::failed);
    EXPECT_EQ(gone[0].line, 2);
}

TEST(CheckBaseline, AFrameTwiceIsRefusedWithItsLine)
{
    const CsvTable table = baseline_of(metrics("0.2"));
    require_baseline(rules(), table, "baseline.csv");
    const std::string text = table.text(), last = text.substr(text.rfind('\n', text.size() - 2) + 1);
    EXPECT_EQ(test_support::refusal_of(
                  [&] { require_baseline(rules(), parse_csv(text + last, "baseline.csv"), "baseline.csv"); }),
              "baseline.csv:6:3: frame = 0: expected it once: line 5 has it too");
}

std::vector<CheckSuite> suite_of(CheckState state)
{
    const CheckCase check{"arm", "a: b, 5 %", state, "frame 3: 7 %,\nsecond | line", 3, 7.0, "check.toml", 12, 0.0};
    return {CheckSuite{"arm", 1.0, {}, {check}}};
}

// Reference: GitHub's documented workflow commands; % \r \n are escaped in messages, and also : and , in properties.
TEST(GithubReport, NamesTheBoundsLineAndHasATableOfOneLinePerCase)
{
    EXPECT_EQ(github_annotations(suite_of(CheckState::failed)),
              "::error file=check.toml,line=12,title=arm a%3A b%2C 5 %25::frame 3: 7 %25,%0Asecond | line\n");
    EXPECT_TRUE(github_annotations(suite_of(CheckState::left_out)).starts_with("::warning "));
    EXPECT_TRUE(github_annotations(suite_of(CheckState::broke_down)).starts_with("::error "));
    EXPECT_EQ(github_annotations(suite_of(CheckState::held)), "");
    const std::string text = github_summary(suite_of(CheckState::failed));
    EXPECT_TRUE(text.starts_with("### pbskin: 0 hold, 1 fail, 0 left out\n")) << text;
    EXPECT_NE(text.find("| FAILS | arm | a: b, 5 % | frame 3: 7 %, second \\| line |\n"), std::string::npos) << text;
}

}  // namespace
