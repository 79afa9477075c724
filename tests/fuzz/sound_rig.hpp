// Checks a rig that was read: its skeleton, surface and poses are finite, and its weights sum to one.
#pragma once

#include "experiments/rigs/rigged_body.hpp"
#include "tests/fuzz/target.hpp"

#include <cmath>

namespace fuzz {

inline void expect_sound(const pbs::Rig& rig)
{
    if (rig.meshes.empty()) return;
    const pbs::RigAnimation* animation = pbs::find_animation(rig, "");
    const pbs::RiggedBody body = pbs::make_rigged_body(rig, animation, 1.0);
    expect(body.surface.allFinite());
    for (int point = 0; point < body.skin.vertices(); ++point) {
        double sum = 0.0;
        for (int entry = body.skin.first[point]; entry < body.skin.first[point + 1]; ++entry)
            sum += body.skin.weight[entry];
        expect(std::abs(sum - 1.0) < 1e-6);
    }
    for (const pbs::Bone& bone : body.skeleton.bones) expect(bone.head.allFinite() && bone.tail.allFinite());
    const auto nodes = pbs::node_transforms(rig, animation, animation ? animation->end_s : 0.0);
    for (const Eigen::Isometry3d& bone : pbs::rigid_pose(body, nodes)) expect(bone.matrix().allFinite());
}

}  // namespace fuzz
