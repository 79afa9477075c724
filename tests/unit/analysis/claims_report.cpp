// Reference: the contract of claims.json and claims.md.
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

nlohmann::json document_of(const std::vector<Verdict>& verdicts)
{
    return claims_json(verdicts, "0123456789abcdef");
}

TEST(ClaimsJson, CarriesTheContractsFields)
{
    const auto document = document_of(two_verdicts());
    EXPECT_EQ(document.at("schema"), 2);
    EXPECT_EQ(document.at("revision"), "0123456789abcdef");
    const auto& claim = document.at("claims").at(0);
    for (const char* key : {"id", "statement", "verdict", "primary", "cases", "controls", "readings", "runs"})
        EXPECT_TRUE(claim.contains(key)) << key;
    EXPECT_EQ(claim.at("id"), "C02");
    EXPECT_EQ(claim.at("verdict"), "not_reproduced");
    EXPECT_EQ(claim.at("runs").at(0), "volume/walk");
    const auto& primary = claim.at("primary");
    for (const char* key : {"quantity", "unit", "value", "low", "high", "n", "bound_low", "bound_high", "share"})
        EXPECT_TRUE(primary.contains(key)) << key;
    EXPECT_EQ(primary.at("value"), 0.75);
    EXPECT_EQ(primary.at("share"), 0.0);
    EXPECT_EQ(primary.at("bound_low"), 0.95);
    const auto& judged = claim.at("cases").at(0);
    EXPECT_EQ(judged.at("holds"), "none");
    EXPECT_EQ(judged.at("body"), "walk");  // the scene's name, since the plan states no body
    EXPECT_EQ(judged.at("deformer"), "pbs");
    EXPECT_EQ(judged.at("value"), 0.75);
    EXPECT_EQ(judged.at("deepest").at(0).at("frame"), 2.0);
    EXPECT_TRUE(document.at("claims").at(1).at("primary").is_null());
    EXPECT_EQ(document.at("claims").at(1).at("reason"), "no figures");
}

// No sentence: every text is a name, a title, a path, or a text of claims.toml.
TEST(ClaimsJson, HoldsNoSentence)
{
    const auto document = document_of(two_verdicts());
    for (const auto& claim : document.at("claims"))
        for (const auto& [key, value] : claim.items())
            if (value.is_string() && key != "statement" && key != "place" && key != "reason") {
                EXPECT_EQ(value.get<std::string>().find(' '), std::string::npos) << key << ": " << value;
            }
}

TEST(ClaimsJson, ValuesThatAreNotKnownAreNull)
{
    const auto text = document_of(two_verdicts()).dump();
    EXPECT_EQ(text.find("nan"), std::string::npos);
    EXPECT_TRUE(nlohmann::json::parse(text).at("claims").at(0).at("cases").at(0).at("deepest").at(0).at("angle_deg").is_null());
}

TEST(ClaimsJson, SaysWhetherEachValueHolds)
{
    Claim claim = two_verdicts().front().claim;
    claim.rule = ClaimRule::measured;
    claim.quantities = {{claim.metrics.front(), "volume change", "%"}};
    const auto of = [](const char* body) { return CaseKey{.body = body, .angle_deg = 90.0}; };
    Records records;
    records.measurements = {{claim.id, claim.metrics.front(), of("a"), 0.1, 0.0, 0.2, "%"},
                            {claim.id, claim.metrics.front(), of("b"), 0.4, 0.3, 0.6, "%"},
                            {claim.id, claim.metrics.front(), of("c"), 0.7, 0.6, 0.8, "%"}};
    const auto document = document_of({judge(claim, records)});
    EXPECT_EQ(document.at("quantities").at("volume_change_pct").at("title"), "volume change");
    const auto& cases = document.at("claims").at(0).at("cases");
    EXPECT_EQ(cases.at(0).at("holds"), "whole");
    EXPECT_EQ(cases.at(1).at("holds"), "part");
    EXPECT_EQ(cases.at(2).at("holds"), "none");
    EXPECT_EQ(cases.at(2).at("body"), "c");
    EXPECT_EQ(cases.at(2).at("angle_deg"), 90.0);
    EXPECT_EQ(document.at("claims").at(0).at("subjects").at(2).at("holds"), "none");
}

TEST(ClaimsMarkdown, IsOneTableWithARowForEachClaim)
{
    std::istringstream lines(claims_markdown(two_verdicts()));
    int rows = 0;
    for (std::string line; std::getline(lines, line);) {
        ASSERT_TRUE(line.starts_with('|')) << line;
        ++rows;
        const auto bars = std::count(line.begin(), line.end(), '|');
        const bool has_escaped_bar = line.find("\\|") != std::string::npos;
        EXPECT_EQ(bars, has_escaped_bar ? 13 : 12) << line;
    }
    EXPECT_EQ(rows, 4);  // header, rule and two claims
}

TEST(ClaimsMarkdown, GivesThePrimaryValueWithItsBound)
{
    const std::string text = claims_markdown(two_verdicts());
    EXPECT_NE(text.find("| not_reproduced | 0 | 1 | share_of_frames of volume_change_pct | 0.75 | ["), std::string::npos) << text;
    EXPECT_NE(text.find("] | 0.95 to 1 | walk, pbs | volume |"), std::string::npos) << text;
    EXPECT_NE(text.find("| cannot_be_tested_here | 0 | 0 |"), std::string::npos) << text;
}

}  // namespace
