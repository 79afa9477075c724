#include "reference_fem/newton/newton.hpp"

#include "pbs/geometry/cost.hpp"

#include <algorithm>
#include <numeric>

namespace reference_fem {

int LoadPathSummary::newton_steps() const
{
    return std::accumulate(steps.begin(), steps.end(), 0, [](int sum, const LoadStep& step) { return sum + step.newton.steps(); });
}

int LoadPathSummary::halvings() const
{
    return static_cast<int>(std::count_if(steps.begin(), steps.end(), [](const LoadStep& step) { return !step.newton.converged(); }));
}

pbs::WorkCounters LoadPathSummary::work() const
{
    pbs::WorkCounters work;
    for (const LoadStep& step : steps) work += step.newton.work;
    return work;
}

LoadPathSummary follow_load_path(const std::function<NewtonSummary(double fraction)>& attempt, Eigen::VectorXd& displacement,
                                 const LoadPathOptions& options)
{
    const pbs::Stopwatch stopwatch;
    LoadPathSummary path;
    double step = std::min(options.first_step, 1.0);
    int converged_in_a_row = 0;
    const auto has_steps_left = [&] { return options.most_newton_steps == 0 || path.newton_steps() < options.most_newton_steps; };
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
        converged_in_a_row = 0;
        step /= 2.0;
        if (step < options.smallest_step) break;
    }
    path.seconds = stopwatch.seconds();
    return path;
}

}  // namespace reference_fem
