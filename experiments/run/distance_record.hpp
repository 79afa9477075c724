// distances.csv: the distances between the points that two deformers give. One row per written frame and pair of deformers.
//   DistanceRecord record;   record.add(frame, time_s, "pbs", "mesh", positions);   record.table().write("distances.csv");
#pragma once

#include "analysis/records/tables.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <string>
#include <utility>
#include <vector>

namespace experiments {

struct DeformerDistance {
    int frame = 0;
    double time_s = 0.0;
    std::string deformer, other, of;
    int points = 0;
    double rms_mm = 0.0, largest_mm = 0.0;
};
extern const analysis::Columns<DeformerDistance> distance_columns;

class DistanceRecord {
public:
    // points [m]: #P x 3, with the same #P for all deformers of a frame. of: what the points belong to.
    void add(int frame, double time_s, const std::string& label, const std::string& of, const pbs::Positions& points);

    analysis::CsvTable table() const { return table_of(distance_columns, distances_); }

private:
    int frame_ = -1;
    std::vector<std::pair<std::string, pbs::Positions>> before_;  // of this frame
    std::vector<DeformerDistance> distances_;
};

}  // namespace experiments
