#include "pbs/skinning/weights.hpp"

#include <algorithm>

namespace pbs {
namespace {

void append_vertex(Weights& weights, const std::vector<int>& bones)
{
    for (const int bone : bones) {
        weights.bone.push_back(bone);
        weights.weight.push_back(1.0 / bones.size());
    }
    weights.first.push_back(static_cast<int>(weights.bone.size()));
}

}  // namespace

Weights paper_weights(const BoneBinding& binding, const Skeleton& skeleton)
{
    std::vector<std::vector<int>> at_head, at_tail;
    for (int j = 0; j < static_cast<int>(skeleton.bones.size()); ++j) {
        at_head.push_back(bones_meeting(skeleton, j, BoneEnd::head));
        at_tail.push_back(bones_meeting(skeleton, j, BoneEnd::tail));
    }
    Weights weights{{0}, {}, {}};
    for (std::size_t i = 0; i < binding.bone.size(); ++i) {
        const int bone = binding.bone[i];
        const double t = binding.parameter(i);
        // Eq. 2: w_j = 1 for 1/6 <= t <= 5/6, otherwise 1 / n over the bones that meet at the nearest end.
        if (t < 1.0 / 6.0)
            append_vertex(weights, at_head[bone]);
        else if (t <= 5.0 / 6.0)
            append_vertex(weights, {bone});
        else
            append_vertex(weights, at_tail[bone]);
    }
    return weights;
}

Weights either_end_weights(const BoneBinding& binding, const Skeleton& skeleton)
{
    Weights weights{{0}, {}, {}};
    for (std::size_t i = 0; i < binding.bone.size(); ++i) {
        std::vector<int> bones = {binding.bone[i]};
        const double t = binding.parameter(i);
        if (t < 1.0 / 6.0 || t > 5.0 / 6.0)
            for (const BoneEnd end : {BoneEnd::head, BoneEnd::tail})
                for (const int other : bones_meeting(skeleton, binding.bone[i], end))
                    if (std::find(bones.begin(), bones.end(), other) == bones.end()) bones.push_back(other);
        append_vertex(weights, bones);
    }
    return weights;
}

Weights rigid_weights(const BoneBinding& binding)
{
    Weights weights{{0}, {}, {}};
    for (const int bone : binding.bone) append_vertex(weights, {bone});
    return weights;
}

}  // namespace pbs
