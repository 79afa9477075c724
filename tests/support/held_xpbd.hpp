// The bar of two bones, bent, with what XPBD of its flesh needs.
#pragma once

#include "pbs/flesh/xpbd_neo_hookean.hpp"
#include "tests/support/held_bar.hpp"

namespace test_support {

struct HeldXpbd : HeldBar {
    explicit HeldXpbd(const std::array<int, 3>& cells, double time_step = 0.8) : HeldXpbd(HeldBar(cells), time_step) {}
    explicit HeldXpbd(HeldBar bar, double time_step = 0.8)
        : HeldBar(std::move(bar)), flesh(bent.mesh, energy, hold, material, time_step)
    {
        flesh.hold.targets(bent.pose, targets);
    }

    // The gradient of the energy and of sum_i |x_i - from_i|^2 / (2 w_i): what vanishes after a step of implicit Euler
    // from rest.
    pbs::Positions gradient_with_inertia(const pbs::Positions& x, const pbs::Positions& from) const
    {
        return gradient(x) + flesh.w.cwiseInverse().asDiagonal() * (x - from);
    }
    template <typename Scalar>
    pbs::XpbdNeoHookeanSummary minimise(const pbs::XpbdNeoHookeanOptions& options, pbs::Positions& x) const
    {
        return pbs::XpbdNeoHookean<Scalar>(bent.mesh, flesh, options).minimise(targets, x);
    }

    pbs::XpbdFlesh flesh;
    pbs::Positions targets;
};

}  // namespace test_support
