// How a character's cost grows with its mesh: processor seconds of each part of a run and its peak memory over the number of constraints,
// and the exponents p of cost = c constraints^p.
#pragma once

#include "analysis/records/csv_table.hpp"
#include "analysis/line_fit.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace experiments {

// One run of LBS and PBS, end to end; times are the processor's, which other work on the machine stretches less.
struct ScaleRow {
    long long vertices = 0, edges = 0, tets = 0;
    int iterations = 0, frames = 0;
    double step_ms = 0.0;  // of PBS, mean over the frames
    double character_s = 0.0, set_up_s = 0.0, ruler_set_up_s = 0.0, records_s = 0.0, total_s = 0.0;
    double ruler_ms = 0.0, write_ms = 0.0;  // a frame and deformer
    double peak_mb = 0.0;                   // 10^6 bytes

    double constraints() const { return static_cast<double>(vertices + edges + tets); }  // bind, stretch, volume
    double ns_a_constraint() const { return 1e6 * step_ms / (constraints() * iterations); }
};

ScaleRow scale_row(const nlohmann::json& run, const analysis::CsvTable& metrics);  // of a run's run.json and metrics.csv

analysis::CsvTable scale_csv(const std::vector<ScaleRow>& rows);

// Of a column of scale_csv over its constraints; at least two rows.
analysis::Interval growth_exponent(const analysis::CsvTable& table, const std::string& column);

std::string scale_markdown(const analysis::CsvTable& table);  // a row a size, and the exponents with their intervals

}  // namespace experiments
