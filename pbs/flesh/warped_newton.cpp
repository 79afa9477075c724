#include "pbs/flesh/warped_newton.hpp"

#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace pbs {
namespace {

WarpedNewtonOptions checked_options(const WarpedNewtonOptions& options)
{
    if (!(options.omega > 0.0 && options.omega < 2.0))
        throw InputError("warped Newton", 0, "omega", std::to_string(options.omega), "expected 0 < omega < 2");
    return options;
}

}  // namespace

template <typename Scalar>
WarpedNewton<Scalar>::WarpedNewton(const TetMesh& mesh, const FleshEnergy& energy, const CholeskyFactor& factor,
                                   const WarpedNewtonOptions& options)
    : options_(checked_options(options)),
      system_(make_flesh_system<Scalar>(mesh, energy, factor, options.packed, options.threads)),
      sweep_(make_vertex_sweep<Scalar>(mesh, energy, options.packed, options.threads)),
      solve_(mesh, energy, factor.order, system_->place(), options.packed),
      history_(options.history),
      x_(system_->rows()),
      gradient_(x_),
      direction_(x_),
      next_x_(x_),
      next_gradient_(x_),
      swept_(sweep_->rows())
{
}

template <typename Scalar>
WarpedNewtonSummary WarpedNewton<Scalar>::minimise(const Positions& centres,
                                                   const std::vector<Eigen::Matrix3d>& rotations, Positions& x)
{
    WarpedNewtonSummary summary;
    if (options_.iterations == 0) return summary;
    history_.clear();
    system_->set_centres(centres);
    sweep_->set_centres(centres);
    solve_.set_rotations(rotations);
    system_->load(x, x_);
    sweep(x_, summary);
    summary.energies.push_back(system_->value_and_gradient(x_, gradient_));
    summary.evaluations = 1;
    double length = 1.0;
    for (; summary.iterations < options_.iterations; ++summary.iterations) {
        direction_ = gradient_;
        history_.apply(*system_, direction_, [&](Rows<Scalar>& rows) { solve_.apply(rows); });
        next_x_ = x_;
        system_->add(-length, direction_, next_x_);
        sweep(next_x_, summary);
        const double energy = system_->value_and_gradient(next_x_, next_gradient_);
        ++summary.evaluations;
        const double before = summary.energies.back();
        const double rounding = 16.0 * std::numeric_limits<Scalar>::epsilon() * std::abs(before);
        const bool is_lower = energy < before - rounding;
        if (!is_lower && !(std::abs(energy - before) <= rounding && is_flatter())) {
            ++summary.taken_back;
            length /= 4.0;
            continue;
        }
        // A change of the gradient over a step that changes the energy by its rounding is rounding itself.
        if (is_lower) history_.remember(*system_, x_, next_x_, gradient_, next_gradient_);
        std::swap(x_, next_x_);
        std::swap(gradient_, next_gradient_);
        summary.energies.push_back(energy);
        length = std::min(1.0, 2.0 * length);
    }
    system_->store(x_, x);
    return summary;
}

// The slope along the step has not increased: this decides where the change of the energy is below its rounding.
template <typename Scalar>
bool WarpedNewton<Scalar>::is_flatter() const
{
    return std::abs(system_->dot(direction_, next_gradient_)) <= std::abs(system_->dot(direction_, gradient_));
}

// The two systems have the same origin, since it depends on the centres alone, but the rows of the vertices in
// different places.
template <typename Scalar>
void WarpedNewton<Scalar>::sweep(Rows<Scalar>& x, WarpedNewtonSummary& summary)
{
    const std::vector<int>&from = system_->place(), &to = sweep_->place();
    for (std::size_t i = 0; i < from.size(); ++i) std::copy_n(x[from[i]], 3, swept_[to[i]]);
    for (int k = 0; k < options_.sweeps; ++k) sweep_->move(options_.omega, swept_);
    for (std::size_t i = 0; i < from.size(); ++i) std::copy_n(swept_[to[i]], 3, x[from[i]]);
    summary.sweeps += options_.sweeps;
}

template class WarpedNewton<float>;
template class WarpedNewton<double>;

}  // namespace pbs
