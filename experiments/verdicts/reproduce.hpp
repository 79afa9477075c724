// From studies to records to verdicts: runs the studies that the named claims need, then computes the verdicts from the records on disk.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct ReproduceArguments {
    std::vector<std::string> names;  // of claims or studies; empty: the default set of studies
    std::string folder = "results/reproduce";
    bool full = false, resume = false;
    bool cost_only = false;  // runs nothing and prints the expected cost
    int jobs = 2;
    std::optional<std::string> external = {};  // a file with deformers of the user's own, for studies that compare them
    std::vector<std::string> only = {};        // names of runs; the others are kept if they are finished. Empty: all runs of the studies
};

// Writes DIR/STUDY/RUN/... and, if there are verdicts, DIR/claims.json and DIR/claims.md. Prints the table of claims and the conclusions of
// the studies. Returns the exit status: 1 if a verdict could not be computed or a study's own bounds do not hold.
int reproduce(const ReproduceArguments& arguments);

// Runs nothing: computes the verdicts from the records that are in the folder, and writes claims.json and claims.md again.
int judge_again(const ReproduceArguments& arguments);

}  // namespace experiments
