// The headline of a claim states in few words, for a table, what was measured: the template `headline` of claims.toml
// is filled from facts.
//   headline = "in {held} of {n} poses"                      // in 29 of 29 poses
//   headline = "{least} to {most} {unit} in {n} clips"       // 6.4 to 17 % in 8 clips
//   headline = "{most at precision=f64} in double"           // 4.6e-15 in double: of the cases with this field
//   headline = "{held} of {n}; wrong weights: {held of NAME}"  // NAME: a control or comparison of the claim
// The facts are held and n (cases that hold and that count; of a claim about printed numbers, values), least and most
// (numbers of the cases that count, of the first quantity), least_pct and most_pct (the same times 100) and unit. Only
// placeholders give numbers, so that no text can contradict the records.
#pragma once

#include "analysis/verdicts/verdict.hpp"

#include <string>

namespace analysis {

inline constexpr std::size_t most_short_words = 8, most_short_characters = 32;  // of Claim::short_name
inline constexpr std::size_t most_headline_characters = 30;  // of Claim::headline without its placeholders

// The rule that the short name or the headline of the claim breaks; empty if it breaks none.
std::string short_name_fault(const Claim& claim);
std::string headline_fault(const Claim& claim);

// The headline with its numbers; empty if a number is not known, as without a record.
std::string measured_text(const Verdict& verdict);

// The requirement for the numbers in the headline: 95 % of the cases, all printed values, or the threshold: 12 to 16 %;
// 30 or more. Empty for a claim that asks nothing.
std::string asked_text(const Claim& claim);

// 0.9 to 1.1; 1.05 or more; above 0; below 1; empty without an end. A threshold right beside a round number excludes
// this number.
std::string threshold_text(const Threshold& threshold);

}  // namespace analysis
