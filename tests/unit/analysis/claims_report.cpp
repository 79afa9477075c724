// Truth: the contract of claims.json and claims.md.
#include "analysis/claims_report.hpp"

#include "tests/support/volume_claim.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

namespace {

using namespace analysis;

std::vector<Verdict> two_verdicts()
{
    const Claim claim = test_support::volume_claim("volume | kept");
    Claim other = claim;
    other.id = "C016";
    other.rule = ClaimRule::untestable;
    other.reason = "no figures";
    return {judge(claim, {.cases = {test_support::walk()}}), judge(other, {})};
}

TEST(ClaimsJson, CarriesTheContractsFields)
{
    const auto document = claims_json(two_verdicts());
    EXPECT_EQ(document.at("schema"), 1);
    const auto& claim = document.at("claims").at(0);
    for (const char* key : {"id", "statement", "expected", "measured", "interval", "verdict", "runs"})
        EXPECT_TRUE(claim.contains(key)) << key;
    EXPECT_EQ(claim.at("id"), "C02");
    EXPECT_EQ(claim.at("verdict"), "not reproduced");
    EXPECT_EQ(claim.at("interval").at("estimate"), 0.75);
    EXPECT_EQ(claim.at("runs").at(0), "volume/walk");
    EXPECT_EQ(claim.at("cases").at(0).at("holds"), "none");
    EXPECT_EQ(claim.at("cases").at(0).at("deepest").at(0).at("frame"), 2.0);
    EXPECT_TRUE(document.at("claims").at(1).at("interval").is_null());
}

TEST(ClaimsJson, FiguresThatAreNotKnownAreNull)
{
    const auto text = claims_json(two_verdicts()).dump();
    EXPECT_EQ(text.find("nan"), std::string::npos);
    EXPECT_TRUE(nlohmann::json::parse(text).at("claims").at(0).at("cases").at(0).at("deepest").at(0).at("angle_deg").is_null());
}

TEST(ClaimsJson, SaysOfEachFigureWhetherItHolds)
{
    Claim claim = two_verdicts().front().claim;
    claim.rule = ClaimRule::measured;
    Records records;
    records.measurements = {{claim.id, claim.metrics.front(), "a", 0.1, 0.0, 0.2, "%"},
                            {claim.id, claim.metrics.front(), "b", 0.4, 0.3, 0.6, "%"},
                            {claim.id, claim.metrics.front(), "c", 0.7, 0.6, 0.8, "%"}};
    const auto document = claims_json({judge(claim, records)});
    const auto& measured = document.at("claims").at(0).at("measurements");
    EXPECT_EQ(measured.at(0).at("holds"), "whole");
    EXPECT_EQ(measured.at(1).at("holds"), "part");
    EXPECT_EQ(measured.at(2).at("holds"), "none");
}

TEST(ClaimsMarkdown, IsTwoTablesOfSevenColumns)
{
    std::istringstream lines(claims_markdown(two_verdicts()));
    int rows = 0;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with('|')) continue;
        ++rows;
        const auto bars = std::count(line.begin(), line.end(), '|');
        const bool has_escaped_bar = line.find("\\|") != std::string::npos;
        EXPECT_EQ(bars, has_escaped_bar ? 9 : 8) << line;
    }
    EXPECT_EQ(rows, 7);  // head, rule and two claims; head, rule and the one case
}

TEST(ClaimsMarkdown, ARowAClaimThenARowACase)
{
    const std::string text = claims_markdown(two_verdicts());
    EXPECT_NE(text.find("| walk: mean -0.3 %, -0.9 to 0 % | share of frames, walk: ["), std::string::npos) << text;
    EXPECT_NE(text.find("| not reproduced: walk"), std::string::npos) << text;
    EXPECT_NE(text.find("| cannot be tested here: no figures |"), std::string::npos) << text;
    EXPECT_NE(text.find("| C02 | walk | volume_change_pct | mean -0.3 %, -0.9 to 0 % | 75 % ["), std::string::npos) << text;
    EXPECT_NE(text.find("] of 4 frames | no (inverted tets in 2 of the frames within) | volume/walk |"), std::string::npos) << text;
}

}  // namespace
