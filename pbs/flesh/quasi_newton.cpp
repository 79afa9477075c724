#include "pbs/flesh/quasi_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace pbs {

template <typename Scalar>
QuasiNewton<Scalar>::QuasiNewton(const TetMesh& mesh, const FleshEnergy& energy, const CholeskyFactor& factor,
                                 const QuasiNewtonOptions& options)
    : options_(options),
      system_(make_flesh_system<Scalar>(mesh, energy, factor, options.packed, options.threads)),
      x_(system_->rows()),
      gradient_(x_),
      direction_(x_),
      next_x_(x_),
      next_gradient_(x_),
      history_(options.history)
{
    if (options.contact) contact_.emplace(mesh, energy, system_->place());
}

template <typename Scalar>
QuasiNewtonSummary QuasiNewton<Scalar>::minimise(const Positions& centres, Positions& x)
{
    QuasiNewtonSummary summary;
    history_.clear();
    system_->set_centres(centres);
    system_->load(x, x_);
    int searches_left = contact_ ? 2 : 0;
    if (contact_) contact_->forget();
    summary.energy = value_and_gradient(x_, gradient_);
    summary.evaluations = 1;
    while (summary.iterations < options_.iterations && !summary.converged) {
        if (searches_left > 0 && 2 * summary.iterations >= (2 - searches_left) * options_.iterations) {
            --searches_left;
            seek_contacts(summary);
        }
        const double slope = set_direction();
        ++summary.solves;
        summary.steps.push_back(std::sqrt(system_->dot(direction_, direction_)));
        if (!std::isfinite(slope)) break;
        const double smallest = system_->smallest_step(x_, options_.stop_gradient, summary.steps.front());
        const bool is_below = options_.stop_gradient > 0.0 && summary.steps.back() <= smallest;
        summary.converged = is_below || !search(slope, summary);
        if (!summary.converged) ++summary.iterations;
        if (summary.converged && searches_left > 0) {
            --searches_left;
            summary.converged = !seek_contacts(summary);
        }
    }
    system_->store(x_, x);
    return summary;
}

template <typename Scalar>
double QuasiNewton<Scalar>::value_and_gradient(const Rows<Scalar>& x, Rows<Scalar>& gradient)
{
    const double of_flesh = system_->value_and_gradient(x, gradient);
    return contact_ ? of_flesh + contact_->add_value_and_gradient(x, gradient) : of_flesh;
}

// Contacts are sought at the beginning and after half of the iterations, or at a minimum before. The energy is then
// another one, about which the kept pairs know nothing. False: it is still the same.
template <typename Scalar>
bool QuasiNewton<Scalar>::seek_contacts(QuasiNewtonSummary& summary)
{
    if (!contact_->find(x_)) return false;
    history_.clear();
    summary.energy = value_and_gradient(x_, gradient_);
    ++summary.evaluations;
    return true;
}

// The direction is -H_k g. Returns the slope.
template <typename Scalar>
double QuasiNewton<Scalar>::set_direction()
{
    direction_ = gradient_;
    history_.apply(*system_, direction_, [&](Rows<Scalar>& rows) { system_->precondition(rows); });
    return -system_->dot(direction_, gradient_);
}

// Halves the step until the energy decreases as it should (Armijo) or, where its change is below its rounding, the
// slope at the end of the step fulfils the approximate Wolfe conditions (W. Hager, H. Zhang, SIAM J. Optim. 16, 2005):
// with delta = sufficient and sigma = 1 - 2 delta it lies between sigma * slope and -sigma * slope. False: no step
// does.
template <typename Scalar>
bool QuasiNewton<Scalar>::search(double slope, QuasiNewtonSummary& summary)
{
    constexpr double sufficient = 1e-4, sigma = 1.0 - 2.0 * sufficient;
    constexpr int halvings = 20;
    const double rounding = 16.0 * std::numeric_limits<Scalar>::epsilon() * std::abs(summary.energy);
    double length = 1.0;
    for (int attempt = 0; attempt <= halvings; ++attempt, length /= 2.0) {
        next_x_ = x_;
        system_->add(-length, direction_, next_x_);
        const double energy = value_and_gradient(next_x_, next_gradient_);
        ++summary.evaluations;
        const bool is_lower = energy <= summary.energy + sufficient * length * slope;
        const bool is_equal = std::abs(energy - summary.energy) <= rounding;
        const bool is_flatter =
            is_equal && std::abs(system_->dot(direction_, next_gradient_)) <= sigma * std::abs(slope);
        if (!is_lower && !is_flatter) continue;
        history_.remember(*system_, x_, next_x_, gradient_, next_gradient_);
        std::swap(x_, next_x_);
        std::swap(gradient_, next_gradient_);
        summary.energy = energy;
        return true;
    }
    return false;
}

template class QuasiNewton<float>;
template class QuasiNewton<double>;

}  // namespace pbs
