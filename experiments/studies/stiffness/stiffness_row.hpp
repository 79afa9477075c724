// One effective stiffness as it is measured and as stiffness.csv records it.
//   rows.push_back(linear_stiffness(body, {.k_stretch = 0.2, .iterations = 24}));
//   table_of(stiffness_columns, rows).write("stiffness.csv");
#pragma once

#include "experiments/studies/stiffness/resting_body.hpp"

#include <string>

namespace experiments {

inline constexpr double still_gravity_m_s2 = 9.81;  // under which the solver itself is stepped

struct StiffnessRow {
    std::string body, load;
    int vertices = 0, edges = 0, tets = 0;
    std::string mesh = "wanted";  // or "wanted, a tenth finer": of a second series of sizes
    StiffnessSetting setting;
    std::string by = "linear";  // or "stepped": the solver itself, under still_gravity_m_s2
    double force_n = 0.0, stiffness_n_m = 0.0;
    bool converged = false;
    int steps = 0;  // applications of the linear map, or time steps
};
extern const analysis::Columns<StiffnessRow> stiffness_columns;

StiffnessRow linear_stiffness(const LoadedBody& body, const StiffnessSetting& setting);
StiffnessRow stepped_stiffness(const LoadedBody& body, const StiffnessSetting& setting);

}  // namespace experiments
