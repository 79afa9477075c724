#include "experiments/studies/stiffness/stepped_flesh.hpp"

#include "experiments/process/interruption.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <cmath>

namespace experiments {
namespace {

constexpr double still = 1e-6;
constexpr int still_steps = 25;

template <typename Solver>
SteppedFlesh step(Solver& solver, const LoadedFlesh& flesh, double time_step_s, int most_steps)
{
    const pbs::Positions bind_point = flesh.bind_point.rows() ? flesh.bind_point : flesh.mesh.rest;
    SteppedFlesh result;
    double before_m = 0.0;
    for (int quiet = 0; result.steps < most_steps && quiet < still_steps; ++result.steps) {
        stop_if_interrupted();
        solver.advance(flesh.mesh.rest, bind_point, time_step_s);
        const double now_m = mean_displacement_m(flesh, solver.positions() - flesh.mesh.rest);
        if (!std::isfinite(now_m)) break;
        quiet = std::abs(now_m - before_m) <= still * std::abs(now_m) ? quiet + 1 : 0;
        result.converged = quiet == still_steps;
        before_m = now_m;
    }
    result.displacement = solver.positions() - flesh.mesh.rest;
    return result;
}

}  // namespace

SteppedFlesh step_until_still(const LoadedFlesh& flesh, const StiffnessSetting& setting, double gravity_m_s2, int most_steps)
{
    const pbs::Vec3 gravity = gravity_m_s2 * flesh.direction;
    if (is_xpbd(setting.method)) {
        XpbdOptions options = xpbd_options(flesh, setting);
        options.gravity_m_s2 = gravity;
        XpbdSolver solver(flesh.mesh, flesh.bind_distance, flesh.zone, options, flesh.held);
        return step(solver, flesh, setting.time_step_s, most_steps);
    }
    pbs::PbsOptions options = pbs_options(flesh, setting);
    options.gravity_m_s2 = gravity;
    pbs::PbsSolver solver(flesh.mesh, bind_distance_of(flesh), flesh.zone, options, flesh.held);
    return step(solver, flesh, setting.time_step_s, most_steps);
}

}  // namespace experiments
