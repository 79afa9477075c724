// The verdicts on the kept records under wrong data: labels exchanged between methods, ratios inverted, values permuted
// among methods within each case, sizes shuffled. A verdict that holds or is mixed must be lost, except where
// attacks.toml states why the sentence stays true; one that is lost must not turn into one that holds. Reference: that
// table, which was written before the attacks were run. The test prints one line per claim and attack, with the broken
// solvers that other tests put in the place of PBS:
//   build/release/tests/test_claims_experiments --gtest_filter='Attacks.*'
#include "analysis/records/record_files.hpp"
#include "analysis/statistics/fits.hpp"
#include "tests/support/study_claims.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <filesystem>
#include <map>
#include <random>
#include <set>

namespace attacks_tests {
namespace {

using namespace analysis;
using enum VerdictKind;

constexpr int permutations = 2000;
constexpr double least_lost = 0.99;  // of the permutations

using Rows = std::vector<Measurement>;

// The values of each study's kept records; those of frames are among them.
const Records& kept(const std::string& study)
{
    static std::map<std::string, Records> all;
    if (const auto found = all.find(study); found != all.end()) return found->second;
    const experiments::OpenedRecords opened(PBS_KEPT_RECORDS, {{study}});
    Records records =
        experiments::read_study_records((std::filesystem::path(opened.folder()) / study).string(), opened.folder());
    for (const CaseRecord& record : records.cases)
        for (Measurement& one : frame_measurements(record)) records.measurements.push_back(std::move(one));
    records.cases.clear();
    records.planned_scenes.clear();
    return all.emplace(study, records).first->second;
}

bool is_of(const Selection& selection, const CaseKey& of, const Measurement& one)
{
    return std::ranges::count(selection.quantities, one.quantity) > 0 && matches(one.of, of);
}

// The rows that the claim reads, so that the many judgements of permuted values are quick.
Rows rows_of(const Claim& claim)
{
    std::vector<Selection> all = claim.others;
    all.push_back(claim.own);
    Rows rows;
    const auto reads = [](const Selection& of, const Measurement& one) {
        return is_of(of, of.of, one) || (of.over != CaseKey{} && is_of(of, of.over, one));
    };
    for (const Measurement& one : kept(claim.study).measurements)
        if (std::ranges::any_of(all, [&](const Selection& of) { return reads(of, one); })) rows.push_back(one);
    return rows;
}

VerdictKind judged_on(const Claim& claim, const Rows& rows)
{
    if (claim.rule != ClaimRule::cases) return judge(claim, {.measurements = rows}).kind;
    Rows judged;
    std::ranges::copy_if(rows, std::back_inserter(judged), [&](const Measurement& one) {
        return std::ranges::none_of(claim.held_out, [&](const CaseKey& key) { return matches(one.of, key); });
    });
    return kind_on(claim, judged);
}

bool is_lost(VerdictKind kind)
{
    return kind == fails || kind == not_shown || kind == inconclusive;
}

// The fields that `from` sets are emptied, and those of `to` are set.
CaseKey relabelled(CaseKey key, const CaseKey& from, const CaseKey& to)
{
    for (const CaseKeyField& field : case_key_fields()) {
        if (!field.is_set(from) && !field.is_set(to)) continue;
        if (field.text)
            key.*field.text = to.*field.text;
        else
            key.*field.number = to.*field.number;
    }
    return key;
}

// measured: the selection whose quantities both have.
Rows exchanged(Rows rows, const Selection& measured, const CaseKey& first, const CaseKey& second)
{
    for (Measurement& one : rows)
        if (is_of(measured, first, one))
            one.of = relabelled(one.of, first, second);
        else if (is_of(measured, second, one))
            one.of = relabelled(one.of, second, first);
    return rows;
}

Limit inverted(Limit limit)
{
    return limit == Limit::at_most ? Limit::at_least : limit == Limit::none ? Limit::none : Limit::at_most;
}

bool is_ratio(const std::string& quantity)
{
    return quantity.find("_over_") != std::string::npos;
}

template <typename IsInverted>
Rows inverted(Rows rows, const IsInverted& is_inverted)
{
    for (Measurement& one : rows) {
        if (!is_ratio(one.quantity) || !is_inverted(one)) continue;
        one.value = 1.0 / one.value;
        std::tie(one.low, one.high) = std::pair(1.0 / one.high, 1.0 / one.low);
        one.limit = inverted(one.limit);
    }
    return rows;
}

bool is_of_ratios(const Claim& claim)
{
    return std::ranges::all_of(claim.own.quantities, is_ratio);
}

// The labels whose values can change places: the claim's own, its controls and comparisons by the same measure, and
// what they are divided by. A ratio to a control without effect has that control as a label too, of which the value
// is 1.
std::vector<CaseKey> labels_of(const Claim& claim)
{
    std::vector<CaseKey> labels = {claim.own.of};
    for (const Selection& other : claim.others)
        if (other.quantities == claim.own.quantities && other.over == claim.own.over) labels.push_back(other.of);
    if (claim.own.over != CaseKey{}) labels.push_back(claim.own.over);
    return labels;
}

// One case: for each label that has values in it, their places among the rows.
using CasePlaces = std::vector<std::vector<std::size_t>>;

std::vector<CasePlaces> cases_of(const Claim& claim, const Rows& rows)
{
    std::map<std::string, std::map<std::size_t, std::vector<std::size_t>>> cases;
    const std::vector<CaseKey> labels = labels_of(claim);
    for (std::size_t row = 0; row < rows.size(); ++row)
        for (std::size_t label = 0; label < labels.size(); ++label) {
            if (!is_of(claim.own, labels[label], rows[row])) continue;
            std::string one_case = rows[row].quantity;
            for (const std::string& name : claim.case_fields)
                if (const CaseKeyField* field = case_key_field(name))
                    one_case += "|" + value_text(*field, rows[row].of);
            cases[one_case][label].push_back(row);
            break;
        }
    std::vector<CasePlaces> all;
    for (const auto& [one_case, of_labels] : cases) {
        CasePlaces& places = all.emplace_back();
        for (const auto& [label, of_label] : of_labels) places.push_back(of_label);
    }
    return all;
}

// Fisher and Yates' shuffle, the same with every standard library.
void shuffle(std::vector<double>& values, std::mt19937& random)
{
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[random() % i]);
}

// Gives the rows the values of `from`, permuted within each case. The other rows stay.
void permute(Rows& rows, const Rows& from, const Claim& claim, const std::vector<CasePlaces>& cases,
             std::mt19937& random)
{
    const bool has_unity = claim.no_effect > 0.0 && is_of_ratios(claim);
    for (const CasePlaces& labels : cases) {
        std::vector<double> values;
        for (const auto& places : labels) {
            std::vector<double> of_label;
            for (const std::size_t row : places) of_label.push_back(from[row].value);
            values.push_back(mean(of_label));
        }
        if (has_unity) values.push_back(1.0);
        shuffle(values, random);
        const double unity = has_unity ? values.back() : 1.0;
        for (std::size_t label = 0; label < labels.size(); ++label)
            for (const std::size_t row : labels[label]) {
                rows[row].value = rows[row].low = rows[row].high = values[label] / unity;
                rows[row].limit = Limit::none;
            }
    }
}

std::map<std::string, std::string> allowed(const std::string& claim)
{
    std::map<std::string, std::string> reasons;
    const toml::table document = toml::parse_file(PBS_ATTACKS_FILE);
    for (const toml::node& entry : *document["keeps"].as_array()) {
        const toml::table& table = *entry.as_table();
        if (table["claim"].value<std::string>() == claim)
            reasons[*table["attack"].value<std::string>()] = *table["why"].value<std::string>();
    }
    return reasons;
}

void print(const std::string& claim, const std::string& attack, const std::string& before, const std::string& after,
           const std::string& why)
{
    fmt::print("{:5} {:55} {:22} {:25} {}\n", claim, attack, before, after, why);
}

// The shares of verdicts that are lost and that hold, after one attack or after many.
struct Outcome {
    double lost = 0.0, held = 0.0;
};

class Attacks : public testing::TestWithParam<std::string> {
protected:
    // One line of the table, and the rule.
    void expect(const std::string& attack, const Outcome& of, const std::string& after)
    {
        const auto reason = reasons_.find(attack);
        const bool is_reasoned = reason != reasons_.end();
        print(claim_.id, attack, name_of(before_), after, is_reasoned ? reason->second : "");
        if ((before_ == holds || before_ == mixed) && !is_reasoned) {
            EXPECT_GE(of.lost, least_lost) << attack;
        }
        if (is_lost(before_) && !is_reasoned) {
            EXPECT_LE(of.held, 1.0 - least_lost) << attack;
        }
        used_.insert(attack);
    }

