// Studies -> records -> verdicts: runs what the asked claims rest on, then judges them from the records on disk.
#pragma once

#include <string>
#include <vector>

namespace experiments {

struct ReproduceArguments {
    std::vector<std::string> names;  // claims or studies; empty: all
    std::string folder = "results/reproduce";
    bool full = false, resume = false;
    int jobs = 2;
};

// Writes DIR/STUDY/RUN/..., DIR/claims.json and DIR/claims.md; prints the table of claims. The exit status: 1 where a verdict could not
// be computed.
int reproduce(const ReproduceArguments& arguments);

}  // namespace experiments
