// The runs of the fit on a bar that is held at one end: Young's modulus by its sag and by its first frequency, as recorded in sag.csv and
// swing.csv.
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/statistics/minimise.hpp"
#include "experiments/studies/fit/release_test.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace experiments {

struct SagCase {
    int vertices = 300;
    std::vector<double> k_stretch = {0.02, 0.05, 0.1, 0.2, 0.5, 0.9, 1.0}, k_volume = {0.0, 1.0};
    std::vector<int> iterations = {6, 24, 96};
};
struct SwingCase {
    int vertices = 300;
    std::vector<double> k_stretch = {0.05, 0.2, 0.9};
    std::vector<int> iterations = {24, 96};
    std::vector<double> time_steps_s = {0.01, 0.005};
};
nlohmann::json to_json(const SagCase& of);
nlohmann::json to_json(const SwingCase& of);

// The bar and the solver's settings.
struct BarSetting {
    int vertices = 0;
    double mean_edge_m = 0.0, k_stretch = 0.0, k_volume = 0.0;
    int iterations = 0;
    double time_step_s = 0.0;
    std::string masses = "lumped";
    double density_kg_m3 = 0.0, poisson = 0.0;  // of the elastic body
};

// How well a minimum is known.
struct FitQuality {
    double misfit_pct = 0.0, rise = 0.0;
    std::string outcome;
    bool identifiable = false;
};
FitQuality quality_of(const analysis::Minimum& minimum);
const analysis::Columns<FitQuality>& quality_columns();

struct SagRow {
    BarSetting setting;
    double young_pa = 0.0, young_low_pa = 0.0, young_high_pa = 0.0;
    FitQuality quality;
    double scaled_young = 0.0, tip_sag_over_g_dt2 = 0.0;
    bool settled = false;
    double residual = 0.0;
    int solver_steps = 0;
};
extern const analysis::Columns<SagRow> sag_columns;

struct SwingRow {
    BarSetting setting;
    ReleaseTest test = {};
    double young_pa = 0.0, young_sag_pa = 0.0, young_over_sag = 0.0, expected_over_sag = 0.0;
};
extern const analysis::Columns<SwingRow> swing_columns;

// (frequency of the recurrence x <- s (2 x - x_before) / frequency of the same body at rest under a load)^2, which is what the time step
// does to the modulus; static_rad is 2 pi times the latter, times dt.
double frequency_over_sag(double static_rad);

std::string record_sags(const SagCase& of, const std::string& folder);
std::string record_swings(const SwingCase& of, const std::string& folder);

}  // namespace experiments
