// What a study leaves for the claims it is about, read back from disk alone: DIR/STUDY/plan.json says which runs there are and what was
// left out, each run's folder holds metrics.csv, printed.csv or measurements.csv.
//   write_study_plan(folder, plan);
//   const analysis::Records records = read_study_records(folder, root);
#pragma once

#include "experiments/studies/study.hpp"

#include <string>
#include <vector>

namespace experiments {

void write_study_plan(const std::string& folder, const StudyPlan& plan);

bool has_study_plan(const std::string& folder);

// The folders of the planned runs that finished, in the plan's order.
FinishedRuns finished_runs(const std::string& folder);

// root: what the runs are named relative to.
analysis::Records read_study_records(const std::string& folder, const std::string& root);

}  // namespace experiments
