#include "reference_fem/newton/newton.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace reference_fem {
namespace {

constexpr double armijo = 1e-4;  // share of the predicted decrease that a step must bring
constexpr double energy_rounding = 1e-12;
constexpr double truncation = 0.1;  // share of the first residual at which conjugate gradients end
constexpr int most_gradients = 40;
constexpr double blocked_share = 1e-3;  // of a step: where contact allows no more, the step makes no progress
constexpr int most_blocked_in_a_row = 5;

// The last of the iterations is the present state, whose Hessian is not known yet.
bool is_far_from_convex(const NewtonSummary& summary, const NewtonOptions& options)
{
    const auto last = summary.iterations.rbegin() + 1;
    const auto convex =
        std::find_if(last, summary.iterations.rend(), [](const NewtonIteration& it) { return !it.projected; });
    return options.indefinite_in_a_row > 0 && convex - last >= options.indefinite_in_a_row;
}

// Contact allows almost nothing of the steps, one after the other.
bool is_blocked(const NewtonSummary& summary)
{
    const auto& iterations = summary.iterations;
    return static_cast<int>(iterations.size()) > most_blocked_in_a_row &&
           std::all_of(iterations.end() - 1 - most_blocked_in_a_row, iterations.end() - 1,
                       [](const auto& it) { return it.allowed_step < blocked_share; });
}

double largest_step(const Terms& terms, const Eigen::VectorXd& displacement, const Eigen::VectorXd& step)
{
    double largest = 1.0;
    for (const Potential* term : terms) largest = std::min(largest, term->largest_step(displacement, step));
    return largest;
}

bool all_quadratic(const Terms& terms)
{
    return std::all_of(terms.begin(), terms.end(), [](const Potential* term) { return term->is_quadratic(); });
}

}  // namespace

const char* name_of(NewtonOutcome outcome)
{
    constexpr const char* names[] = {
        "converged", "iterations_exhausted", "no_descent", "not_positive_definite", "not_finite",
        "blocked",   "intersects_itself",    "given_up"};
    return names[static_cast<int>(outcome)];
}

int NewtonSummary::steps() const
{
    return static_cast<int>(
        std::count_if(iterations.begin(), iterations.end(), [](const auto& it) { return it.step_length > 0.0; }));
}

// Energy and gradient of all terms at one displacement.
struct NewtonMinimiser::State {
    double energy_j = 0.0, energy_scale_j = 0.0;
    Eigen::VectorXd gradient;  // [N], #dofs
    double residual_n = 0.0, force_scale_n = 0.0;

    bool finite() const { return std::isfinite(energy_j) && std::isfinite(force_scale_n); }
};

NewtonMinimiser::NewtonMinimiser(const SimplexSpace& space, const std::vector<bool>& prescribed, LinearSolver solver)
    : prescribed_(prescribed),
      solver_(solver),
      extent_m_((space.node_positions().colwise().maxCoeff() - space.node_positions().colwise().minCoeff()).norm()),
      tets_(space.tet_nodes().rows()),
      hessian_(space)
{
}

double NewtonMinimiser::energy_at(const Terms& terms, const Eigen::VectorXd& displacement)
{
    work_.tet_visits += tets_;
    double energy = 0.0;
    for (const Potential* term : terms) energy += term->value(displacement);
    return energy;
}

Eigen::VectorXd NewtonMinimiser::solution(const Eigen::VectorXd& force, const Eigen::VectorXd& prescribed_increment)
{
    ++work_.linear_solves;
    return system_->solve(force, prescribed_increment).displacement;
}

NewtonMinimiser::State NewtonMinimiser::state_at(const Terms& terms, const Eigen::VectorXd& displacement)
{
    work_ += {.gradients = 1, .tet_visits = tets_};
    State state;
    state.gradient = Eigen::VectorXd::Zero(displacement.size());
    for (const Potential* term : terms) {
        Eigen::VectorXd gradient = Eigen::VectorXd::Zero(displacement.size());
        const double energy = term->value_and_add_gradient(displacement, gradient);
        state.energy_j += energy;
        state.energy_scale_j += std::abs(energy);
        if (!std::isfinite(energy)) return state;
        state.force_scale_n += gradient.norm();
        state.gradient += gradient;
    }
    state.residual_n = free_norm(state.gradient);
    return state;
}

double NewtonMinimiser::free_norm(const Eigen::VectorXd& force) const
{
    double squared = 0.0;
    for (Eigen::Index i = 0; i < force.size(); ++i)
        if (!prescribed_[i]) squared += force(i) * force(i);
    return std::sqrt(squared);
}

Eigen::VectorXd NewtonMinimiser::increment_to(const Eigen::VectorXd& prescribed_values,
                                              const Eigen::VectorXd& displacement) const
{
    Eigen::VectorXd increment = Eigen::VectorXd::Zero(displacement.size());
    for (Eigen::Index i = 0; i < increment.size(); ++i)
        if (prescribed_[i]) increment(i) = prescribed_values(i) - displacement(i);
    return increment;
}

