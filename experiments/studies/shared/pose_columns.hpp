// Columns that the tables of several studies share.
//   const Columns<Row> columns = within(&Row::of, pose_columns()) + within(&Row::metrics, volume_columns()) + ...;
// They are functions, since columns of other files are made from them before main() begins.
#pragma once

#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"

namespace experiments {

const analysis::Columns<analysis::CaseKey>& pose_columns();         // body, motion, pose, angle_deg
const analysis::Columns<analysis::FrameMetrics>& volume_columns();  // volume_change_pct, volume_abs_change_pct, inverted

}  // namespace experiments
