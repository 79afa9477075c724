// How the cost of a character grows with its mesh: processor time of each part of a run and its peak memory, over the number of
// constraints, and the exponents p of cost = c constraints^p.
//   table_of(scale_columns, {scale_row(run, metrics)}).write("scale.csv");
#pragma once

#include "analysis/records/tables.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace experiments {

struct ScaleCase {
    std::vector<int> vertices;  // of the human, one run each
};
nlohmann::json to_json(const ScaleCase& of);

// One run of LBS and PBS from meshing to frames on disk. Times are processor times, which other work on the machine changes less.
struct ScaleRow {
    long long vertices = 0, edges = 0, tets = 0;
    double constraints = 0.0;  // bind, stretch and volume: vertices + edges + tets
    int iterations = 0, frames = 0;
    double step_ms = 0.0;  // of PBS, mean over the frames
    double ns_per_constraint = 0.0;
    double character_s = 0.0, set_up_s = 0.0, metrics_set_up_s = 0.0, records_s = 0.0, total_s = 0.0;
    double metrics_ms = 0.0, write_ms = 0.0;  // per frame and deformer
    double peak_mb = 0.0;                     // 10^6 bytes
};
extern const analysis::Columns<ScaleRow> scale_columns;

ScaleRow scale_row(const nlohmann::json& run, const analysis::CsvTable& metrics);  // from a run's run.json and metrics.csv

std::string scale_markdown(const analysis::CsvTable& table);  // one row per size, and the exponents with their intervals

}  // namespace experiments
