// The paper's claims as data: what is claimed, where, by which study and metric it is measured, and the bound fixed beforehand.
//   for (const Claim& claim : parse_claims(text, "claims.toml")) verdicts.push_back(judge(claim, records));
// The fields are documented at the head of experiments/verdicts/claims.toml.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace analysis {

// What makes a claim hold.
enum class ClaimRule { share_within, mean_within, measured, printed, untestable };

// Of the figures of one quantity that a study measures.
struct QuantityBound {
    std::string quantity;                                                                                   // one of the claim's metrics
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();  // in its unit; infinite: any
};

// A [[claim]]; what its rule does not ask for is empty or at its default.
struct Claim {
    std::string id, statement, place, study;       // place: where the paper makes it; study: by name, as of `pbskin reproduce`
    double cost_minutes = 0.0;                     // of the study's quick form on 2 cores
    ClaimRule rule = ClaimRule::share_within;      // by which it is judged
    std::vector<std::string> metrics;              // the claim's own first
    std::string deformer;                          // whose records are judged by share_within, mean_within
    std::vector<std::string> beside;               // other deformers under the same measure, other quantities; no part of the verdict
    std::vector<QuantityBound> bounds = {};        // of single quantities, in place of low and high
    std::string orders;                            // the deformer in other orders and precisions; judged likewise, no part of the verdict
    int iterations = 0;                            // 0: any
    double expected = 0.0, low = 0.0, high = 0.0;  // the paper's figure and the bound, of the metric, in its unit
    double share = 0.95;                           // of the frames that must hold
    double part = 0.25;                            // of a sweep that must hold for it to count in part
    double level = 0.95;                           // of the intervals
    std::string reason;                            // why it cannot be tested
    std::vector<std::string> formulae = {};        // how the figures of metrics come about
};

// InputError with file and line for broken TOML, unknown or missing keys, a claim twice, or a bound that no figure can meet.
std::vector<Claim> parse_claims(const std::string& text, const std::string& file);

}  // namespace analysis
