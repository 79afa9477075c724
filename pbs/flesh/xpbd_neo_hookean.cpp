#include "pbs/flesh/xpbd_neo_hookean.hpp"

#include "pbs/flesh/flesh_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pbs {

template <typename Scalar>
XpbdNeoHookean<Scalar>::XpbdNeoHookean(const TetMesh& mesh, const XpbdFlesh& flesh, const XpbdNeoHookeanOptions& options)
    : options_(options),
      system_(make_xpbd_system<Scalar>(mesh, flesh, options.arithmetic, options.threads)),
      x_(system_->rows()),
      before_(x_),
      predicted_(x_)
{
}

template <typename Scalar>
XpbdNeoHookeanSummary XpbdNeoHookean<Scalar>::minimise(const Positions& targets, Positions& x)
{
    const bool keeps = options_.multipliers == XpbdMultipliers::kept;
    XpbdNeoHookeanSummary summary;
    system_->set_targets(targets);
    system_->load(x, x_);
    system_->forget();
    before_ = x_;
    applied_ = Rows<Scalar>(x_.size());
    nesterov_ = 1.0;
    while (summary.iterations < options_.iterations) {
        begin_step(Scalar(momentum()), x_.size(), x_.data(), before_.data(), predicted_.data(), applied_.data());
        const int last = std::min(options_.iterations, summary.iterations + options_.iterations_per_step);
        if (!keeps) system_->forget();
        for (; summary.iterations < last; ++summary.iterations) {
            if (options_.multipliers == XpbdMultipliers::reset) system_->forget();
            system_->iterate(x_, keeps);
        }
        const double work = end_step(x_.size(), x_.data(), before_.data(), predicted_.data(), applied_.data());
        if (!keeps) applied_ = Rows<Scalar>(x_.size());
        if (work < 0.0) {
            nesterov_ = 1.0;
            ++summary.restarts;
        }
        ++summary.steps;
    }
    system_->store(x_, x);
    return summary;
}

// t_{k+1} = (1 + sqrt(1 + 4 t_k^2)) / 2 and b = (t_k - 1) / t_{k+1}.
template <typename Scalar>
double XpbdNeoHookean<Scalar>::momentum()
{
    if (!options_.momentum) return 0.0;
    const double next = (1.0 + std::sqrt(1.0 + 4.0 * nesterov_ * nesterov_)) / 2.0;
    return (std::exchange(nesterov_, next) - 1.0) / next;
}

template class XpbdNeoHookean<float>;
template class XpbdNeoHookean<double>;

}  // namespace pbs