    void expect(const std::string& attack, VerdictKind after)
    {
        expect(attack, {double(is_lost(after)), double(after == holds)}, name_of(after));
    }

    // Of many random attacks.
    template <typename Draw>
    void expect_of_many(const std::string& attack, const Draw& draw)
    {
        std::mt19937 random(20140528);
        int lost = 0, held = 0;
        for (int i = 0; i < permutations; ++i) {
            const VerdictKind kind = draw(random);
            // One number whose range contains the threshold is mixed: nothing is shown, and a verdict that holds is
            // lost.
            lost += is_lost(kind) || (claim_.rule == ClaimRule::single && kind == mixed);
            held += kind == holds;
        }
        const double lost_share = double(lost) / permutations;
        expect(attack, {lost_share, double(held) / permutations}, fmt::format("{:.1f} % lost", 100.0 * lost_share));
    }

    Claim claim_ = test_support::claim(GetParam());
    Rows rows_ = rows_of(claim_);
    VerdictKind before_ = judged_on(claim_, rows_);
    std::map<std::string, std::string> reasons_ = allowed(claim_.id);
    std::set<std::string> used_;
};

TEST_P(Attacks, LoseTheVerdictOrHaveAReason)
{
    std::vector<Selection> alike;
    for (const Selection& other : claim_.others) {
        if (other.quantities != claim_.own.quantities || other.over != claim_.own.over) {
            print(claim_.id, "exchange: " + other.name, name_of(before_), "not exchanged", "another quantity");
            continue;
        }
        expect("exchange: " + other.name, judged_on(claim_, exchanged(rows_, claim_.own, claim_.own.of, other.of)));
        for (const Selection& one : alike) {
            const VerdictKind after = judged_on(claim_, exchanged(rows_, claim_.own, one.of, other.of));
            print(claim_.id, "exchange: " + one.name + " with " + other.name, name_of(before_), name_of(after),
                  "PBS keeps its values");
            EXPECT_FALSE(is_lost(before_) && after == holds) << one.name << " with " << other.name;
        }
        alike.push_back(other);
    }
    if (std::ranges::any_of(claim_.own.quantities, is_ratio)) {
        expect("inverted", judged_on(claim_, inverted(rows_, [](const Measurement&) { return true; })));
        const auto is_own = [&](const Measurement& one) { return is_of(claim_.own, claim_.own.of, one); };
        expect("inverted: PBS alone", judged_on(claim_, inverted(rows_, is_own)));
    }
    const std::vector<CasePlaces> cases = cases_of(claim_, rows_);
    Rows rows = rows_;  // of the last draw
    expect_of_many("permuted", [&](std::mt19937& random) {
        permute(rows, rows_, claim_, cases, random);
        return judged_on(claim_, rows);
    });
    for (const auto& [attack, why] : reasons_) EXPECT_TRUE(used_.contains(attack)) << attack << ": no such attack";
}

std::vector<std::string> judged_by_cases()
{
    std::vector<std::string> ids;
    for (const Claim& claim : parse_claims(read_text(PBS_CLAIMS_FILE), PBS_CLAIMS_FILE))
        if (claim.rule == ClaimRule::cases) ids.push_back(claim.id);
    return ids;
}

INSTANTIATE_TEST_SUITE_P(OfTheKeptRecords, Attacks, testing::ValuesIn(judged_by_cases()),
                         [](const auto& claim) { return claim.param; });

// C12b: the iterations of the ladder's meshes, each at the size of another one, fitted anew.
class ShuffledSizes : public Attacks {};

TEST_P(ShuffledSizes, LoseTheVerdict)
{
    std::vector<double> vertices, iterations;
    CaseKey of = claim_.own.of;
    for (const Measurement& one : kept(claim_.study).measurements)
        if (one.quantity == "iterations_to_tolerance_of_limbs" && matches(one.of, of) && one.run == rows_.front().run) {
            vertices.push_back(*one.of.vertices);
            iterations.push_back(one.value);
        }
    ASSERT_GE(vertices.size(), 5u);
    expect_of_many("sizes shuffled", [&](std::mt19937& random) {
        shuffle(vertices, random);
        Rows rows = rows_;
        const Interval slope = observed_order(vertices, iterations, 0.99);
        for (Measurement& one : rows)
            std::tie(one.value, one.low, one.high) = std::tie(slope.estimate, slope.low, slope.high);
        return judged_on(claim_, rows);
    });
}

INSTANTIATE_TEST_SUITE_P(OfTheKeptRecords, ShuffledSizes, testing::Values("C12b"),
                         [](const auto& claim) { return claim.param; });

// The rest of the table: claims without an attack, and broken solvers.
TEST(AttackTable, NamesEveryClaim)
{
    std::set<std::string> attacked = {"C12b"};
    for (const std::string& id : judged_by_cases()) attacked.insert(id);
    for (const Claim& claim : parse_claims(read_text(PBS_CLAIMS_FILE), PBS_CLAIMS_FILE)) {
        const auto reasons = allowed(claim.id);
        EXPECT_NE(attacked.contains(claim.id), reasons.contains("none")) << claim.id;
        if (reasons.contains("none")) print(claim.id, "none", name_of(claim.rule), "", reasons.at("none"));
    }
    std::set<std::string> suites;
    const testing::UnitTest& tests = *testing::UnitTest::GetInstance();
    for (int i = 0; i < tests.total_test_suite_count(); ++i) suites.insert(tests.GetTestSuite(i)->name());
    const toml::table document = toml::parse_file(PBS_ATTACKS_FILE);
    for (const toml::node& entry : *document["broken"].as_array()) {
        const toml::table& of = *entry.as_table();
        const auto text = [&](const char* key) { return of[key].value<std::string>().value(); };
        print(text("claim"), "broken: " + text("solver"), "", text("outcome"), text("test"));
        const std::string test = text("test").substr(std::string("claims/").size());
        EXPECT_TRUE(suites.contains(test) || test == "volume") << test;  // claims/volume is in Python
    }
}

}  // namespace
}  // namespace attacks_tests
