// Reference: the documented fields of the file; an error is named with its line.

#include "analysis/verdicts/claims.hpp"

#include "analysis/records/record_files.hpp"
#include "tests/support/refusal.hpp"

#include <gtest/gtest.h>

namespace {

using namespace analysis;

const std::string head = "schema = 1\n[[claim]]\nid = \"X\"\nstatement = \"s\"\nplace = \"p\"\nstudy = \"volume\"\ncost_minutes = 1\n";
const std::string units = "rule = \"units\"\nquantities = [\"radius\"]\nunit = [\"body\"]\nsource = \"p\"\n";  // lines 8 to 11
const std::string bounds = "bounds = [{ low = 1 }]\n", no_effect = "no_effect = 0.5\n";                        // lines 12 and 13

std::string message_of(const std::string& text)
{
    return test_support::refusal_of([&] { parse_claims(text, "claims.toml"); });
}

TEST(Claims, TheProjectsOwnFileIsRead)
{
    const auto claims = parse_claims(read_text(PBS_CLAIMS_FILE), "claims.toml");
    EXPECT_EQ(claims.size(), 22u);
    for (const Claim& claim : claims) {
        EXPECT_TRUE(claim.rule != ClaimRule::units || !claim.source.empty()) << claim.id;
        for (const std::string& quantity : claim.own.quantities)
            EXPECT_EQ(std::ranges::count(claim.quantities, quantity, &Quantity::name), 1) << claim.id << ": " << quantity;
    }
}

TEST(Claims, AControlHasWhatItDoesNotStateFromItsClaim)
{
    const std::string controls =
        "over = { deformer = \"flesh\" }\n"
        "controls = [{ name = \"LBS\", role = \"must_fail\", of = { deformer = \"lbs\" } }]\n";
    const std::string compared =
        "compared = [{ name = \"area\", quantities = [\"area\"], over = {}, of = { time_s = 2 }, "
        "bounds = [{ high = 3 }] }]\n";
    const Claim claim = parse_claims(head + units + bounds + controls + compared, "claims.toml").at(0);
    ASSERT_EQ(claim.others.size(), 2u);
    EXPECT_EQ(claim.others[0].role, Role::must_fail);
    EXPECT_EQ(claim.others[0].quantities, claim.own.quantities);
    EXPECT_EQ(claim.others[0].over, CaseKey{.deformer = "flesh"});
    EXPECT_EQ(claim.others[0].bounds.at(0).low, 1.0) << "a whole number serves as a real";
    EXPECT_EQ(claim.others[1].role, Role::comparison);
    EXPECT_EQ(claim.others[1].over, CaseKey{});
    EXPECT_EQ(claim.others[1].of, CaseKey{.time_s = 2.0});
    EXPECT_EQ(claim.others[1].bounds.at(0).high, 3.0);
}

TEST(Claims, BrokenFilesAreNamedWithTheirLine)
{
    const std::string whole = head + units + bounds + no_effect;
    EXPECT_EQ(message_of(whole), "accepted");
    const std::string again = whole.substr(std::string("schema = 1\n").size());
    struct Case {
        std::string text, message;
    };
    for (const auto& [text, message] : std::vector<Case>{
             {whole + again, "claims.toml:14: id = X: expected each claim once"},
             {"", "claims.toml: schema: missing: expected schema = 1"},
             {"schema = 2\n", "claims.toml:1: schema = 2: expected 1"},
             {"schema = \"1\"\n", "claims.toml:1: schema = \"1\": expected 1"},
             {"schema = 1\n", "claims.toml: claim: expected [[claim]] tables"},
             {"schema = 1\nverdict = \"holds\"\n", "claims.toml:2: verdict: unknown key: expected schema or check or claim or quantity"},
             {whole + "bound = 3\n", "claims.toml:14: bound: unknown key of a claim"},
             {head, "claims.toml:2: rule: missing in this claim"},
             {head + "rule = \"guess\"\n", "claims.toml:8: rule = guess: expected units, single, printed, definition or untestable"},
             {head + "rule = \"untestable\"\n", "claims.toml:2: reason: missing in this claim"},
             {head + "rule = \"definition\"\n", "claims.toml:2: reason: missing in this claim"},
             {head + "rule = \"single\"\n", "claims.toml:2: quantities: expected at least one"},
             {head + units + no_effect, "claims.toml:2: bounds: missing in this claim"},
             {head + units + bounds, "claims.toml:2: controls: expected one that must fail, or no_effect"},
             {head + units + bounds + "no_effect = \"0.1\"\n", "claims.toml:13: no_effect = \"0.1\": expected a number"},
             {whole + "unseen_by = \"LBS\"\n", "claims.toml:14: unseen_by = LBS: expected the name of a control that must fail"},
             {whole + "mean = \"median\"\n", "claims.toml:14: mean = median: expected arithmetic or geometric"},
             {head + units + bounds + "no_effect = 1.5\n", "claims.toml:13: no_effect = 1.5: expected 0 <= no_effect < 1"},
             {head + units + "bounds = [{ low = 2, high = 1 }]\n" + no_effect, "claims.toml:12: low = 2: expected low <= high"},
             {head + units + "bounds = [{}]\n" + no_effect, "claims.toml:12: low: expected low, high or both"},
             {head + units + "bounds = [3]\n" + no_effect, "claims.toml:12: bounds = [3]: expected a list of { low, high, of }"},
             {head + units + "bounds = 3\n" + no_effect, "claims.toml:12: bounds = 3: expected a list of { low, high, of }"},
             {whole + "of = { bone = 1 }\n", "claims.toml:14: bone: unknown key of a key"},
             {whole + "of = 3\n", "claims.toml:14: of = 3: expected { field = value }"},
             {whole + "controls = [{ of = {} }]\n", "claims.toml:14: name: missing in this control"},
             {whole + "controls = [{ name = \"LBS\" }]\n",
              "claims.toml:14: role: expected must_fail or must_hold in controls, and none in compared"},
             {whole + "compared = [{ name = \"LBS\", role = \"must_fail\" }]\n",
              "claims.toml:14: role = must_fail: expected must_fail or must_hold in controls, and none in compared"},
             {whole + "controls = [{ name = \"LBS\", role = \"might\" }]\n",
              "claims.toml:14: role = might: expected must_fail or must_hold"},
         })
        EXPECT_EQ(message_of(text), message);
    EXPECT_EQ(message_of(std::string("\1\2", 2)).substr(0, 14), "claims.toml:1:");
    EXPECT_EQ(message_of("[" + std::string(100, '.') + "]\n").substr(0, 21), "claims.toml:1: key = ");
    std::string other_unit = whole;
    other_unit.replace(other_unit.find("body"), 4, "bone");
    EXPECT_EQ(message_of(other_unit), R"(claims.toml:10: unit = ["bone"]: bone: expected fields of a key, as body or joint, or quantity)");
}

}  // namespace
