#include "pbs/flesh/projective_dynamics.hpp"

#include <cmath>

namespace pbs {

template <typename Scalar>
ProjectiveDynamics<Scalar>::ProjectiveDynamics(const TetMesh& mesh, const ProjectiveEnergy& energy, const CholeskyFactor& factor,
                                               const ProjectiveOptions& options)
    : options_(options),
      system_(make_flesh_system<Scalar>(mesh, energy, factor, options.arithmetic, options.threads)),
      x_(system_->rows()),
      step_(x_)
{
}

template <typename Scalar>
ProjectiveSummary ProjectiveDynamics<Scalar>::minimise(const Positions& centres, Positions& x)
{
    ProjectiveSummary summary;
    system_->set_centres(centres);
    system_->load(x, x_);
    for (; summary.iterations < options_.iterations && !summary.converged; ++summary.iterations) {
        summary.energies.push_back(system_->value_and_gradient(x_, step_));
        system_->precondition(step_);
        system_->add(-1.0, step_, x_);
        summary.steps.push_back(std::sqrt(system_->dot(step_, step_)));
        if (!std::isfinite(summary.steps.back())) break;
        const double smallest = system_->smallest_step(x_, options_.stop_step, summary.steps.front());
        summary.converged = options_.stop_step > 0.0 && summary.steps.back() <= smallest;
    }
    system_->store(x_, x);
    return summary;
}

template class ProjectiveDynamics<float>;
template class ProjectiveDynamics<double>;

}  // namespace pbs
