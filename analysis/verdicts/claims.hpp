// The paper's claims as data: each states what is claimed and where, the study and the quantity that measure it, the
// threshold that was fixed beforehand, and the controls that show that the threshold can be missed and met.
//   for (const Claim& claim : parse_claims(text, "claims.toml")) verdicts.push_back(judge(claim, records));
// The fields are documented at the head of experiments/verdicts/claims.toml.
#pragma once

#include "analysis/verdicts/case_record.hpp"

#include <limits>
#include <string>
#include <vector>

namespace analysis {

// The rule by which a claim is judged.
enum class ClaimRule {
    cases,       // the share of its cases that hold
    single,      // one number, by its interval
    printed,     // printed values against those that the paper's others require
    definition,  // the sentence defines a word: there is nothing to measure
    untestable,  // for `reason`
};

// The mean of the dependent values of a case.
enum class Mean { arithmetic, geometric };

// A threshold of the values of a quantity, or of all where none is named, whose key agrees with `of`; infinite: none.
struct Threshold {
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    std::string quantity = {};
    CaseKey of = {};
    bool operator==(const Threshold&) const = default;
    bool contains(double value) const { return low <= value && value <= high; }  // false for NaN
};

// What a selection of values is for.
enum class Role {
    claimed,           // the claim's own values
    negative_control,  // a control that must fail: it shows that the threshold can be missed
    positive_control,  // a control that must hold: it shows that the threshold can be met
    comparison,        // printed next to the claim, no part of the verdict
};

// Values of the claim's study: the quantities with all fields of `of`. Each is divided by the value of the same case
// with the fields of `over`, if there are any. A case with several quantities holds if all of them do; the first one is
// its number.
struct Selection {
    std::string name;  // as reports show it: LBS; flesh, nu 0.49
    Role role = Role::claimed;
    std::vector<std::string> quantities = {};
    CaseKey of = {}, over = {};
    std::vector<Threshold> thresholds = {};  // the first one that applies to a case
};

// A quantity that claims name: its title and its unit (1: none).
struct Quantity {
    std::string name, title, unit;
};

// One table [[claim]]; members that its rule does not need are empty or have their default.
struct Claim {
    // place: in the paper; study: its name, as for `pbskin reproduce`
    std::string id = {}, statement = {}, place = {}, study = {};
    std::string short_name = {};  // the claim in at most eight words
    // what was measured in few words; headline.hpp defines its placeholders
    std::string headline = {};
    double cost_minutes = 0.0;  // cost of the study's quick form on 2 cores
    ClaimRule rule = ClaimRule::cases;
    Selection own = {};  // the claim's own values
    // fields of the key, or quantity: the values that agree in them are one case
    std::vector<std::string> case_fields = {};
    Mean mean = Mean::arithmetic;        // of the values of a case
    std::string source = {};             // where the threshold comes from
    std::string range = {};              // what the ranges of the values span: meshes, timing rounds
    std::vector<Selection> others = {};  // controls and comparisons
    // the control whose success excludes a case, since there is nothing to see in it; or empty
    std::string selected_by = {};
    double no_effect = 0.0;  // the share that a method without effect reaches; 0: the share of the negative controls
    // values recorded after the thresholds were fixed, which are judged apart
    std::vector<CaseKey> held_out = {};
    std::string thresholds_fixed_at = {};    // the revision at which thresholds and controls were fixed
    std::string fixed_at = {};               // the revision at which the rule was fixed
    std::string reason = {};                 // why the claim is a definition or cannot be tested
    std::vector<std::string> formulae = {};  // how the values are computed
    std::vector<Quantity> quantities = {};   // titles and units of all quantities that the file names
};

// InputError with file and line for broken TOML, unknown or missing keys, a duplicate claim, or a threshold that no
// value can meet.
std::vector<Claim> parse_claims(const std::string& text, const std::string& file);

const char* name_of(ClaimRule rule);  // as in claims.toml
const char* name_of(Role role);

}  // namespace analysis
