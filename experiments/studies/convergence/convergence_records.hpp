// The records of convergence: residuals by iteration, one row per path, and the error to the reference by iteration.
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "experiments/studies/convergence/convergence_case.hpp"

namespace experiments {

// The path that a row belongs to.
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
    double floor = 0.0, last_half_change_pct = 0.0;
    Rate rate;
    Reached residual, volume;
    double iteration_cpu_ms = 0.0;
    std::optional<double> cpu_ms_to_residual, cpu_ms_to_volume;
    Look first, paper, nearest, last;  // the initial guess, after 24 iterations, with the least error, and the last one
    std::string reference;
    ReferenceQuality quality;
    double limit_from_lbs_pct = 0.0;
};
extern const analysis::Columns<RateRow> rate_columns;

// residuals.csv and towards.csv: a look of a path.
struct LookRow {
    PathCase of;
    Look look;
};
extern const analysis::Columns<LookRow> residual_columns, towards_columns;

std::vector<LookRow> look_rows(const ConvergenceResult& result);  // thinned to five looks per decade
std::vector<LookRow> towards_rows(std::vector<LookRow> looks);    // those with an error
std::vector<RateRow> rate_rows(const ConvergenceResult& result);  // one per path

// The values by which C03 and C12 are judged, from the paths of a case. The default setting on the scene's own mesh gives the value, and
// the other orders, precisions and meshes of about that size give its interval. Where a tolerance is never reached, the number of
// iterations that were tried takes its place and `limit` marks it, so that a ratio is a bound. Where neither initial guess reaches the
// tolerance there is no value; where this happens in another order or on another mesh, the interval is open. The share of such cases is a
// value of its own. Only characters are judged. The limb is measured for comparison, as are twists, in which the rest pose already
// satisfies all constraints.
std::vector<analysis::Measurement> convergence_values(const ConvergenceResult& result);

}  // namespace experiments
