// One effective stiffness, measured and as it is written down.
//   rows.push_back(linear_stiffness(body, {.k_stretch = 0.2, .iterations = 24}));   stiffness_table(rows).write("stiffness.csv");
#pragma once

#include "analysis/records/csv_table.hpp"
#include "experiments/studies/stiffness/stiffness_setting.hpp"

#include <string>
#include <vector>

namespace experiments {

inline constexpr double still_gravity_m_s2 = 9.81;  // that the solver itself is stepped under

struct StiffnessRow {
    std::string body, load;
    int vertices = 0, edges = 0, tets = 0;
    StiffnessSetting setting;
    std::string mesh = "wanted";  // or "wanted, a tenth finer": of a second ladder of sizes
    std::string by = "linear";    // or "stepped": the solver itself, under still_gravity_m_s2
    double force_n = 0.0, stiffness_n_m = 0.0;
    bool converged = false;
    int steps = 0;  // applications of the linear map, or time steps
};

StiffnessRow linear_stiffness(const LoadedBody& body, const StiffnessSetting& setting);
StiffnessRow stepped_stiffness(const LoadedBody& body, const StiffnessSetting& setting);

// Columns: body, load, vertices, edges, tets, mesh, method, k_stretch, young_pa, iterations, time_step_ms, order_seed, by, force_n,
// stiffness_n_m, converged, steps. k_stretch says nothing of xpbd, young_pa nothing of pbs.
analysis::CsvTable stiffness_table(const std::vector<StiffnessRow>& rows);
std::vector<StiffnessRow> stiffness_rows(const analysis::CsvTable& table);

}  // namespace experiments
