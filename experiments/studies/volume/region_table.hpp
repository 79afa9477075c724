// The bones and joints at which a body loses its volume, from the regions.csv of runs.
#pragma once

#include "experiments/run/run_records.hpp"

#include <string>
#include <vector>

namespace experiments {

struct RunRegions {
    std::string run;  // its name in reports
    std::vector<RegionChange> regions;
};

// A row for each run, for LBS and PBS, and for each kind of region: the sum over all regions, and the `most` regions with the greatest
// losses, in shares of the body's volume and of their own.
std::string region_text(const std::vector<RunRegions>& runs, int most = 3);

// All rows of all runs, with a column `run` in front.
analysis::CsvTable region_csv(const std::vector<RunRegions>& runs);

}  // namespace experiments
