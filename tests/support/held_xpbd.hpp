// The bar of two bones, bent, with what XPBD of its flesh needs.
#pragma once

#include "pbs/flesh/xpbd_neo_hookean.hpp"
#include "tests/support/held_bar.hpp"

namespace test_support {

struct HeldXpbd {
    explicit HeldXpbd(const std::array<int, 3>& cells, double time_step = 0.8, const pbs::Vec3& joint = pbs::Vec3::Zero())
        : HeldXpbd(two_bone_limb(cells, pbs::Vec3::UnitZ(), 70.0, joint), time_step, joint)
    {
    }
    HeldXpbd(TwoBoneLimb limb, double time_step, const pbs::Vec3& joint = pbs::Vec3::Zero())
        : HeldXpbd(std::move(limb), time_step, springs_at(joint))
    {
    }
    HeldXpbd(TwoBoneLimb limb, double time_step, const pbs::BoneSprings& springs)
        : bent(std::move(limb)),
          hold(bent.mesh, springs, 2),
          energy(bent.mesh, material, hold),
          flesh(bent.mesh, energy, hold, material, time_step)
    {
        hold.centres(bent.pose, centres);
        flesh.hold.targets(bent.pose, targets);
    }

    static pbs::BoneSprings springs_at(const pbs::Vec3& joint)
    {
        pbs::BoneSprings springs = random_springs(60, 0.3);
        springs.points.rowwise() += joint.transpose();
        return springs;
    }

    pbs::Positions gradient(const pbs::Positions& x) const
    {
        pbs::Positions of_energy;
        energy.value_and_gradient(x, centres, of_energy);
        return of_energy;
    }
    // The gradient of the energy and of sum_i |x_i - from_i|^2 / (2 w_i): what vanishes after a step of implicit Euler from rest.
    pbs::Positions gradient_with_inertia(const pbs::Positions& x, const pbs::Positions& from) const
    {
        return gradient(x) + flesh.w.cwiseInverse().asDiagonal() * (x - from);
    }
    template <typename Scalar>
    pbs::XpbdNeoHookeanSummary minimise(const pbs::XpbdNeoHookeanOptions& options, pbs::Positions& x) const
    {
        return pbs::XpbdNeoHookean<Scalar>(bent.mesh, flesh, options).minimise(targets, x);
    }

    TwoBoneLimb bent;
    pbs::FleshMaterial material = pbs::flesh_material(0.45);
    pbs::BoneHold hold;
    pbs::FleshEnergy energy;
    pbs::XpbdFlesh flesh;
    pbs::Positions centres, targets;
};

}  // namespace test_support
