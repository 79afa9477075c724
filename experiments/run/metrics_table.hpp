// metrics.csv has one row per frame and deformer. `pbskin list metrics` and `pbskin explain COLUMN` print the meanings
// and units that are declared with the columns.
//   const auto columns = metric_columns_of(scene);
//   table_of(columns, {metric_row(scene, spec, frame, time_s, measured, step)}).write("metrics.csv");
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "pbs/solver/step_summary.hpp"

namespace experiments {

struct MetricRow {
    // These are facts of the scene and the deformer, the same in all frames.
    std::string scene, deformer, variant, order = {}, precision = {};
    std::optional<int> iterations = {};
    int threads = 1;

    int frame = 0;
    double time_s = 0.0;
    FrameMeasurement measured = {};
    double step_ms = 0.0;
    std::optional<bool> error_below_reference_error = {};
    std::optional<double> fictitious_strain = {};
    std::string outcome = {};
    double sleeping_share = 0.0;
    int wakings = 0;
};

MetricRow metric_row(const Scene& scene, const DeformerSpec& spec, int frame, double time_s,
                     const FrameMeasurement& measured, const pbs::StepSummary& step);

const analysis::Columns<analysis::FrameMetrics>& frame_metric_columns();  // what needs only the positions of a frame
const analysis::Columns<analysis::SkinError>& skin_error_columns();       // skin_rms_mm, ...
// The columns of metrics.csv, without the groups that the scene does not ask for.
analysis::Columns<MetricRow> metric_columns_of(const Scene& scene);

// The text of `pbskin explain` about a metric.
struct MetricText {
    std::string name, unit, formula, meaning, source, cost;
    std::vector<std::string> symbols;  // of the formula, each as "name: meaning"
    bool is_of_measure_alone = false;  // otherwise a column of metrics.csv
};
const std::vector<MetricText>& metric_texts();
const MetricText* find_metric(const std::string& name);  // null: no metric has this name

}  // namespace experiments
