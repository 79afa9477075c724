// A time step near rest as a linear map of displacements, for the position based solver and for XPBD alike: where flesh comes to rest is
// then a linear system, whatever the damping (linearised/settled_state.hpp says why; here with bind constraints, a jiggling zone and
// multipliers).
//   const RestingFlesh rest = rest_near_rest(flesh, {.method = Method::pbs, .k_stretch = 0.2, .iterations = 24, .time_step_s = 0.01});
//   effective_stiffness_n_m(flesh, rest.displacement, 1.0);
// One projection takes  C = sum g_i . u_i  and does  dlambda = -share (C + alpha / dt^2 lambda) / (sum w |g|^2 + alpha / dt^2),
// u_i += w_i g_i dlambda: of the position based solver share = k, alpha = 0; of XPBD share = 1, alpha its compliance. lambda is that of the
// step; of XPBD that forgets its multipliers, zero in every iteration.
#pragma once

#include "experiments/studies/stiffness/loaded_flesh.hpp"
#include "experiments/studies/stiffness/stiffness_setting.hpp"

#include <array>
#include <vector>

namespace experiments {

class StepNearRest {
public:
    StepNearRest(const LoadedFlesh& flesh, const StiffnessSetting& setting);

    void apply(pbs::Positions& displacement);  // #V x 3, in place; what the iterations of a step, lines (10)-(14), do to it
    double step_s() const { return step_s_; }  // a substep where there are such

private:
    struct Projection {
        int vertices = 0;
        int vertex[4];
        double compliance_per_dt2 = 0.0, share = 1.0, denominator = 0.0;
        pbs::Vec3 gradient[4], moved[4];  // of the constraint at rest; w times it
        double multiplier = 0.0;
    };
    template <typename Constraint>
    void add_near_rest(const LoadedFlesh& flesh, const Constraint& constraint, double share, double compliance,
                       const std::vector<double>& inverse_mass);
    template <typename Constraint, std::size_t count>
    void add(const Constraint& constraint, const std::array<pbs::Vec3, count>& gradients, double share, double compliance,
             const std::vector<double>& inverse_mass);
    void add_pbs(const LoadedFlesh& flesh, const StiffnessSetting& setting);
    void add_xpbd(const LoadedFlesh& flesh, const StiffnessSetting& setting);

    void forget_multipliers();

    int iterations_;
    bool forgets_;
    double step_s_;
    std::vector<Projection> projections_;
};

struct RestingFlesh {
    pbs::Positions displacement;  // [m], #V x 3, under 1 m/s^2
    bool converged = false;
    double residual = 0.0;  // of the linear system, relative
    int steps = 0;          // applications of the map
};
RestingFlesh rest_near_rest(const LoadedFlesh& flesh, const StiffnessSetting& setting);

}  // namespace experiments
