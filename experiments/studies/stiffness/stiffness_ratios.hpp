// How a stiffness changes when one thing is doubled and nothing else: the values of claim C11, and exponents over a
// whole sweep.
//   measurement_table(stiffness_ratios(rows, Varied::iterations)).write("measurements.csv");
#pragma once

#include "analysis/records/tables.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "experiments/settings/option_names.hpp"
#include "experiments/studies/shared/bodies.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "pbs/near_rest/near_rest.hpp"

#include <string>
#include <vector>

namespace experiments {

// A solver with its settings, and where a loaded body comes to rest with it: by the linear map of a step near rest, and
// by the solver itself.
//   const StiffnessSetting setting{.method = Method::pbs, .k_stretch = 0.2, .iterations = 24, .time_step_ms = 10.0};
//   effective_stiffness_n_m(body, rest_near_rest(body, setting).displacement, 1.0);
//   table_of(stiffness_columns, {linear_stiffness(body, setting)}).write("stiffness.csv");

// exponent: k' = 1 - (1 - k)^(1 / iterations). xpbd keeps its multipliers over the iterations of a step.
// xpbd_small_steps takes as many steps of one iteration as there are iterations; LBS puts the body outside the zone
// back in each of them. xpbd_forgetting resets its multipliers in every iteration: a control that has to fail.
enum class Method { pbs, exponent, xpbd, xpbd_small_steps, xpbd_forgetting };
template <>
inline constexpr NameTable<Method, 5> option_names<Method>{{{Method::pbs, "pbs"},
                                                            {Method::exponent, "exponent"},
                                                            {Method::xpbd, "xpbd"},
                                                            {Method::xpbd_small_steps, "xpbd_small_steps"},
                                                            {Method::xpbd_forgetting, "xpbd_forgetting"}}};
inline bool is_xpbd(Method method)
{
    return method != Method::pbs && method != Method::exponent;
}

struct StiffnessSetting {
    Method method = Method::pbs;
    double k_stretch = 0.2;   // of PBS, in the zone and outside of it; its k_volume and k_bind are 1
    double young_pa = 3.0e4;  // of XPBD
    int iterations = paper_iterations;
    double time_step_ms = 10.0;
    int order_seed = 0;  // of a random order within each class; 0: file order

    double time_step_s() const { return 1e-3 * time_step_ms; }
    int iterations_of_a_step() const { return method == Method::xpbd_small_steps ? 1 : iterations; }
    double step_s() const { return time_step_s() / (method == Method::xpbd_small_steps ? iterations : 1); }
};
nlohmann::json to_json(const StiffnessSetting& setting);

// Under 1 m/s^2. The displacement is that after the step, including what the zone carries along outside of it.
pbs::RestingState rest_near_rest(const LoadedBody& body, const StiffnessSetting& setting);

// Takes time steps under the given gravity until the body hangs still. This checks the linear map, and shows the effect
// of large displacements.
struct SteppedBody {
    pbs::Positions displacement;  // [m], #V x 3
    bool converged = false;       // the mean displacement changed by less than 1e-6 of itself for 25 steps
    int steps = 0;
};
SteppedBody step_until_still(const LoadedBody& body, const StiffnessSetting& setting, double gravity_m_s2,
                             int most_steps = 4000);

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

// time_step: halved. resolution: the number of vertices, whose meshes are never exactly twice each other.
enum class Varied { iterations, time_step, resolution };
template <>
inline constexpr NameTable<Varied, 3> option_names<Varied>{
    {{Varied::iterations, "iterations"}, {Varied::time_step, "time_step"}, {Varied::resolution, "resolution"}}};

// The ratio of stiffnesses for one doubling, (K2 / K1)^(log 2 / log(x2 / x1)), from the first to the last of the
// settings next to the paper's (12 to 48 iterations, 20 to 5 ms; all resolutions). low and high are the least and the
// largest ratio of every single doubling there, over file order, random orders and the second series of meshes. Runs
// that did not converge, or whose flesh rises against gravity, are left out. The claim is about a character's jiggling
// zone as the paper's solver runs it; a bar, or a zone whose surroundings are held, is "flesh held".
std::vector<analysis::Measurement> stiffness_ratios(const std::vector<StiffnessRow>& rows, Varied varied);

// exponents.csv: K = c x^exponent over all settings, in file order, by least squares. The fields of the key are
// everything that is not varied; first and last are those of what is varied, time steps in ms; left_out counts settings
// that did not converge or hang upwards.
analysis::CsvTable stiffness_exponents(const std::vector<StiffnessRow>& rows, Varied varied);

// One run of the stiffness study: one body, and one thing that is varied.
struct StiffnessSweep {
    Varied varied = Varied::iterations;
    std::string body;
    std::vector<int> vertices = {0};  // 0: the body's own size
};
nlohmann::json to_json(const StiffnessSweep& sweep);

// Writes stiffness.csv and measurements.csv.
std::string record_stiffness(const StiffnessSweep& sweep, const std::string& folder);

}  // namespace experiments
