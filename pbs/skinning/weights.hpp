// Skinning weights, sparse in bones.
#pragma once

#include "pbs/skinning/bone_binding.hpp"

namespace pbs {

// Weights of vertex i: entries first(i) .. first(i + 1) - 1 of `bone` and `weight`; they sum to one.
struct Weights {
    std::vector<int> first;  // #V + 1
    std::vector<int> bone;
    std::vector<double> weight;

    int vertices() const { return static_cast<int>(first.size()) - 1; }
    bool blended(int vertex) const { return first[vertex + 1] - first[vertex] > 1; }
};

Weights paper_weights(const BoneBinding& binding, const Skeleton& skeleton);  // Eq. 2
Weights rigid_weights(const BoneBinding& binding);                            // nearest bone only

// The other reading of Eq. 2's n_joints: near either end, 1 / n over all bones that touch the bone at either end.
Weights either_end_weights(const BoneBinding& binding, const Skeleton& skeleton);

}  // namespace pbs
