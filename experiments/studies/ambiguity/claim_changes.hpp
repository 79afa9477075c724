// The changes that each reading makes in the judged values of each claim: the values of A and B, and whether the claim's bound judges them
// otherwise.
//   ReadingComparison comparison("limb", readings);
//   comparison.measure({"C03", "C12"}, [&](const auto& touching) { return values_of_starts(of, touching); });
//   table_of(used_columns(claim_change_columns(), changes), changes).write("ambiguity.csv");
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "analysis/verdicts/verdict.hpp"
#include "experiments/studies/ambiguity/reading.hpp"
#include "experiments/studies/study.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace experiments {

// A value that a claim is judged by, for a character that is moved by one reading, and whether it lies in the claim's bound.
//   const std::vector<JudgedValue> values = judged(measurements);   // only of quantities that a claim is judged by
//   const std::vector<JudgedValue> of_sweep = judged(read_motion);   // C01, C02
struct JudgedValue {
    std::string claim, quantity;
    analysis::CaseKey of;
    std::string unit, bound;
    double value = 0.0;
    analysis::Extent extent = analysis::Extent::none;  // of the claim, by this value
    analysis::Limit limit = analysis::Limit::none;     // where the value only bounds the quantity
};

// A quantity that a claim is judged by and that is not measured of readings.
struct LeftOutQuantity {
    std::string claim, quantity, reason;
};

// The values of the measured claims by one reading.
struct ReadingValues {
    std::vector<JudgedValue> values;
    bool broke_down = false;  // some positions are not finite
    std::vector<LeftOutQuantity> left_out = {};
};

// The quantities that the claim is judged by and that are not among those measured.
std::vector<LeftOutQuantity> all_but(const std::string& claim, const std::vector<std::string>& measured, const std::string& reason);

std::vector<JudgedValue> judged(const std::vector<analysis::Measurement>& measured);

// C01: the mean of its metrics over the frames; C02: the share of frames within; both judged as analysis::judge_case does.
std::vector<JudgedValue> judged(const ReadMotion& moved);

// A hash of everything that decides whether a value holds: another bound gives another digest.
std::string digest_of(const std::vector<analysis::Claim>& claims);

// verdict_flips: yes, no, not_touched, no_value. A value that B lacks because the reading broke down does not hold, so the verdict flips
// where A's held. Where A or B has no value for another reason, there is no statement about the verdict. A quantity that is left out of
// readings has a row with the reason.
struct ClaimChange {
    std::string body, place, reading_a, reading_b, claim;
    std::string quantity = {};
    analysis::CaseKey of = {};
    std::string unit = {}, bound = {};  // unit: of a, b and change
    std::optional<double> a = {}, b = {}, change = {}, b_over_a = {};
    std::string holds_a = {}, holds_b = {};  // whole, part, none
    std::string verdict_flips = {}, reason = {};
};
const analysis::Columns<ClaimChange>& claim_change_columns();  // case_body: of the value's case, or its scene

std::vector<ClaimChange> claim_changes(const std::string& body, const std::string& claim, const Reading& reading, const ReadingValues& a,
                                       const ReadingValues& b);
ClaimChange untouched_claim(const std::string& body, const std::string& claim, const Reading& reading, const std::string& reason);

// Readings and their baselines, claim by claim. Only readings that can touch one of the claims are measured, and their baselines before
// them.
class ReadingComparison {
public:
    using Measure = std::function<std::vector<ReadingValues>(const std::vector<Reading>&)>;  // one per reading

    ReadingComparison(const std::string& body, const std::vector<Reading>& readings) : body_(body), readings_(readings) {}

    void measure(const std::vector<std::string>& claims, const Measure& measure);

    const std::vector<ClaimChange>& changes() const { return changes_; }
    const std::string& breakdown() const { return breakdown_; }  // of readings, if any

private:
    const Reading& baseline_of(const Reading& reading) const;

    std::string body_, breakdown_;
    std::vector<Reading> readings_;
    std::vector<ClaimChange> changes_;
};

// The changes as people read them, at most 120 columns wide: one block per body, one line per reading, one column per claim. A cell is B
// over A of the value whose verdict flips, or else of the one that changes most. The lines below state by which readings each claim flips,
// and why others cannot touch it.
std::string claim_changes_text(const std::vector<ClaimChange>& changes);

}  // namespace experiments
