// Reference: the documented fields of the file; an error is named with its line.
#include "analysis/claims.hpp"

#include "analysis/records/atomic_file.hpp"
#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using analysis::Claim;
using analysis::ClaimRule;
using analysis::parse_claims;

const std::string head = "schema = 1\n[[claim]]\nid = \"X\"\nstatement = \"s\"\nplace = \"p\"\nstudy = \"volume\"\ncost_minutes = 1\n";
const std::string body = "rule = \"share_within\"\nmetrics = [\"volume_change_pct\"]\ndeformer = \"pbs\"\nlow_pct = -1\nhigh_pct = 1\n";

std::string message_of(const std::string& text)
{
    try {
        parse_claims(text, "claims.toml");
    } catch (const pbs::InputError& error) {
        return error.what();
    }
    return "accepted";
}

const Claim& claim_of(const std::vector<Claim>& claims, const std::string& id)
{
    return *std::find_if(claims.begin(), claims.end(), [&](const Claim& claim) { return claim.id == id; });
}

TEST(Claims, TheProjectsOwnFileIsRead)
{
    const auto claims = parse_claims(analysis::read_text(PBS_CLAIMS_FILE), "claims.toml");
    const Claim& lbs = claim_of(claims, "C01");
    EXPECT_EQ(lbs.rule, ClaimRule::mean_within);
    EXPECT_EQ(lbs.metrics, (std::vector<std::string>{"volume_loss_pct", "volume_abs_change_pct"}));
    EXPECT_EQ(lbs.low, 12.0);
    EXPECT_EQ(lbs.high, 16.0);
    const Claim& pbs = claim_of(claims, "C02");
    EXPECT_EQ(pbs.rule, ClaimRule::share_within);
    EXPECT_EQ(pbs.iterations, 24);
    EXPECT_EQ(pbs.low, -0.5);
    EXPECT_EQ(pbs.high, 0.5);
    EXPECT_EQ(pbs.share, 0.95);
    EXPECT_EQ(pbs.level, 0.95);
}

TEST(Claims, WholeNumbersServeAsReals)
{
    const auto claims = parse_claims(head + body, "claims.toml");
    EXPECT_EQ(claims.at(0).high, 1.0);
    EXPECT_EQ(claims.at(0).cost_minutes, 1.0);
}

TEST(Claims, BrokenFilesAreNamedWithTheirLine)
{
    EXPECT_EQ(message_of(head + body), "accepted");
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

TEST(Claims, EachOnlyOnce)
{
    const std::string again = (head + body).substr(std::string("schema = 1\n").size());
    EXPECT_EQ(message_of(head + body + again), "claims.toml:13: id = X: expected each claim once");
}

}  // namespace
