// Studies -> records -> verdicts: runs what the asked claims rest on, then judges them from the records on disk.
#pragma once

#include <string>
#include <vector>

namespace experiments {

struct ReproduceArguments {
    std::vector<std::string> names;  // claims or studies; empty: the studies that run by default
    std::string folder = "results/reproduce";
    bool full = false, resume = false;
    bool cost_only = false;  // say what it would take, run nothing
    int jobs = 2;
};

// Writes DIR/STUDY/RUN/... and, where claims were judged, DIR/claims.json and DIR/claims.md; prints the table of claims and what studies
// conclude. The exit status: 1 where a verdict could not be computed or a study's own bounds do not hold.
int reproduce(const ReproduceArguments& arguments);

// Runs nothing: judges the records that lie in the folder already, and writes claims.json and claims.md anew.
int judge_again(const ReproduceArguments& arguments);

}  // namespace experiments
