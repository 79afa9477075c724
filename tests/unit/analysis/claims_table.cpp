// Reference: the definition. A claim takes a few lines, its columns begin at the same position, and no line is longer than the terminal's.
#include "analysis/claims_table.hpp"

#include "analysis/text_columns.hpp"
#include "tests/support/volume_claim.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace {

using namespace analysis;

std::vector<Verdict> three_verdicts()
{
    const Claim claim = test_support::volume_claim("Volume is kept within half a per cent of what it was");
    Claim measured = claim;
    measured.rule = ClaimRule::measured;
    measured.metrics = {"frames_per_s"};
    measured.low = 30;
    measured.high = 1e12;
    Claim other = claim;
    other.id = "C016";
    other.rule = ClaimRule::untestable;
    other.reason = "no figures";
    Records timed;
    timed.measurements = {{"C02", "frames_per_s", {.body = "man"}, 60, 59, 61, "1/s"},
                          {"C02", "frames_per_s", {.body = "giant"}, 9, 8, 10, "1/s"}};
    return {judge(claim, {.cases = {test_support::walk()}}), judge(measured, timed), judge(other, {})};
}

std::vector<std::string> lines_of(const std::string& text)
{
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TEST(ClaimsTable, NoLineIsLongerThanTheTerminals)
{
    for (const std::size_t width : {60u, 80u, 100u, 160u})
        for (const std::string& line : lines_of(claims_table(three_verdicts(), width, false))) EXPECT_LE(characters(line), width) << line;
}

TEST(ClaimsTable, ColumnsBeginAtTheSamePlace)
{
    const auto lines = lines_of(claims_table(three_verdicts(), 100, false));
    const std::size_t verdict = lines.at(0).find("verdict"), claim = lines.at(0).find("claim"), facts = lines.at(0).find("facts");
    EXPECT_EQ(lines.at(2).find("not reproduced"), verdict);
    EXPECT_EQ(lines.at(2).find("Volume is"), claim);
    EXPECT_EQ(lines.at(2).find("within the bound: 0 of 1"), facts);
}

TEST(ClaimsTable, GivesTheFactsAndCountsTheVerdicts)
{
    const std::string text = claims_table(three_verdicts(), 160, false);
    for (const char* part : {"reproduced", "within the bound: 1 of 2", "frames_per_s: 9 1/s [8, 10]; bound 30 or more", "of: giant",
                             "cannot be", "reason: no figures", "share_of_frames of volume_change_pct: 0.75 [",
                             "3 claims: 1 reproduced in part, 1 not reproduced, 1 cannot be tested here"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(ClaimsTable, HasColoursOnlyWhenAsked)
{
    EXPECT_EQ(claims_table(three_verdicts(), 100, false).find('\033'), std::string::npos);
    const std::string coloured = claims_table(three_verdicts(), 100, true);
    EXPECT_NE(coloured.find("\033[31mnot reproduced\033[0m"), std::string::npos);
    EXPECT_NE(coloured.find("\033[33mreproduced in\033[0m"), std::string::npos);
    EXPECT_NE(coloured.find("\033[90mcannot be\033[0m"), std::string::npos);
}

}  // namespace
