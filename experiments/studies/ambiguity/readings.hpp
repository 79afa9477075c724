// Other readings of the paper, and the change of the values by which claims are judged.
//   const std::vector<Reading> readings = readings_of(study_case);
//   claim_changes(reading, claim_values(claims, measured_by_a), claim_values(claims, measured_by_b));
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "analysis/verdicts/verdict.hpp"
#include "experiments/studies/study.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

// A reading of a place in the paper that can be read in more than one way, as keys of a scene. A baseline has no place.
struct Reading {
    std::string place, name, baseline;
    Overrides overrides;  // with those of the baseline
};

// The readings of cases.toml, each after its baseline, except those that the case goes `without`.
std::vector<Reading> readings_of(const StudyCase& study_case);

// A value by which a claim is judged, in one case.
struct ClaimValue {
    std::string claim, quantity;
    analysis::JudgedCase judged;
};

// One value per quantity and case of the claims, whatever the settings of the solver are. A reading may set k_stretch,
// which is no part of the case here.
std::vector<ClaimValue> claim_values(const std::vector<std::string>& claims,
                                     const std::vector<analysis::Measurement>& measured);

// A row of ambiguity.csv: the value by the baseline (a) and by the reading (b). verdict_flips: yes or no, or no_value
// where one of them has none.
struct ClaimChange {
    analysis::CaseKey of;
    std::string place, reading_a, reading_b, claim, quantity, unit, bound;  // unit: of a, b and change
    std::optional<double> a = {}, b = {}, change = {}, b_over_a = {};
    std::string holds_a = {}, holds_b = {}, verdict_flips = {}, reason = {};
};
const analysis::Columns<ClaimChange>& claim_change_columns();

// One row per value that the baseline or the reading has.
std::vector<ClaimChange> claim_changes(const Reading& reading, const std::vector<ClaimValue>& a,
                                       const std::vector<ClaimValue>& b);

// Measures the claims of a case by each reading, each after its baseline, and writes ambiguity.csv into the folder.
// Returns what broke down, and by which reading.
std::string compare_readings(const StudyCase& study_case, const std::vector<Reading>& readings,
                             const std::string& folder);

}  // namespace experiments
