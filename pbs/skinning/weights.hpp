// Skinning weights, sparse in bones.
#pragma once

namespace pbs {

// The weights of vertex i are the entries first(i) .. first(i + 1) - 1 of `bone` and `weight`; they sum to one. Weights made
// here and weights read from files obey that; no other weights are checked.
struct Weights {
    std::vector<int> first;      // begins with 0, #V + 1
    std::vector<int> bone;       // index into Skeleton::bones, #entries
    std::vector<double> weight;  // in [0, 1], #entries

    int vertices() const { return static_cast<int>(first.size()) - 1; }               // #V; -1 of default-made weights
    bool blended(int vertex) const { return first[vertex + 1] - first[vertex] > 1; }  // between two bones or more
};

// `binding` must belong to this skeleton (unchecked); it determines #V and the order of the vertices.
Weights paper_weights(const BoneBinding& binding, const Skeleton& skeleton);  // Eq. 2: 1 at 1/6 <= t <= 5/6, else 1 / n of bones_meeting
Weights rigid_weights(const BoneBinding& binding);                            // nearest bone only

// The other reading of Eq. 2's n_joints: near either end, 1 / n over all bones that touch the bone at either end.
Weights either_end_weights(const BoneBinding& binding, const Skeleton& skeleton);

}  // namespace pbs
