// The limited memory of L-BFGS: pairs of a step and of the change of the gradient over it (J. Nocedal, S. Wright,
// Numerical Optimization, section 7.2), which improve any symmetric positive definite first matrix.
//   StepHistory<float> history(5);
//   history.remember(system, x, next_x, gradient, next_gradient);
//   history.apply(system, direction, [&](Rows<float>& rows) { system.precondition(rows); });   // g in, H g out
#pragma once

#include "pbs/flesh/flesh_system.hpp"

#include <deque>
#include <utility>
#include <vector>

namespace pbs {

template <typename Scalar>
class StepHistory {
public:
    explicit StepHistory(int longest) : longest_(longest) {}  // pairs that are kept, at least 0

    void clear() { pairs_.clear(); }

    // Keeps the step from x to next_x where its curvature is positive. A full memory loses its oldest pair in any case.
    void remember(const FleshSystem<Scalar>& system, const Rows<Scalar>& x, const Rows<Scalar>& next_x,
                  const Rows<Scalar>& gradient, const Rows<Scalar>& next_gradient)
    {
        if (longest_ == 0) return;
        Pair pair;
        if (static_cast<int>(pairs_.size()) == longest_) {
            pair = std::move(pairs_.front());
            pairs_.pop_front();
        }
        pair.step = next_x;
        pair.change = next_gradient;
        system.add(-1.0, x, pair.step);
        system.add(-1.0, gradient, pair.change);
        pair.product = system.dot(pair.step, pair.change);
        if (pair.product > 0.0) pairs_.push_back(std::move(pair));
    }

    // The two loops of algorithm 7.4. precondition(rows): by the inverse of the first matrix.
    template <typename Precondition>
    void apply(const FleshSystem<Scalar>& system, Rows<Scalar>& direction, const Precondition& precondition) const
    {
        std::vector<double> alpha(pairs_.size());
        for (std::size_t k = pairs_.size(); k-- > 0;) {
            alpha[k] = system.dot(pairs_[k].step, direction) / pairs_[k].product;
            system.add(-alpha[k], pairs_[k].change, direction);
        }
        precondition(direction);
        for (std::size_t k = 0; k < pairs_.size(); ++k) {
            const double beta = system.dot(pairs_[k].change, direction) / pairs_[k].product;
            system.add(alpha[k] - beta, pairs_[k].step, direction);
        }
    }

private:
    struct Pair {
        Rows<Scalar> step, change;  // of x, of the gradient
        double product;             // their inner product, above 0
    };

    int longest_;
    std::deque<Pair> pairs_;
};

}  // namespace pbs
