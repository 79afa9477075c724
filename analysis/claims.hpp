// The paper's claims as data: what is claimed, where, by which study and metric it is measured, and the bound fixed beforehand.
//   for (const Claim& claim : parse_claims(text, "claims.toml")) verdicts.push_back(judge(claim, records));
// The fields are documented at the head of experiments/verdicts/claims.toml.
#pragma once

#include "analysis/case_key.hpp"

#include <limits>
#include <string>
#include <vector>

namespace analysis {

// What makes a claim hold.
enum class ClaimRule { share_within, mean_within, measured, printed, untestable };

inline constexpr double open_end = 1e9;  // what claims.toml writes as `high` where finite values alone hold, however large

// The bound of one quantity that a study measures.
struct QuantityBound {
    std::string quantity;                                                                                   // one of the claim's metrics
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();  // in its unit; infinite: any
};

// A quantity that claims name: what it is called, and its unit (1: none).
struct Quantity {
    std::string name, title, unit;
};

// A [[claim]]; what its rule does not ask for is empty or at its default.
struct Claim {
    std::string id, statement, place, study;       // place: where the paper makes it; study: by name, as of `pbskin reproduce`
    double cost_minutes = 0.0;                     // of the study's quick form on 2 cores
    ClaimRule rule = ClaimRule::share_within;      // by which it is judged
    std::vector<std::string> metrics;              // the claim's own first
    std::string deformer;                          // whose records are judged by share_within, mean_within
    CaseKey of = {};                               // measured: values of metrics with other fields are controls, no part of the verdict
    std::string subject = "body";                  // measured: the field of the key that says for whom or what the claim holds
    std::vector<std::string> each = {};            // measured: fields of the key; values that differ in them are counted apart
    std::vector<std::string> compared = {};        // other deformers under the claim's own metric; no part of the verdict
    std::vector<std::string> reported = {};        // measured: other quantities; no part of the verdict
    std::vector<Quantity> quantities = {};         // titles and units of metrics and reported, as far as the file gives them
    std::vector<QuantityBound> bounds = {};        // of single quantities, in place of low and high
    std::string orders;                            // the deformer in other orders and precisions; judged likewise, no part of the verdict
    int iterations = 0;                            // 0: any
    double expected = 0.0, low = 0.0, high = 0.0;  // the paper's value and the bound, of the metric, in its unit
    double share = 0.95;                           // of the frames that must hold
    double part = 0.25;                            // of a sweep that must hold for it to count in part
    double level = 0.95;                           // of the intervals
    std::string reason;                            // why it cannot be tested
    std::vector<std::string> formulae = {};        // how the values of metrics are computed
};

// InputError with file and line for broken TOML, unknown or missing keys, a claim twice, or a bound that no value can meet.
std::vector<Claim> parse_claims(const std::string& text, const std::string& file);

const char* name_of(ClaimRule rule);  // as claims.toml writes it

}  // namespace analysis
