// What the fit writes down: one row a fitted modulus, swing or Poisson's ratio, and what is told of them together.
#pragma once

#include "analysis/records/csv_table.hpp"
#include "experiments/studies/fit/poisson_fit.hpp"
#include "experiments/studies/fit/release_test.hpp"
#include "experiments/studies/shared/near_rest/step_near_rest.hpp"
#include "experiments/studies/fit/young_fit.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace experiments {

// The cantilever and how the solver was set.
struct FitSetting {
    int vertices = 0;
    double mean_edge_m = 0.0;
    pbs::PbsOptions pbs;
    double time_step_s = 0.0, density_kg_m3 = 0.0, poisson = 0.0;  // the latter two of the elastic body
};

analysis::CsvTable sag_table();
void add_sag(analysis::CsvTable& table, const FitSetting& setting, const RestingState& state, double tip_sag_over_g_dt2,
             const YoungFit& fit);

// The modulus by the first frequency beside the one by the sag.
struct SwingYoung {
    ReleaseTest test;
    double elastic_hz = 0.0;  // of the elastic body of 1 Pa
    double young_pa = 0.0;    // (undamped_hz / elastic_hz)^2
    double young_sag_pa = 0.0;
    double expected_ratio = 0.0;  // of the two, by the recurrence of Algorithm 1
};
analysis::CsvTable swing_table();
void add_swing(analysis::CsvTable& table, const FitSetting& setting, const SwingYoung& swing);

// (frequency of the recurrence x <- s (2 x - x_before) / frequency of the same body at rest under a load)^2 - what the time step does to
// the modulus; static_rad is 2 pi times the latter, times dt.
double frequency_over_sag(double static_rad);

struct PoissonSetting {
    std::string model, formulation, attachment;
    int element_order = 0;
    double k_stretch = 0.0;
    std::string body;         // pbs, pbs_converged
    int iterations = 0;       // most of any pose
    int converged_poses = 0;  // of pbs_converged, those that did
};
analysis::CsvTable poisson_table();        // a row a fit
analysis::CsvTable poisson_poses_table();  // and one a pose of it
analysis::CsvTable valley_table();         // misfit over nu
void add_poisson(analysis::CsvTable& fits, analysis::CsvTable& poses, analysis::CsvTable& valleys, const PoissonSetting& setting,
                 const PoissonFit& fit);

}  // namespace experiments
