// A solver and how it is set, of the stiffness study; and the same in the solvers' own options.
//   const StiffnessSetting setting{.method = Method::pbs, .k_stretch = 0.2, .iterations = 24, .time_step_s = 0.01};
#pragma once

#include "experiments/deformers/xpbd/xpbd_solver.hpp"
#include "experiments/studies/shared/loaded_body.hpp"
#include "pbs/solver/options.hpp"

#include <nlohmann/json.hpp>

namespace experiments {

// exponent: k' = 1 - (1 - k)^(1 / iterations). xpbd: multipliers kept over the iterations of a step. xpbd_small_steps: as many substeps of
// one iteration as there are iterations. xpbd_forgetting: multipliers are forgotten in every iteration, so that the control has to fail.
enum class Method { pbs, exponent, xpbd, xpbd_small_steps, xpbd_forgetting };

struct StiffnessSetting {
    Method method = Method::pbs;
    double k_stretch = 0.2;   // in the zone and outside; k_volume = k_bind = 1 (not of xpbd)
    double young_pa = 3.0e4;  // of xpbd
    int iterations = 24;
    double time_step_s = 0.01;
    unsigned long order_seed = 0;  // of a random order within each class; 0: file order
};

const char* name_of(Method method);
nlohmann::json to_json(const StiffnessSetting& setting);
inline bool is_xpbd(Method method)
{
    return method == Method::xpbd || method == Method::xpbd_small_steps || method == Method::xpbd_forgetting;
}

// In double; gravity zero.
pbs::PbsOptions pbs_options(const LoadedBody& body, const StiffnessSetting& setting);
XpbdOptions xpbd_options(const StiffnessSetting& setting);

Eigen::VectorXd bind_distance_of(const LoadedBody& body);  // #V: zero where nothing is bound, as the solver asks for one a vertex

}  // namespace experiments
