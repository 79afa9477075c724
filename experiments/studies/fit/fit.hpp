// A bar that is held at one end, with the same tets and the same held vertices for PBS and for the finite elements; and
// Young's modulus of the linear elastic bar that hangs as another body does under the same gravity and density.
//   const Cantilever cantilever = make_cantilever(bar);
//   const YoungFit fit = fit_young(cantilever, elastic_sag(cantilever, options), pbs_displacement, 9.81);
//   fit.young_pa.estimate, fit.misfit_pct
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/studies/shared/bodies.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace experiments {

struct Cantilever {
    LoadedBody body;
    std::vector<int> tip;                  // vertices within a mean edge of the free end
    std::vector<std::vector<int>> fifths;  // free vertices by fifths of the free length, from the held end on
    double mean_edge_m = 0.0;
};
Cantilever make_cantilever(const pbs::TetMesh& bar);

// Linear statics under gravity along -z: displacement [m], #V x 3, for young_pa, density_kg_m3 and 1 m/s^2.
struct ElasticSag {
    pbs::Positions displacement;
    FemOptions options;
};
ElasticSag elastic_sag(const Cantilever& cantilever, FemOptions options);

struct YoungFit {
    // 95 %, leaving out one fifth of the free length at a time: wide where no single modulus bends as the body does.
    analysis::Interval young_pa;
    double misfit_pct = analysis::not_known;  // what is left: rms over the fifths of |u - u_elastic| / |u|
    double rise = analysis::not_known;   // the least share by which the misfit rises if the modulus changes by 10 %;
                                         // infinite for misfit 0
    std::string outcome = "not_finite";  // or converged
    bool identifiable = false;           // the misfit rises by at least 1 %
};

// displacement [m], #V x 3, under gravity_m_s2 along -z with the density of the elastic sag. A displacement that is not
// finite, or against gravity, has no modulus: NaN, and the outcome not_finite.
YoungFit fit_young(const Cantilever& cantilever, const ElasticSag& elastic, const pbs::Positions& displacement,
                   double gravity_m_s2);

// The bars and settings of one run of the study, and its rows.
struct SagCase {
    int vertices = 300;
    std::vector<double> k_stretch = {0.02, 0.05, 0.1, 0.2, 0.5, 0.9, 1.0}, k_volume = {0.0, 1.0};
    std::vector<int> iterations = {6, 24, 96};
};
nlohmann::json to_json(const SagCase& sag_case);

inline constexpr double sag_time_step_s = 0.01, sag_density_kg_m3 = 1000.0, sag_poisson = 0.45;

// The bar and the solver's settings.
struct BarSetting {
    int vertices = 0;
    double mean_edge_m = 0.0, k_stretch = 0.0, k_volume = 0.0;
    int iterations = 0;
    double time_step_s = sag_time_step_s;
    std::string masses = "lumped";
    double density_kg_m3 = sag_density_kg_m3, poisson = sag_poisson;  // of the elastic body
};

struct SagRow {
    BarSetting setting;
    YoungFit fit;
    double scaled_young = 0.0, tip_sag_over_g_dt2 = 0.0;
    bool settled = false;
    double residual = 0.0;
    int solver_steps = 0;
};
extern const analysis::Columns<SagRow> sag_columns;  // sag.csv

}  // namespace experiments
