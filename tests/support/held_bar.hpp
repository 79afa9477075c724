// The bar of two bones with springs of its own: inputs for the energy of elastic flesh, without a character.
#pragma once

#include "pbs/flesh/flesh_energy.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <array>
#include <utility>

namespace test_support {

// Springs at random points around the axis, in the middle of each bone.
inline pbs::BoneSprings random_springs(int springs, double stiffness, unsigned seed = 7)
{
    RandomPoints random(seed);
    pbs::BoneSprings held{pbs::Positions(springs, 3), Eigen::VectorXd(springs), {}};
    for (int s = 0; s < springs; ++s) {
        const int bone = s % 2;
        held.points.row(s) << (bone == 0 ? -1.0 : 1.0) * random.number(0.2, 0.8), random.number(-0.08, 0.08),
            random.number(-0.08, 0.08);
        held.stiffness(s) = stiffness * random.number(0.5, 1.5);
        held.bone.push_back(bone);
    }
    return held;
}

// Random springs of a bar whose joint is here.
inline pbs::BoneSprings springs_at(const pbs::Vec3& joint, int count = 60)
{
    pbs::BoneSprings springs = random_springs(count, 0.3);
    springs.points.rowwise() += joint.transpose();
    return springs;
}

// Every vertex moved by up to `size`.
inline pbs::Positions jittered(pbs::Positions positions, double size, unsigned seed = 3)
{
    RandomPoints random(seed);
    for (auto point : positions.rowwise()) point += random.point(size).transpose();
    return positions;
}

inline pbs::Positions mirrored(pbs::Positions positions, int axis = 2)
{
    positions.col(axis) *= -1.0;
    return positions;
}

// The bar of two bones, bent by 70 degrees about this joint, with the energy of its flesh (nu = 0.45).
struct HeldBar {
    explicit HeldBar(const std::array<int, 3>& cells, const pbs::Vec3& joint = pbs::Vec3::Zero())
        : HeldBar(two_bone_limb(cells, pbs::Vec3::UnitZ(), 70.0, joint), springs_at(joint))
    {
    }
    HeldBar(TwoBoneLimb limb, const pbs::BoneSprings& held_by)
        : bent(std::move(limb)), springs(held_by), hold(bent.mesh, springs, 2), energy(bent.mesh, material, hold)
    {
        hold.centres(bent.pose, centres);
    }
    // The first tet alone, with a spring in its middle; the other vertices have no tets.
    static HeldBar one_tet(const std::array<int, 3>& cells, double stiffness = 1.0, int bone = 0)
    {
        TwoBoneLimb limb = two_bone_limb(cells, pbs::Vec3::UnitZ(), 70.0);
        limb.mesh.tets = pbs::Tets(limb.mesh.tets.topRows(1));
        pbs::BoneSprings spring{pbs::Positions::Zero(1, 3), Eigen::VectorXd::Constant(1, stiffness), {bone}};
        for (const int v : limb.mesh.tets.row(0)) spring.points.row(0) += limb.mesh.rest.row(v) / 4.0;
        return {limb, spring};
    }

    pbs::Positions gradient(const pbs::Positions& x) const
    {
        pbs::Positions of_energy;
        energy.value_and_gradient(x, centres, of_energy);
        return of_energy;
    }
    int vertices() const { return static_cast<int>(bent.mesh.rest.rows()); }

    TwoBoneLimb bent;
    pbs::FleshMaterial material = pbs::flesh_material(0.45);
    pbs::BoneSprings springs;
    pbs::BoneHold hold;
    pbs::FleshEnergy energy;
    pbs::Positions centres;
};

}  // namespace test_support
