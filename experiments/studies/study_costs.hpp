// What the runs of a study were expected to cost and what they did, kept over resumed runs in DIR/STUDY/costs.csv.
//   StudyCosts costs(folder);
//   costs.add("limb_twist", 80.0, 71.4);
//   costs.write();
#pragma once

#include "experiments/studies/study.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct RunCost {
    std::string run;
    double expected_s = 0.0, cpu_s = 0.0;  // of one core
    std::optional<double> wall_s = {};     // by the clock on the wall; older records have none
};

class StudyCosts {
public:
    explicit StudyCosts(const std::string& folder);  // with the rows of runs that are kept from before, if any

    void add(const std::string& run, double expected_s, double cpu_s);
    // A run that ended without a row, because its reproduce was killed, gets what its run.json says; rows of the runs that
    // ended, in the order of the plan.
    void complete(const std::string& folder, const StudyPlan& plan);
    void write() const;

    double expected_s() const;
    double cpu_s() const;

private:
    std::string file_;
    std::vector<RunCost> runs_;
};

// A table of what the studies will cost, study by study, and how long that takes with so many runs side by side.
struct ExpectedCost {
    std::string study;
    int runs = 0;
    double cpu_s = 0.0, wall_s = 0.0;
};
ExpectedCost expected_cost(const Study& study, const std::vector<StudyRun>& runs, int jobs);
std::string expected_cost_table(const std::vector<ExpectedCost>& costs);

// The same with what it did cost: a study outside a factor of two is pointed at.
std::string cost_table(const std::vector<std::pair<std::string, StudyCosts>>& studies);

}  // namespace experiments
