// Newton's method for the displacements that minimise a sum of potentials, some degrees of freedom prescribed.
//   NewtonMinimiser newton(space, prescribed, LinearSolver::cholmod);
//   const NewtonSummary summary = newton.minimise({&flesh, &springs}, prescribed_values, displacement, {});
// The increment of the prescribed data goes into the first linear solve. Where the Hessian is not positive definite,
// the step is that of truncated conjugate gradients (T. Steihaug, SIAM Journal on Numerical Analysis 20, 1983):
// preconditioned by the factor of the Hessian projected tet by tet, they end where they meet a direction of negative
// curvature. A step that does not lower the energy enough (Armijo) is halved; with contact, the first trial is the
// longest step in which nothing meets. Every iteration is recorded, and a step that does not converge is an outcome.
// The symbolic analysis is kept; so is the factor where every term is quadratic, and on request where the last step
// with it was good enough (V. E. Shamanskii, Ukrainian Mathematical Journal 19, 1967).
#pragma once

#include "pbs/geometry/cost.hpp"
#include "reference_fem/linear_solvers.hpp"
#include "reference_fem/potentials/potentials.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace reference_fem {

// When a minimisation ends.
struct NewtonOptions {
    // Converged where |free residual| <= relative_tolerance * sum over the terms of |gradient|, reactions included, or
    // below what the rounding of positions makes of forces.
    double relative_tolerance = 1e-8;
    int iterations = 40;  // linear solves at most
    // iterations_exhausted after so many Hessians in a row that are not positive definite: the energy still falls far
    // from any minimum. 0: no limit.
    int indefinite_in_a_row = 0;
    int halvings = 25;  // of one step; then no_descent
    // The factor serves again after a whole step that reduced the residual to at most this share of the one before; 0:
    // for no second step. Steps then converge linearly, at least at this rate, and cost a small part of a factorisation
    // where the body has many nodes.
    double reuse_contraction = 0.0;
    // asked before each linear solve: true ends the minimisation there; empty: never
    std::function<bool()> is_over = {};
};

// A state and the step that left it; the last has none.
struct NewtonIteration {
    double residual_n = 0.0;     // norm of the free part of the gradient, before the step
    double force_scale_n = 0.0;  // what it is measured against
    double energy_j = 0.0;       // before the step
    double step_length = 0.0;    // 1: a full Newton step; 0: none was taken
    bool projected =
        false;  // the Hessian was not positive definite, or a direction of negative curvature was met just before
    bool carries_increment = false;  // the linear solve that moves the prescribed data
    bool reuses_factor = false;      // of an earlier step, see NewtonOptions::reuse_contraction
    double allowed_step = 1.0;       // the length that contact allows
};

// no_descent: no length of the step lowers the energy enough; not_positive_definite: not even the projected Hessian can
// be factored; not_finite: an energy, a gradient or a step is not; blocked: contact allows almost nothing of five steps
// in a row; intersects_itself: the initial guess does, with contact, and no step was tried; given_up:
// NewtonOptions::is_over.
enum class NewtonOutcome {
    converged,
    iterations_exhausted,
    no_descent,
    not_positive_definite,
    not_finite,
    blocked,
    intersects_itself,
    given_up
};
const char* name_of(NewtonOutcome outcome);  // as it is spelt in the enum

// Breakdown is an outcome: nothing is thrown.
struct NewtonSummary {
    NewtonOutcome outcome = NewtonOutcome::iterations_exhausted;  // why it ended
    std::vector<NewtonIteration> iterations;                      // one per state, that of the initial guess first
    int factorisations = 0;                                       // numerical ones; 0 if a kept factor was used
    pbs::WorkCounters work;                                       // each energy, gradient and Hessian visits every tet
    double seconds = 0.0;                                         // wall time

    bool converged() const { return outcome == NewtonOutcome::converged; }  // only then the displacement is a minimum
    int steps() const;                                                      // that were taken
};

using Terms = std::vector<const Potential*>;  // of the sum; not owned

// For one mesh and set of prescribed degrees of freedom; keeps nothing of the space. Call forget_factor() after a
// change of the terms.
class NewtonMinimiser {
public:
    // prescribed: #dofs.
    NewtonMinimiser(const SimplexSpace& space, const std::vector<bool>& prescribed, LinearSolver solver);

