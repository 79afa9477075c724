// The list of the studies, and what is done with any of them: runs are carried out or found finished, tables are
// concluded, and costs are recorded.
#pragma once

#include "experiments/studies/study.hpp"

#include <optional>
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

// The expected and the actual cost of the runs of a study, in DIR/STUDY/costs.csv. The file is kept when a study is
// resumed.
//   StudyCosts costs(folder);
//   costs.add("limb_twist", 80.0, 71.4);
//   costs.write();
struct RunCost {
    std::string run;
    double expected_s = 0.0, cpu_s = 0.0;  // processor time
    std::optional<double> wall_s = {};     // wall time; older records have none
};

class StudyCosts {
public:
    explicit StudyCosts(const std::string& folder);  // with the rows of an earlier file, if there is one

    void add(const std::string& run, double expected_s, double cpu_s);
    // Keeps the rows of the finished runs, in the order of the plan. A finished run without a row, because its
    // `reproduce` was killed, gets the cost that its run.json has.
    void complete(const std::string& folder, const StudyPlan& plan);
    void write() const;

private:
    std::string file_;
    std::vector<RunCost> runs_;
};

// The expected cost of a study, and the wall time with this number of runs in parallel.
struct ExpectedCost {
    std::string study;
    int runs = 0;
    double cpu_s = 0.0, wall_s = 0.0;
};
ExpectedCost expected_cost(const Study& study, const std::vector<StudyRun>& runs, int jobs);
std::string expected_cost_table(const std::vector<ExpectedCost>& costs);  // one line per study, and their sum

}  // namespace experiments
