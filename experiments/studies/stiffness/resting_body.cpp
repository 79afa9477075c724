#include "experiments/studies/stiffness/resting_body.hpp"

#include "experiments/process/interruption.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace experiments {
namespace {

constexpr double still = 1e-6;
constexpr int still_steps = 25;

template <typename Solver>
SteppedBody step(Solver& solver, const LoadedBody& body, double time_step_s, int most_steps)
{
    const pbs::Positions bind_point = body.bind_point.rows() ? body.bind_point : body.mesh.rest;
    SteppedBody result;
    double before_m = 0.0;
    for (int quiet = 0; result.steps < most_steps && quiet < still_steps; ++result.steps) {
        stop_if_interrupted();
        solver.advance(body.mesh.rest, bind_point, time_step_s);
        const double now_m = mean_displacement_m(body, solver.positions() - body.mesh.rest);
        if (!std::isfinite(now_m)) break;
        quiet = std::abs(now_m - before_m) <= still * std::abs(now_m) ? quiet + 1 : 0;
        result.converged = quiet == still_steps;
        before_m = now_m;
    }
    result.displacement = solver.positions() - body.mesh.rest;
    return result;
}

template <typename Constraint>
void shuffle_if(unsigned long seed, std::vector<Constraint>& constraints)
{
    std::mt19937_64 random(seed);
    if (seed != 0) std::shuffle(constraints.begin(), constraints.end(), random);
}

void add_pbs(const LoadedBody& body, const StiffnessSetting& setting, StepNearRest& step)
{
    auto set = pbs::make_constraint_set<double>(body.mesh, bind_distance_of(body), body.zone, pbs_options(body, setting), body.held);
    const auto add_class = [&](auto& constraints) {
        shuffle_if(setting.order_seed, constraints);
        for (const auto& constraint : constraints) step.add(constraint, constraint.stiffness, 0.0, set.inverse_mass);
    };
    add_class(set.bind), add_class(set.stretch), add_class(set.volume);
}

void add_xpbd(const LoadedBody& body, const StiffnessSetting& setting, StepNearRest& step)
{
    const XpbdSolver solver(body.mesh, body.bind_distance, body.zone, xpbd_options(setting), body.held);
    const auto add_class = [&](auto constraints) {
        shuffle_if(setting.order_seed, constraints);
        for (const auto& [constraint, compliance, multiplier] : constraints)
            step.add(constraint, 1.0, compliance, solver.inverse_masses_1_kg());
    };
    add_class(solver.bind()), add_class(solver.stretch()), add_class(solver.volume());
}

}  // namespace

RestingState rest_near_rest(const LoadedBody& body, const StiffnessSetting& setting)
{
    const bool small_steps = setting.method == Method::xpbd_small_steps;
    const double step_s = small_steps ? setting.time_step_s / setting.iterations : setting.time_step_s;
    StepNearRest step(body.mesh.rest, body.bind_point, small_steps ? 1 : setting.iterations, step_s,
                      setting.method == Method::xpbd_forgetting);
    if (is_xpbd(setting.method))
        add_xpbd(body, setting, step);
    else
        add_pbs(body, setting, step);
    RestingState rest = rest_of(step, body.zone, body.direction);
    for (std::size_t v = 0; v < body.zone.size(); ++v)
        if (body.zone[v]) rest.displacement.row(static_cast<Eigen::Index>(v)) += step_s * step_s * body.direction.transpose();
    step.apply(rest.displacement);
    ++rest.steps;
    return rest;
}

SteppedBody step_until_still(const LoadedBody& body, const StiffnessSetting& setting, double gravity_m_s2, int most_steps)
{
    const pbs::Vec3 gravity = gravity_m_s2 * body.direction;
    if (is_xpbd(setting.method)) {
        XpbdOptions options = xpbd_options(setting);
        options.gravity_m_s2 = gravity;
        XpbdSolver solver(body.mesh, body.bind_distance, body.zone, options, body.held);
        return step(solver, body, setting.time_step_s, most_steps);
    }
    pbs::PbsOptions options = pbs_options(body, setting);
    options.gravity_m_s2 = gravity;
    pbs::PbsSolver solver(body.mesh, bind_distance_of(body), body.zone, options, body.held);
    return step(solver, body, setting.time_step_s, most_steps);
}

}  // namespace experiments
