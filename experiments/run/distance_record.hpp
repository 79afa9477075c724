// distances.csv: how far apart two deformers put the same points, in each frame that is written; one row a frame and pair.
//   frame, time_s, deformer, other, of, points   of: rendered surface, or mesh where the body has none
//   rms_mm, largest_mm                           over the points
//   DistanceRecord record;   record.add(frame, time_s, "pbs", "mesh", positions);   record.table().write("distances.csv");
#pragma once

#include "analysis/records/csv_table.hpp"
#include "pbs/geometry/types.hpp"

#include <string>
#include <utility>
#include <vector>

namespace experiments {

class DistanceRecord {
public:
    // points: #P x 3 [m], the same for all deformers of a frame.
    void add(int frame, double time_s, const std::string& label, const std::string& of, const pbs::Positions& points);

    const analysis::CsvTable& table() const { return table_; }

private:
    int frame_ = -1;
    std::vector<std::pair<std::string, pbs::Positions>> before_;  // of this frame
    analysis::CsvTable table_{{"frame", "time_s", "deformer", "other", "of", "points", "rms_mm", "largest_mm"}};
};

}  // namespace experiments
