// Which bones and joints a body loses its volume at: the regions.csv of runs, the greatest losses first.
#pragma once

#include "experiments/run/region_record.hpp"

#include <string>
#include <vector>

namespace experiments {

struct RunRegions {
    std::string run;  // as to be named
    std::vector<RegionChange> regions;
};

// For each run, LBS and PBS, and each kind of region: the `most` that lose most, in shares of the body's volume, and how much of it they
// hold.
std::string region_text(const std::vector<RunRegions>& runs, int most = 3);

// All rows of all runs, with a column `run` before them.
analysis::CsvTable region_csv(const std::vector<RunRegions>& runs);

}  // namespace experiments
