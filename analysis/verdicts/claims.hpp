// The paper's claims as data: each states what is claimed and where, the study and metric that measure it, and the bound fixed beforehand.
//   for (const Claim& claim : parse_claims(text, "claims.toml")) verdicts.push_back(judge(claim, records));
// The fields are documented at the head of experiments/verdicts/claims.toml.
#pragma once

#include "analysis/verdicts/case_record.hpp"

#include <limits>
#include <string>
#include <vector>

namespace analysis {

// The rule by which a claim holds.
enum class ClaimRule { share_within, mean_within, measured, printed, untestable };

inline constexpr double open_end = 1e9;  // the `high` of claims.toml for a bound that any finite value meets, however large

// The bound of one quantity that a study measures.
struct QuantityBound {
    std::string quantity;                                                                                   // one of the claim's metrics
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();  // in its unit; infinite: none
};

// A quantity that claims name: its title and its unit (1: none).
struct Quantity {
    std::string name, title, unit;
};

// One table [[claim]]; members that its rule does not need are empty or have their default.
struct Claim {
    std::string id, statement, place, study;   // place: in the paper; study: its name, as for `pbskin reproduce`
    double cost_minutes = 0.0;                 // cost of the study's quick form on 2 cores
    ClaimRule rule = ClaimRule::share_within;  // the rule by which it is judged
    std::vector<std::string> metrics;          // the claim's own metric comes first
    std::string deformer;                      // share_within, mean_within: the deformer whose records are judged
    CaseKey of = {};                           // measured: values of the metrics with other fields are controls and not part of the verdict
    std::string subject = "body";              // measured: the field of the key that names the subjects of the claim
    std::vector<std::string> each = {};        // measured: fields of the key; values that differ in them are counted apart
    std::vector<std::string> compared = {};    // other deformers measured with the claim's own metric; not part of the verdict
    std::vector<std::string> reported = {};    // measured: other quantities; not part of the verdict
    std::vector<Quantity> quantities = {};     // titles and units of metrics and reported, where the file states them
    std::vector<QuantityBound> bounds = {};    // bounds of single quantities, which replace low and high
    std::string orders;                        // the deformer in other orders and precisions; judged likewise, but not part of the verdict
    int iterations = 0;                        // 0: any
    double expected = 0.0, low = 0.0, high = 0.0;  // the paper's value and the bound on the metric, in its unit
    double share = 0.95;                           // share of the frames that must hold
    double part = 0.25;                            // share of a sweep that must hold for it to count in part
    double level = 0.95;                           // confidence level of the intervals
    std::string reason;                            // why the claim cannot be tested
    std::vector<std::string> formulae = {};        // how the values of the metrics are computed
};

// InputError with file and line for broken TOML, unknown or missing keys, a duplicate claim, or a bound that no value can meet.
std::vector<Claim> parse_claims(const std::string& text, const std::string& file);

const char* name_of(ClaimRule rule);  // as in claims.toml

}  // namespace analysis