    // prescribed_values [m], #dofs, is read at prescribed degrees of freedom only. displacement [m], #dofs: holds the
    // initial guess before the call and the minimum after it. If the outcome is not converged, it holds the last
    // iterate.
    NewtonSummary minimise(const Terms& terms, const Eigen::VectorXd& prescribed_values, Eigen::VectorXd& displacement,
                           const NewtonOptions& options);

    // The terms' Hessian has changed (another time step): a factor kept of quadratic terms is stale.
    void forget_factor() { factor_is_kept_ = false; }

    // null before the first solve
    const PreparedSolver* factor() const { return system_ ? &system_->factor() : nullptr; }

private:
    struct State;
    struct Step {
        Eigen::VectorXd direction;
        double length = 0.0, allowed = 1.0;
    };
    double energy_at(const Terms& terms, const Eigen::VectorXd& displacement);
    State state_at(const Terms& terms, const Eigen::VectorXd& displacement);
    Eigen::VectorXd solution(const Eigen::VectorXd& force, const Eigen::VectorXd& prescribed_increment);
    Eigen::VectorXd increment_to(const Eigen::VectorXd& prescribed_values, const Eigen::VectorXd& displacement) const;
    bool is_converged(const State& state, const NewtonOptions& options) const;
    bool may_reuse_factor(const NewtonSummary& summary, const NewtonOptions& options) const;
    bool factorise(const Terms& terms, const Eigen::VectorXd& displacement, NewtonSummary& summary);
    void assemble(const Terms& terms, const Eigen::VectorXd& displacement, Definiteness definiteness);
    bool factorise_assembled(NewtonSummary& summary);
    Eigen::VectorXd truncated_step(const State& state);
    double free_norm(const Eigen::VectorXd& force) const;  // without the prescribed degrees of freedom
    Step step_from(const Terms& terms, const State& state, const Eigen::VectorXd& displacement,
                   const Eigen::VectorXd& increment, const NewtonOptions& options);
    double step_length(const Terms& terms, const State& state, const Eigen::VectorXd& displacement, const Step& step,
                       const NewtonOptions& options);

    std::vector<bool> prescribed_;
    LinearSolver solver_;
    double extent_m_;                  // diagonal of the bounding box
    std::int64_t tets_;
    pbs::WorkCounters work_;  // of this minimisation
    NodalMatrix hessian_;
    std::unique_ptr<EliminatedSystem> system_;
    SparseMatrix indefinite_;  // the Hessian where the factor is that of the projected one; else empty
    bool has_negative_curvature_ =
        false;  // the last truncated step ended there: the next Hessian is projected without a trial
    bool factor_is_kept_ = false;
    double rounding_n_ = 0.0;  // residual that the rounding of positions alone makes
};

// Follows data from where they are (fraction 0) to where they shall be (fraction 1) in steps that are halved where a
// step does not converge and doubled again after two that do. An attempt that is given up ends the path.
//   follow_load_path([&](double fraction) { set_targets(fraction); return newton.minimise(...); }, displacement, {});
// By default the path tries the whole way first, and steps down to 1/64 of it where that fails.
struct LoadPathOptions {
    double first_step = 1.0;            // of the fraction; above 1: 1
    double smallest_step = 1.0 / 64.0;  // no halving below
    int most_newton_steps = 0;          // the path ends after this many steps; 0: no limit
};

// One attempt, converged or not.
struct LoadStep {
    double fraction = 0.0;  // where the step ends, or would have
    NewtonSummary newton;   // why it ended, and each iteration
};

// Every attempt; not reaching the end is an outcome.
struct LoadPathSummary {
    double reached = 0.0;         // the fraction of the last converged step
    std::vector<LoadStep> steps;  // in the order they were tried, failed ones too
    double seconds = 0.0;         // wall time of all attempts

    bool converged() const { return reached >= 1.0; }  // the end was reached
    int newton_steps() const;                          // linear solves, of failed steps too
    int halvings() const;                              // attempts that did not converge
    pbs::WorkCounters work() const;                    // of all attempts
};

// `attempt` moves `displacement` to the state at a fraction. After a failure the displacement is put back to the last
// converged state, where it also stays if the path ends early.
LoadPathSummary follow_load_path(const std::function<NewtonSummary(double fraction)>& attempt,
                                 Eigen::VectorXd& displacement, const LoadPathOptions& options);

}  // namespace reference_fem
