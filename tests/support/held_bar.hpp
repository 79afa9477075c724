// The bar of two bones with springs of its own: inputs for the energy of elastic flesh, without a character.
#pragma once

#include "pbs/flesh/bone_springs.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/two_bone_limb.hpp"

namespace test_support {

// Springs at random points around the axis, in the middle of each bone.
inline pbs::BoneSprings random_springs(int springs, double stiffness, unsigned seed = 7)
{
    RandomPoints random(seed);
    pbs::BoneSprings held{pbs::Positions(springs, 3), Eigen::VectorXd(springs), {}};
    for (int s = 0; s < springs; ++s) {
        const int bone = s % 2;
        held.points.row(s) << (bone == 0 ? -1.0 : 1.0) * random.number(0.2, 0.8), random.number(-0.08, 0.08), random.number(-0.08, 0.08);
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

}  // namespace test_support
