// Follows data from where they are (fraction 0) to where they shall be (fraction 1) in steps that are halved where a step does not
// converge and doubled again after two that do.
//   follow_load_path([&](double fraction) { set_targets(fraction); return newton.minimise(...); }, displacement, {});
#pragma once

#include "reference_fem/newton/newton.hpp"

#include <functional>

namespace reference_fem {

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

// `attempt` moves `displacement` to the state at a fraction. After a failure the displacement is put back to the last converged state,
// where it also stays if the path ends early.
LoadPathSummary follow_load_path(const std::function<NewtonSummary(double fraction)>& attempt, Eigen::VectorXd& displacement,
                                 const LoadPathOptions& options);

}  // namespace reference_fem
