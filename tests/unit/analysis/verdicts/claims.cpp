// Reference: the documented fields of the file; an error is named with its line.

#include "analysis/verdicts/claims.hpp"

#include "analysis/records/record_files.hpp"
#include "tests/support/refusal.hpp"

#include <gtest/gtest.h>

namespace claims_tests {
namespace {

using namespace analysis;

const std::string head =
    "schema = 1\n[[claim]]\nid = \"X\"\nstatement = \"s\"\nshort = \"it holds\"\nheadline = \"in {held} of "
    "{n}\"\nplace = \"p\"\nstudy = "
    "\"volume\"\n"
    "cost_minutes = 1\n";
// lines 10 to 13
const std::string cases = "rule = \"cases\"\nquantities = [\"radius\"]\ncase_fields = [\"body\"]\nsource = \"p\"\n";
// lines 14 and 15
const std::string thresholds = "thresholds = [{ low = 1 }]\n", no_effect = "no_effect = 0.5\n";

std::string replaced(std::string text, const std::string& part, const std::string& other)
{
    return text.replace(text.find(part), part.size(), other);
}

std::string message_of(const std::string& text)
{
    return test_support::refusal_of([&] { parse_claims(text, "claims.toml"); });
}

TEST(Claims, TheProjectsOwnFileIsRead)
{
    const auto claims = parse_claims(read_text(PBS_CLAIMS_FILE), "claims.toml");
    EXPECT_FALSE(claims.empty());
    for (const Claim& claim : claims) {
        EXPECT_TRUE(claim.rule != ClaimRule::cases || !claim.source.empty()) << claim.id;
        EXPECT_TRUE(claim.rule != ClaimRule::cases || !claim.thresholds_fixed_at.empty()) << claim.id;
        for (const std::string& quantity : claim.own.quantities)
            EXPECT_EQ(std::ranges::count(claim.quantities, quantity, &Quantity::name), 1)
                << claim.id << ": " << quantity;
    }
}

TEST(Claims, AControlHasWhatItDoesNotStateFromItsClaim)
{
    const std::string controls =
        "over = { deformer = \"flesh\" }\n"
        "controls = [{ name = \"LBS\", role = \"negative_control\", of = { deformer = \"lbs\" } }]\n";
    const std::string compared =
        "compared = [{ name = \"area\", quantities = [\"area\"], over = {}, of = { time_s = 2 }, "
        "thresholds = [{ high = 3 }] }]\n";
    const Claim claim = parse_claims(head + cases + thresholds + controls + compared, "claims.toml").at(0);
    ASSERT_EQ(claim.others.size(), 2u);
    EXPECT_EQ(claim.others[0].role, Role::negative_control);
    EXPECT_EQ(claim.others[0].quantities, claim.own.quantities);
    EXPECT_EQ(claim.others[0].over, CaseKey{.deformer = "flesh"});
    EXPECT_EQ(claim.others[0].thresholds.at(0).low, 1.0) << "a whole number serves as a real";
    EXPECT_EQ(claim.others[1].role, Role::comparison);
    EXPECT_EQ(claim.others[1].over, CaseKey{});
    EXPECT_EQ(claim.others[1].of, CaseKey{.time_s = 2.0});
    EXPECT_EQ(claim.others[1].thresholds.at(0).high, 3.0);
}

TEST(Claims, BrokenFilesAreNamedWithTheirLine)
{
    const std::string whole = head + cases + thresholds + no_effect;
    EXPECT_EQ(message_of(whole), "accepted");
    const std::string again = whole.substr(std::string("schema = 1\n").size());
    struct Case {
        std::string text, message;
    };
    for (const auto& [text, message] : std::vector<Case>{
             {whole + again, "claims.toml:16: id = X: expected each claim once"},
             {"", "claims.toml: schema: missing: expected schema = 1"},
             {"schema = 2\n", "claims.toml:1: schema = 2: expected 1"},
             {"schema = \"1\"\n", "claims.toml:1: schema = \"1\": expected 1"},
             {"schema = 1\n", "claims.toml: claim: expected [[claim]] tables"},
             {"schema = 1\nverdict = \"holds\"\n",
              "claims.toml:2: verdict: unknown key: expected schema or check or claim or quantity"},
             {replaced(whole, "short = \"it holds\"\n", ""), "claims.toml:2: short: missing in this claim"},
             {replaced(whole, "it holds", ""),
              "claims.toml:5: short: expected 1 to 8 words of at most 32 characters in all"},
             {replaced(whole, "it holds", "1 2 3 4 5 6 7 8 9"),
              "claims.toml:5: short = 1 2 3 4 5 6 7 8 9: expected 1 to 8 words of at most 32 characters in all"},
             {replaced(whole, "headline = \"in {held} of {n}\"\n", ""),
              "claims.toml:2: headline: missing in this claim"},
             {replaced(whole, "{held}", "{most_}"),
              "claims.toml:6: headline = in {most_} of {n}: {most_}: expected held, n, least, most, least_pct, "
              "most_pct, unit"},
             {whole + "threshold = 3\n", "claims.toml:16: threshold: unknown key of a claim"},
             {head, "claims.toml:2: rule: missing in this claim"},
             {head + "rule = \"guess\"\n",
              "claims.toml:10: rule = guess: expected cases, single, printed, definition or untestable"},
             {head + "rule = \"untestable\"\n", "claims.toml:2: reason: missing in this claim"},
             {head + "rule = \"definition\"\n", "claims.toml:2: reason: missing in this claim"},
             {head + "rule = \"single\"\n", "claims.toml:2: quantities: expected at least one"},
             {head + cases + no_effect, "claims.toml:2: thresholds: missing in this claim"},
             {head + cases + thresholds, "claims.toml:2: controls: expected a negative control, or no_effect"},
             {head + cases + thresholds + "no_effect = \"0.1\"\n",
              "claims.toml:15: no_effect = \"0.1\": expected a number"},
             {whole + "selected_by = \"LBS\"\n",
              "claims.toml:16: selected_by = LBS: expected the name of a negative control"},
             {whole + "mean = \"median\"\n", "claims.toml:16: mean = median: expected arithmetic or geometric"},
             {head + cases + thresholds + "no_effect = 1.5\n",
              "claims.toml:15: no_effect = 1.5: expected 0 <= no_effect < 1"},
             {head + cases + "thresholds = [{ low = 2, high = 1 }]\n" + no_effect,
              "claims.toml:14: low = 2: expected low <= high"},
             {head + cases + "thresholds = [{}]\n" + no_effect, "claims.toml:14: low: expected low, high or both"},
             {head + cases + "thresholds = [3]\n" + no_effect,
              "claims.toml:14: thresholds = [3]: expected a list of { low, high, of }"},
             {head + cases + "thresholds = 3\n" + no_effect,
              "claims.toml:14: thresholds = 3: expected a list of { low, high, of }"},
             {whole + "of = { bone = 1 }\n", "claims.toml:16: bone: unknown key of a key"},
             {whole + "of = 3\n", "claims.toml:16: of = 3: expected { field = value }"},
             {whole + "controls = [{ of = {} }]\n", "claims.toml:16: name: missing in this control"},
             {whole + "controls = [{ name = \"LBS\" }]\n",
              "claims.toml:16: role: expected negative_control or positive_control in controls, and none in compared"},
             {whole + "compared = [{ name = \"LBS\", role = \"negative_control\" }]\n",
              "claims.toml:16: role = negative_control: expected negative_control or positive_control in controls, and "
              "none in compared"},
             {whole + "controls = [{ name = \"LBS\", role = \"might\" }]\n",
              "claims.toml:16: role = might: expected negative_control or positive_control"},
         })
        EXPECT_EQ(message_of(text), message);
    EXPECT_EQ(message_of(std::string("\1\2", 2)).substr(0, 14), "claims.toml:1:");
    EXPECT_EQ(message_of("[" + std::string(100, '.') + "]\n").substr(0, 21), "claims.toml:1: key = ");
    std::string other_fields = whole;
    other_fields.replace(other_fields.find("body"), 4, "bone");
    EXPECT_EQ(
        message_of(other_fields),
        R"(claims.toml:12: case_fields = ["bone"]: bone: expected fields of a key, as body or joint, or quantity)");
}

}  // namespace
}  // namespace claims_tests