bool NewtonMinimiser::is_converged(const State& state, const NewtonOptions& options) const
{
    return state.residual_n <= std::max(options.relative_tolerance * state.force_scale_n, rounding_n_);
}

void NewtonMinimiser::assemble(const Terms& terms, const Eigen::VectorXd& displacement, Definiteness definiteness)
{
    work_.tet_visits += tets_;
    std::vector<NodePair> couplings;
    for (const Potential* term : terms) {
        const std::vector<NodePair> own = term->couplings(displacement);
        couplings.insert(couplings.end(), own.begin(), own.end());
    }
    if (hessian_.couple(couplings)) system_.reset();  // its analysis is of the earlier pattern
    hessian_.set_zero();
    for (const Potential* term : terms) term->add_hessian(displacement, definiteness, hessian_);
}

bool NewtonMinimiser::factorise_assembled(NewtonSummary& summary)
{
    if (system_)
        system_->update(hessian_.matrix());
    else
        system_ = std::make_unique<EliminatedSystem>(hessian_.matrix(), prescribed_, solver_);
    ++summary.factorisations;
    ++work_.factorisations;
    rounding_n_ = 4.0 * std::numeric_limits<double>::epsilon() * extent_m_ * hessian_.matrix().diagonal().norm();
    return system_->usable();
}

bool NewtonMinimiser::factorise(const Terms& terms, const Eigen::VectorXd& displacement, NewtonSummary& summary)
{
    if (factor_is_kept_) return true;
    indefinite_ = SparseMatrix();
    assemble(terms, displacement, Definiteness::as_it_is);
    if (!has_negative_curvature_) {
        const bool usable = factorise_assembled(summary);
        factor_is_kept_ = usable && all_quadratic(terms);
        if (usable || all_quadratic(terms)) return usable;
    }
    indefinite_ = hessian_.matrix();
    summary.iterations.back().projected = true;
    assemble(terms, displacement, Definiteness::projected);
    return factorise_assembled(summary);
}

// The last of the iterations is the present state.
bool NewtonMinimiser::may_reuse_factor(const NewtonSummary& summary, const NewtonOptions& options) const
{
    const std::size_t states = summary.iterations.size();
    if (states < 2) return false;
    const NewtonIteration &now = summary.iterations[states - 1], &last = summary.iterations[states - 2];
    return last.step_length == 1.0 && now.residual_n <= options.reuse_contraction * last.residual_n;
}

// The largest of L, L/2, L/4, ... that lowers the energy by Armijo's share; where that is below rounding, that lowers
// the residual. L is the step that the terms allow, at most 1. 0: none.
double NewtonMinimiser::step_length(const Terms& terms, const State& state, const Eigen::VectorXd& displacement,
                                    const Step& step, const NewtonOptions& options)
{
    const double slope = state.gradient.dot(step.direction);
    const double rounding = energy_rounding * state.energy_scale_j;
    double length = step.allowed;
    for (int halving = 0; halving <= options.halvings; ++halving, length /= 2.0) {
        const Eigen::VectorXd trial = displacement + length * step.direction;
        if (length * std::abs(slope) > rounding) {
            if (slope < 0.0 && energy_at(terms, trial) <= state.energy_j + armijo * length * slope) return length;
        } else if (const State at_trial = state_at(terms, trial);
                   at_trial.finite() && at_trial.residual_n < state.residual_n) {
            return length;
        }
    }
    return 0.0;
}

// Conjugate gradients on H p = -g, where H is indefinite, preconditioned by the projected H. Without negative curvature
// they end at a tenth of the first residual or after `most_gradients` products. Any of their iterates is a direction of
// descent.
Eigen::VectorXd NewtonMinimiser::truncated_step(const State& state)
{
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(state.gradient.size());
    const auto preconditioned = [&](const Eigen::VectorXd& residual) { return solution(residual, zero); };
    Eigen::VectorXd step = zero, residual = -state.gradient, direction = preconditioned(residual);
    double product = residual.dot(direction);
    has_negative_curvature_ = false;
    for (int k = 0; k < most_gradients; ++k) {
        const Eigen::VectorXd image = indefinite_.selfadjointView<Eigen::Lower>() * direction;
        const double curvature = direction.dot(image);
        if (!(curvature > 0.0)) {
            has_negative_curvature_ = true;
            return k == 0 ? direction : step;
        }
        step += product / curvature * direction;
        residual -= product / curvature * image;
        if (free_norm(residual) <= truncation * state.residual_n) break;
        const Eigen::VectorXd next = preconditioned(residual);
        const double next_product = residual.dot(next);
        direction = next + next_product / product * direction;
        product = next_product;
    }
    return step;
}

