// Order statistics over the frames of a table of metrics. One row per deformer and setting:
//   scene, deformer, variant, order, precision, iterations, frames
//   volume_change_least_pct, _p10_pct, _median_pct, _p90_pct, _most_pct   likewise volume_abs_change, error_l2, error_joint
// A statistic leaves out frames that lack its quantity. If all do, its cells are empty.
//   frame_statistics(metrics).write("frame_statistics.csv");
#pragma once

#include "analysis/records/csv_table.hpp"

namespace analysis {

// metrics: the table metrics.csv.
CsvTable frame_statistics(const CsvTable& metrics);

}  // namespace analysis
