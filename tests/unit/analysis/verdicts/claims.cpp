// Reference: the documented fields of the file; an error is named with its line.

#include "analysis/records/report_table.hpp"
#include "analysis/verdicts/claims.hpp"
#include "analysis/verdicts/verdict.hpp"
#include "tests/support/refusal.hpp"

#include <nlohmann/json.hpp>

namespace {

using namespace analysis;

const std::string head = "schema = 1\n[[claim]]\nid = \"X\"\nstatement = \"s\"\nplace = \"p\"\nstudy = \"volume\"\ncost_minutes = 1\n";
const std::string body = "rule = \"share_within\"\nmetrics = [\"volume_change_pct\"]\ndeformer = \"pbs\"\nlow_pct = -1\nhigh_pct = 1\n";

std::string message_of(const std::string& text)
{
    return test_support::refusal_of([&] { parse_claims(text, "claims.toml"); });
}

// Those of the project's own file are judged in verdict.cpp.
TEST(Claims, BrokenFilesAreNamedWithTheirLine)
{
    const auto accepted = parse_claims(head + body, "claims.toml");  // where whole numbers serve as reals
    EXPECT_EQ(accepted.at(0).high, 1.0);
    EXPECT_EQ(accepted.at(0).cost_minutes, 1.0);
    const std::string again = (head + body).substr(std::string("schema = 1\n").size());
    EXPECT_EQ(message_of(head + body + again), "claims.toml:13: id = X: expected each claim once");
    EXPECT_EQ(message_of(""), "claims.toml: schema: missing: expected schema = 1");
    EXPECT_EQ(message_of(std::string("\1\2", 2)).substr(0, 14), "claims.toml:1:");
    EXPECT_EQ(message_of("[" + std::string(100, '.') + "]\n").substr(0, 21), "claims.toml:1: key = ");
    EXPECT_EQ(message_of(head + body + "bound = 3\n"), "claims.toml:13: bound: unknown key of a claim");
    EXPECT_EQ(message_of(head + body + "share = \"most\"\n"), "claims.toml:13: share = most: expected a number");
    EXPECT_EQ(message_of(head + body + "share = 1.5\n"), "claims.toml:13: share = 1.5: expected 0 < share <= 1");
    EXPECT_EQ(message_of(head + body + "level = 1.0\n"), "claims.toml:13: level = 1.0: expected 0 < level < 1");
    EXPECT_EQ(message_of(head + body + "iterations = -1\n"), "claims.toml:13: iterations = -1: expected >= 0");
    EXPECT_EQ(message_of(head), "claims.toml:2: rule: missing in this claim");
    EXPECT_EQ(message_of(head + "rule = \"guess\"\n"),
              "claims.toml:8: rule = guess: expected share_within, mean_within, measured, printed or untestable");
    EXPECT_EQ(message_of(head + "rule = \"untestable\"\n"), "claims.toml:2: reason: missing in this claim");
    EXPECT_EQ(message_of(head + "rule = \"mean_within\"\n"), "claims.toml:2: metrics: expected at least one");
    EXPECT_EQ(message_of(head + "rule = \"mean_within\"\nmetrics = [\"beauty\"]\n").substr(0, 41),
              "claims.toml:9: metrics = [beauty]: beauty");
    EXPECT_EQ(message_of(head + "rule = \"mean_within\"\nmetrics = \"volume_loss_pct\"\n"),
              "claims.toml:9: metrics = volume_loss_pct: expected a list");
    EXPECT_EQ(message_of(head + "rule = \"mean_within\"\nmetrics = [\"volume_loss_pct\"]\ndeformer = \"lbs\"\n"),
              "claims.toml:2: low_pct: expected low_pct < high_pct");
    EXPECT_EQ(message_of(head + "rule = \"mean_within\"\nmetrics = [\"volume_loss_pct\", 1.5]\n"),
              "claims.toml:9: metrics = [volume_loss_pct, 1.5]: expected a text at each place of the list");
    EXPECT_EQ(message_of("schema = 1\nverdict = \"reproduced\"\n"),
              "claims.toml:2: verdict: unknown key: expected schema or check or claim or quantity");
    EXPECT_EQ(message_of("schema = 2\n"), "claims.toml:1: schema = 2: expected 1");
    EXPECT_EQ(message_of("schema = \"1\"\n"), "claims.toml:1: schema = 1: expected 1");
    EXPECT_EQ(message_of("[[claim]]\n"), "claims.toml: schema: missing: expected schema = 1");
    EXPECT_EQ(message_of("schema = 1\n"), "claims.toml: claim: expected [[claim]] tables");
    EXPECT_EQ(message_of("schema = \n").substr(0, 14), "claims.toml:1:");
}

TEST(Claims, AMeasuredClaimBoundsEachOfItsQuantities)
{
    const std::string measured = head + "rule = \"measured\"\nmetrics = [\"radius\", \"area\"]\n";
    const std::string radius = "{ quantity = \"radius\", low = 0.9 }", area = "{ quantity = \"area\", low = 0.8, high = 1.2 }";
    const Claim claim = parse_claims(measured + "bounds = [" + radius + ", " + area + "]\n", "claims.toml").at(0);
    EXPECT_EQ(claim.bounds.at(0).low, 0.9);
    EXPECT_EQ(claim.bounds.at(0).high, std::numeric_limits<double>::infinity());
    EXPECT_EQ(claim.bounds.at(1).high, 1.2);
    EXPECT_EQ(message_of(measured + "low = 0.0\nhigh = 0.0\n"), "accepted");
    EXPECT_EQ(message_of(measured + "bounds = [" + radius + ", " + area + "]\n"), "accepted");
    EXPECT_EQ(message_of(measured + "bounds = [" + radius + "]\n"),
              "claims.toml:10: bounds: expected a bound for each of the metrics, or low and high");
    EXPECT_EQ(message_of(measured + "low = 1.0\nhigh = 0.0\n"), "claims.toml:10: low = 1.0: expected low <= high");
    EXPECT_EQ(message_of(measured + "bounds = [{ quantity = \"radius\", low = 2.0, high = 1.0 }]\n"),
              "claims.toml:10: low = 2.0: expected low <= high");
    EXPECT_EQ(message_of(measured + "bounds = [{ quantity = \"beauty\" }]\n"),
              "claims.toml:10: bounds: beauty: expected one of this claim's metrics");
    EXPECT_EQ(message_of(measured + "bounds = [{ low = 1.0 }]\n"), "claims.toml:10: quantity: missing in this claim");
    EXPECT_EQ(message_of(measured + "bounds = [3]\n"), "claims.toml:10: bounds = [3]: expected { quantity, low, high }");
    EXPECT_EQ(message_of(measured + "bounds = 3\n"), "claims.toml:10: bounds = 3: expected a list");
}

// Reference: the contract of claims.json and claims.md.

// A claim of volume, and one walk by which it is judged: four frames, the third outside the bounds.
Claim volume_claim(const std::string& statement)
{
    Claim claim;
    claim.id = "C02";
    claim.statement = statement;
    claim.place = "Sec. 4";
    claim.study = "volume";
    claim.metrics = {"volume_change_pct"};
    claim.deformer = "pbs";
    claim.expected = claim.high = 0.5;
    claim.low = -0.5;
    return claim;
}

CaseRecord walk()
{
    CaseRecord walk;
    walk.scene = "walk";
    walk.deformer = "pbs";
    walk.run = "volume/walk";
    walk.frame = walk.time_s = walk.inverted_tets = {0, 1, 2, 3};
    walk.volume_change_pct = {0, -0.1, -0.9, -0.2};
    walk.volume_abs_change_pct = {0, 1, 2, 3};
    return walk;
}

std::vector<Verdict> two_verdicts()
{
    const Claim claim = volume_claim("volume | kept");
    Claim other = claim;
    other.id = "C016";
    other.rule = ClaimRule::untestable;
    other.reason = "no figures";
    return {judge(claim, {.cases = {walk()}}), judge(other, {})};
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
    EXPECT_TRUE(judged.at("deepest").at(0).at("angle_deg").is_null()) << "not known";
    EXPECT_EQ(document.dump().find("nan"), std::string::npos);
    EXPECT_TRUE(document.at("claims").at(1).at("primary").is_null());
    EXPECT_EQ(document.at("claims").at(1).at("reason"), "no figures");
    for (const auto& each : document.at("claims"))  // no sentence: every text is a name, a title, a path, or a text of claims.toml
        for (const auto& [key, value] : each.items())
            if (value.is_string() && key != "statement" && key != "place" && key != "reason") {
                EXPECT_EQ(value.get<std::string>().find(' '), std::string::npos) << key << ": " << value;
            }
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

std::vector<std::string> lines_of(const std::string& text)
{
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TEST(ClaimsMarkdown, IsOneTableWithARowAndThePrimaryValueForEachClaim)
{
    const std::string text = claims_markdown(two_verdicts());
    for (const std::string& line : lines_of(text)) {
        EXPECT_TRUE(line.starts_with('|')) << line;
        const bool has_escaped_bar = line.find("\\|") != std::string::npos;
        EXPECT_EQ(std::count(line.begin(), line.end(), '|'), has_escaped_bar ? 13 : 12) << line;
    }
    EXPECT_EQ(lines_of(text).size(), 4u);  // header, rule and two claims
    for (const char* part : {"| not_reproduced | 0 | 1 | share_of_frames of volume_change_pct | 0.75 | [",
                             "] | 0.95 to 1 | walk, pbs | volume |", "| cannot_be_tested_here | 0 | 0 |"})
        EXPECT_NE(text.find(part), std::string::npos) << text;
}

// Reference: the definition. A claim takes a few lines, its columns begin at the same position, and no line is longer than the terminal's.

std::vector<Verdict> three_verdicts()
{
    const Claim claim = volume_claim("Volume is kept within half a per cent of what it was");
    Claim measured = claim;
    measured.rule = ClaimRule::measured;
    measured.metrics = {"frames_per_s"};
    measured.low = 30;
    measured.high = 1e12;
    Records timed;
    timed.measurements = {{"C02", "frames_per_s", {.body = "man"}, 60, 59, 61, "1/s"},
                          {"C02", "frames_per_s", {.body = "giant"}, 9, 8, 10, "1/s"}};
    return {judge(claim, {.cases = {walk()}}), judge(measured, timed), two_verdicts().at(1)};
}

TEST(ClaimsTable, HasColumnsAtTheSamePlaceAndNoLongerLineThanTheTerminal)
{
    for (const std::size_t width : {60u, 80u, 100u, 160u})
        for (const std::string& line : lines_of(claims_table(three_verdicts(), width, false))) EXPECT_LE(characters(line), width) << line;
    const auto lines = lines_of(claims_table(three_verdicts(), 100, false));
    EXPECT_EQ(lines.at(2).find("not reproduced"), lines.at(0).find("verdict"));
    EXPECT_EQ(lines.at(2).find("Volume is"), lines.at(0).find("claim"));
    EXPECT_EQ(lines.at(2).find("within the bound: 0 of 1"), lines.at(0).find("facts"));
}

TEST(ClaimsTable, GivesTheFactsAndCountsTheVerdictsWithColoursOnlyWhenAsked)
{
    const std::string text = claims_table(three_verdicts(), 160, false);
    for (const char* part : {"reproduced", "within the bound: 1 of 2", "frames_per_s: 9 1/s [8, 10]; bound 30 or more", "of: giant",
                             "cannot be", "reason: no figures", "share_of_frames of volume_change_pct: 0.75 [",
                             "3 claims: 1 reproduced in part, 1 not reproduced, 1 cannot be tested here"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
    EXPECT_EQ(claims_table(three_verdicts(), 100, false).find('\033'), std::string::npos);
    const std::string coloured = claims_table(three_verdicts(), 100, true);
    EXPECT_NE(coloured.find("\033[31mnot reproduced\033[0m"), std::string::npos);
    EXPECT_NE(coloured.find("\033[33mreproduced in\033[0m"), std::string::npos);
    EXPECT_NE(coloured.find("\033[90mcannot be\033[0m"), std::string::npos);
}

TEST(ClaimsTable, NamesWhatIsLeftOutOnce)
{
    std::vector<Verdict> verdicts = three_verdicts();
    verdicts[0].left_out = {{"lady_01_01", "lady is not installed"}, {"lady_01_03", "lady is not installed"}};
    verdicts[1].left_out = {{"man_crouch", "man is not installed"}};
    verdicts[2].left_out = {{"lady_crouch", "lady is not installed"}};
    const std::string text = claims_table(verdicts, 160, false);
    EXPECT_NE(text.find("\nleft out of C016, C02: lady is not installed\nleft out of C02: man is not installed\n3 claims:"),
              std::string::npos)
        << text;
    EXPECT_EQ(text.find("lady_"), std::string::npos);
}

}  // namespace
