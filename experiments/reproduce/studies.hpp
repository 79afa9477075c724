// The list of the studies, and what is done with any of them: runs are carried out or found finished, tables are
// concluded, and costs are recorded.
#pragma once

#include "experiments/studies/study.hpp"

#include <string>
#include <vector>

namespace experiments {

const std::vector<Study>& studies();

// Writes the tables over all runs, and returns whether the study holds. Without a finished run a study with such tables
// does not hold, and nothing is written.
bool study_holds(const Study& study, const FinishedRuns& finished);

// True if the run in `folder` finished with this scene or these settings and this revision, so that it need not be
// repeated.
bool is_finished(const StudyRun& run, const std::string& folder);

// Does the run and returns what broke down numerically, or "".
std::string carry_out(const StudyRun& run, const std::string& folder);

// The text that carry_out returned for the finished run in `folder`.
std::string breakdown_on_record(const StudyRun& run, const std::string& folder);

// Writes the expected and the actual cost of the finished runs of a study, which their run.json states, to
// DIR/STUDY/costs.csv.
void write_costs(const std::string& folder, const StudyPlan& plan);

// The expected wall time of these runs with this number of them in parallel [s].
double expected_wall_s(const Study& study, const std::vector<StudyRun>& runs, int jobs);

}  // namespace experiments
