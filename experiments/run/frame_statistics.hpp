// frame_statistics.csv: order statistics over the frames of a run, of what figures show of them. One row a deformer and setting:
//   scene, deformer, variant, order, precision, iterations, frames
//   volume_change_least_pct, _p10_pct, _median_pct, _p90_pct, _most_pct   and so volume_abs_change, error_l2, error_joint
// Frames without the quantity are left out of it; without any its cells are empty.
//   frame_statistics(metrics).write("frame_statistics.csv");
#pragma once

#include "analysis/records/csv_table.hpp"

namespace experiments {

// metrics: as metrics.csv has them.
analysis::CsvTable frame_statistics(const analysis::CsvTable& metrics);

}  // namespace experiments
