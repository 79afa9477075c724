// Holds a scene's metrics.csv against a bound, and against a baseline.
#pragma once

#include "analysis/check/check_case.hpp"
#include "analysis/check/check_rules.hpp"
#include "analysis/records/csv_table.hpp"

namespace analysis {

// Every frame of the bound must be within; the case names the frame farthest out, or, where all hold, nearest to the bound; of a bound on
// both sides that holds the least and the largest figure. InputError where the scene has no such deformer, frames or figures.
CheckCase judge_bound(const CheckBound& bound, const std::string& unit, const CsvTable& metrics, const std::string& rules_file);

// The frames of a baseline: one row a scene, deformer and frame, with counts, the metrics that have a tolerance, and step_ms.
CsvTable baseline_columns(const CheckRules& rules);
// Adds the frames of a scene's metrics.csv, in its order; empty cells for metrics that the scene does not measure. InputError as
// CsvTable.
void add_baseline_rows(CsvTable& baseline, const CheckRules& rules, const std::string& scene, const CsvTable& metrics, int vertices,
                       int tets);

// InputError where the baseline lacks a column, or has a frame of a scene's deformer twice.
void require_baseline(const CheckRules& rules, const CsvTable& baseline, const std::string& baseline_file);

// A failed case a scene that the baseline has and the rules no longer have.
std::vector<CheckCase> scenes_gone(const CheckRules& rules, const CsvTable& baseline, const std::string& baseline_file);

// A case a deformer: counts (vertices, tets, iterations) as they were, metrics within their tolerances, in every frame. InputError where
// the baseline has something else than numbers there.
std::vector<CheckCase> compare_with_baseline(const CheckRules& rules, const std::string& scene, const CsvTable& now,
                                             const CsvTable& baseline, const std::string& baseline_file);

// "1.234 ms a step, 1.05 of the baseline's": of each deformer; of this machine, so that it is shown and never judged.
std::vector<std::pair<std::string, std::string>> step_times(const std::string& scene, const CsvTable& now, const CsvTable* baseline);

}  // namespace analysis
