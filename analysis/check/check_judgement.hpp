// Compares a scene's metrics.csv with a bound and with a baseline.
#pragma once

#include "analysis/check/check_report.hpp"
#include "analysis/check/check_rules.hpp"
#include "analysis/records/tables.hpp"

namespace analysis {

// Every frame of the bound must lie within it. The case names the frame farthest outside or, if all hold, the one nearest to the bound. For
// a two-sided bound that holds, it names the smallest and the largest value. InputError if the scene lacks the deformer, the frames or the
// values.
CheckCase judge_bound(const CheckBound& bound, const std::string& unit, const CsvTable& metrics, const std::string& rules_file);

// The columns of a baseline, which has one row per scene, deformer and frame: counts, the metrics that have a tolerance, and step_ms.
CsvTable baseline_columns(const CheckRules& rules);
// Adds the frames of a scene's metrics.csv in their order. Metrics that the scene does not measure get empty cells. InputError as for
// CsvTable.
void add_baseline_rows(CsvTable& baseline, const std::string& scene, const CsvTable& metrics, int vertices, int tets);

// InputError if the baseline lacks a column, or contains a frame of a scene's deformer twice.
void require_baseline(const CheckRules& rules, const CsvTable& baseline, const std::string& baseline_file);

// One failed case for each scene that the baseline contains and the rules no longer name.
std::vector<CheckCase> scenes_gone(const CheckRules& rules, const CsvTable& baseline, const std::string& baseline_file);

// One case per deformer: in every frame the counts (vertices, tets, iterations) must be equal and the metrics within their tolerances.
// InputError if the baseline contains something else than numbers there.
std::vector<CheckCase> compare_with_baseline(const CheckRules& rules, const std::string& scene, const CsvTable& now,
                                             const CsvTable& baseline, const std::string& baseline_file);

// "1.234 ms per step, 1.05 of the baseline's" for each deformer. Times depend on the machine, so they are shown and never judged.
std::vector<std::pair<std::string, std::string>> step_times(const std::string& scene, const CsvTable& now, const CsvTable* baseline);

}  // namespace analysis