// `system_` must have been factorised. The step that moves the data may raise the energy: contact alone shortens it.
// The step of a quadratic energy ends in its minimum. Length 0: the direction is not finite, or no length lowers the
// energy enough.
NewtonMinimiser::Step NewtonMinimiser::step_from(const Terms& terms, const State& state,
                                                 const Eigen::VectorXd& displacement, const Eigen::VectorXd& increment,
                                                 const NewtonOptions& options)
{
    const bool truncates = indefinite_.size() > 0 && increment.isZero(0.0);
    Step step{truncates ? truncated_step(state) : solution(-state.gradient, increment), 0.0};
    if (!step.direction.allFinite()) return step;
    const bool is_whole = !increment.isZero(0.0) || all_quadratic(terms);
    step.allowed = largest_step(terms, displacement, step.direction);
    if (is_whole)
        step.length = std::min(1.0, step.allowed);
    else
        step.length = step_length(terms, state, displacement, step, options);
    return step;
}

NewtonSummary NewtonMinimiser::minimise(const Terms& terms, const Eigen::VectorXd& prescribed_values,
                                        Eigen::VectorXd& displacement, const NewtonOptions& options)
{
    const pbs::Stopwatch stopwatch;
    NewtonSummary summary;
    const auto end = [&](NewtonOutcome outcome) {
        summary.outcome = outcome;
        summary.seconds = stopwatch.seconds();
        summary.work = work_;
        return summary;
    };
    Eigen::VectorXd increment = increment_to(prescribed_values, displacement);
    has_negative_curvature_ = false;
    work_ = {};
    for (int k = 0; k <= options.iterations; ++k) {
        const State state = state_at(terms, displacement);
        const bool carries_increment = !increment.isZero(0.0);
        summary.iterations.push_back(
            {state.residual_n, state.force_scale_n, state.energy_j, 0.0, false, carries_increment});
        if (!state.finite()) return end(NewtonOutcome::not_finite);
        if (!carries_increment && is_converged(state, options)) return end(NewtonOutcome::converged);
        if (k == options.iterations || is_far_from_convex(summary, options)) break;
        if (is_blocked(summary)) return end(NewtonOutcome::blocked);
        if (options.is_over && options.is_over()) return end(NewtonOutcome::given_up);
        Step step;
        if (may_reuse_factor(summary, options)) step = step_from(terms, state, displacement, increment, options);
        summary.iterations.back().reuses_factor = step.length > 0.0;
        if (step.length == 0.0) {
            if (!factorise(terms, displacement, summary)) return end(NewtonOutcome::not_positive_definite);
            step = step_from(terms, state, displacement, increment, options);
        }
        if (!step.direction.allFinite()) return end(NewtonOutcome::not_finite);
        if (step.length == 0.0) {
            const bool is_minimum = !carries_increment && is_converged(state, options);
            return end(is_minimum ? NewtonOutcome::converged : NewtonOutcome::no_descent);
        }
        displacement += step.length * step.direction;
        summary.iterations.back().step_length = step.length;
        summary.iterations.back().allowed_step = step.allowed;
        if (step.length < 1.0 && carries_increment)
            increment = increment_to(prescribed_values, displacement);
        else
            increment.setZero();
    }
    return end(NewtonOutcome::iterations_exhausted);
}

int LoadPathSummary::newton_steps() const
{
    return std::accumulate(steps.begin(), steps.end(), 0,
                           [](int sum, const LoadStep& step) { return sum + step.newton.steps(); });
}

int LoadPathSummary::halvings() const
{
    return static_cast<int>(
        std::count_if(steps.begin(), steps.end(), [](const LoadStep& step) { return !step.newton.converged(); }));
}

pbs::WorkCounters LoadPathSummary::work() const
{
    pbs::WorkCounters work;
    for (const LoadStep& step : steps) work += step.newton.work;
    return work;
}

LoadPathSummary follow_load_path(const std::function<NewtonSummary(double fraction)>& attempt,
                                 Eigen::VectorXd& displacement, const LoadPathOptions& options)
{
    const pbs::Stopwatch stopwatch;
    LoadPathSummary path;
    double step = std::min(options.first_step, 1.0);
    int converged_in_a_row = 0;
    const auto has_steps_left = [&] {
        return options.most_newton_steps == 0 || path.newton_steps() < options.most_newton_steps;
    };
    while (!path.converged() && has_steps_left()) {
        const Eigen::VectorXd last_converged = displacement;
        const double fraction = path.reached + step >= 1.0 - 1e-12 ? 1.0 : path.reached + step;
        path.steps.push_back({fraction, attempt(fraction)});
        if (path.steps.back().newton.converged()) {
            path.reached = fraction;
            if (++converged_in_a_row == 2) {
                step *= 2.0;
                converged_in_a_row = 0;
            }
            continue;
        }
        displacement = last_converged;
        if (path.steps.back().newton.outcome == NewtonOutcome::given_up) break;
        converged_in_a_row = 0;
        step /= 2.0;
        if (step < options.smallest_step) break;
    }
    path.seconds = stopwatch.seconds();
    return path;
}

}  // namespace reference_fem
