// The changes that each reading makes in the judged values of each claim: the values of A and B, and whether the claim's bound judges them
// otherwise.
//   ReadingComparison comparison("limb", readings);
//   comparison.measure({"C03", "C12"}, [&](const auto& touching) { return values_of_starts(of, touching); });
//   table_of(used_columns(claim_change_columns(), changes), changes).write("ambiguity.csv");
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/verdict.hpp"
#include "experiments/studies/ambiguity/judged_value.hpp"

#include <functional>
#include <optional>

namespace experiments {

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

}  // namespace experiments
