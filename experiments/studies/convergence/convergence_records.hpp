// The records of convergence: residuals by iteration, one row of numbers per path, the error to the reference by iteration.
#pragma once

#include "analysis/records/typed_table.hpp"
#include "experiments/studies/convergence/convergence_case.hpp"

namespace experiments {

// What a row is of.
struct PathCase {
    std::string body, pose;
    int vertices = 0, tets = 0;
    bool own_mesh = true;
    std::string order, precision;
    double k_stretch = 0.0;
    std::string start;
};
// rates.csv
struct RateRow {
    PathCase of;
    int iterations = 0;
    std::string outcome;
    double floor = 0.0, start_residual = 0.0, residual_24 = 0.0, last_residual = 0.0, last_half_change_pct = 0.0;
    Rate rate;
    Reached residual, volume;
    double iteration_cpu_ms = 0.0;
    std::optional<double> cpu_ms_to_residual, cpu_ms_to_volume;
    Look first, paper, nearest, last;  // at the initial state, after 24 iterations, of the least error, and the last one
    std::string reference;
    bool reference_self_intersects = false;
    double limit_from_lbs_pct = 0.0;
};
extern const analysis::Columns<RateRow> rate_columns;

analysis::CsvTable residual_table(const ConvergenceResult& result);  // residuals.csv, thinned to five looks per decade
std::vector<RateRow> rate_rows(const ConvergenceResult& result);     // one per path
analysis::CsvTable towards_table(const ConvergenceResult& result);   // towards.csv, thinned likewise

}  // namespace experiments
