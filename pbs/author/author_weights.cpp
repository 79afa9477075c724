#include "pbs/author/author_solver.hpp"

namespace pbs {

Weights author_weights(const BoneBinding& binding, const Skeleton& skeleton)
{
    const int bones = static_cast<int>(skeleton.bones.size());
    std::vector<std::vector<int>> at_head(bones), at_tail(bones);
    for (int j = 0; j < bones; ++j) {
        const int parent = skeleton.bones[j].parent;
        at_head[j].push_back(j);
        at_tail[j].insert(at_tail[j].begin(), j);
        if (parent < 0) continue;
        at_head[j].push_back(parent);
        at_tail[parent].push_back(j);
    }
    Weights weights{{0}, {}, {}};
    for (std::size_t i = 0; i < binding.bone.size(); ++i) {
        const int bone = binding.bone[i];
        const double t = binding.parameter(i);
        // Eq. 2. Outside of the middle, the nearer end is the head exactly where t < 1/2.
        const std::vector<int> joints = t < 1.0 / 6.0 ? at_head[bone] : t <= 5.0 / 6.0 ? std::vector{bone} : at_tail[bone];
        weights.bone.insert(weights.bone.end(), joints.begin(), joints.end());
        weights.weight.resize(weights.bone.size(), 1.0 / static_cast<double>(joints.size()));
        weights.first.push_back(static_cast<int>(weights.bone.size()));
    }
    return weights;
}

}  // namespace pbs
