// A solver with its settings, and where a loaded body comes to rest with it: by the linear map of a step near rest, and by the solver
// itself.
//   const StiffnessSetting setting{.method = Method::pbs, .k_stretch = 0.2, .iterations = 24, .time_step_ms = 10.0};
//   effective_stiffness_n_m(body, rest_near_rest(body, setting).displacement, 1.0);
//   table_of(stiffness_columns, {linear_stiffness(body, setting)}).write("stiffness.csv");
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/settings/option_names.hpp"
#include "experiments/studies/shared/loaded_body.hpp"
#include "pbs/near_rest/near_rest.hpp"

#include <string>

namespace experiments {

// exponent: k' = 1 - (1 - k)^(1 / iterations). xpbd keeps its multipliers over the iterations of a step. xpbd_small_steps takes as many
// substeps of one iteration as there are iterations. xpbd_forgetting resets its multipliers in every iteration: a control that has to fail.
enum class Method { pbs, exponent, xpbd, xpbd_small_steps, xpbd_forgetting };
template <>
struct OptionNames<Method> {
    static constexpr std::array<std::pair<Method, const char*>, 5> table{{{Method::pbs, "pbs"},
                                                                          {Method::exponent, "exponent"},
                                                                          {Method::xpbd, "xpbd"},
                                                                          {Method::xpbd_small_steps, "xpbd_small_steps"},
                                                                          {Method::xpbd_forgetting, "xpbd_forgetting"}}};
};
inline bool is_xpbd(Method method)
{
    return method != Method::pbs && method != Method::exponent;
}

struct StiffnessSetting {
    Method method = Method::pbs;
    double k_stretch = 0.2;   // of PBS, in the zone and outside of it; its k_volume and k_bind are 1
    double young_pa = 3.0e4;  // of XPBD
    int iterations = 24;
    double time_step_ms = 10.0;
    int order_seed = 0;  // of a random order within each class; 0: file order

    double time_step_s() const { return 1e-3 * time_step_ms; }
};
nlohmann::json to_json(const StiffnessSetting& setting);

// Under 1 m/s^2. The displacement is that after the step, including what the zone carries along outside of it.
pbs::RestingState rest_near_rest(const LoadedBody& body, const StiffnessSetting& setting);

// Takes time steps under the given gravity until the body hangs still. This checks the linear map, and shows the effect of large
// displacements.
struct SteppedBody {
    pbs::Positions displacement;  // [m], #V x 3
    bool converged = false;       // the mean displacement changed by less than 1e-6 of itself for 25 steps
    int steps = 0;
};
SteppedBody step_until_still(const LoadedBody& body, const StiffnessSetting& setting, double gravity_m_s2, int most_steps = 4000);

inline constexpr double still_gravity_m_s2 = 9.81;  // under which the solver itself is stepped

// One effective stiffness as stiffness.csv records it.
struct StiffnessRow {
    std::string body, load;
    int vertices = 0, edges = 0, tets = 0;
    std::string mesh = "wanted";  // or tenth_finer: of a second series of sizes
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

template <>
struct analysis::EnumNames<experiments::Method> : experiments::OptionNames<experiments::Method> {
};
