// Skinning weights, sparse in bones, and how vertices are bound to the skeleton.
//   const BoneBinding binding = bind_to_nearest_bone(mesh.rest, skeleton);
//   const Weights weights = paper_weights(binding, skeleton);            // Eq. 2
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/pose.hpp"

#include <functional>

namespace pbs {

// How each vertex is bound to the skeleton in rest pose: its nearest bone and its projection on that bone. It has one
// entry per vertex of the bound mesh.
struct BoneBinding {
    std::vector<int> bone;      // nearest bone of each vertex, #V; the first of equals
    Eigen::VectorXd parameter;  // position along the bone, (v - s).(d - s) / |d - s|^2, not clamped, #V
    Positions rest_point;       // projection on the bone's segment [m], #V x 3: a material point of the bone
    Eigen::VectorXd distance;   // d_i = |v_i - rest_point_i| [m], #V
};

// Binds each of the rest positions [m], #V x 3, to its nearest bone. A bone without length is the point at its head,
// with parameter 0. may_bind(vertex, bone) excludes bones, unless all are excluded for a vertex; by default any bone
// may bind. InputError if the skeleton has no bone.
BoneBinding bind_to_nearest_bone(const Positions& rest, const Skeleton& skeleton,
                                 const std::function<bool(int, int)>& may_bind = {});

// The projection points q_i carried by their posed bones [m], #V x 3. The pose has every bone of the binding
// (unchecked).
Positions posed_bind_points(const BoneBinding& binding, const Pose& pose);

// The other reading of "its projection on the nearest bone" (Sec. 3.6): positions [m], #V x 3, projected anew on their
// posed bones' segments.
Positions reprojected_bind_points(const BoneBinding& binding, const Skeleton& skeleton, const Pose& pose,
                                  const Positions& positions);

// The weights of vertex i are the entries first(i) .. first(i + 1) - 1 of `bone` and `weight`; they sum to one. Weights
// made here and weights read from files obey that; no other weights are checked.
struct Weights {
    std::vector<int> first;      // begins with 0, #V + 1
    std::vector<int> bone;       // index into Skeleton::bones, #entries
    std::vector<double> weight;  // in [0, 1], #entries

    int vertices() const { return static_cast<int>(first.size()) - 1; }               // #V; -1 of default-made weights
    bool blended(int vertex) const { return first[vertex + 1] - first[vertex] > 1; }  // between two bones or more
    double of(int vertex, int of_bone) const
    {
        double sum = 0.0;
        for (int e = first[vertex]; e < first[vertex + 1]; ++e) sum += bone[e] == of_bone ? weight[e] : 0.0;
        return sum;
    }
    // Appends an entry to the vertex behind the last one, and ends that vertex.
    void add(int of_bone, double of_weight)
    {
        bone.push_back(of_bone);
        weight.push_back(of_weight);
    }
    void end_vertex() { first.push_back(static_cast<int>(bone.size())); }
};

// Weights by Eq. 2: a vertex at 1/6 <= t <= 5/6 along its bone has weight 1 of this bone, and any other vertex has 1 /
// n of each of the n bones that meet at this end (bones_meeting). `binding` must belong to the skeleton (unchecked); it
// determines #V and the order of the vertices.
Weights paper_weights(const BoneBinding& binding, const Skeleton& skeleton);
Weights rigid_weights(const BoneBinding& binding);  // weight 1 of the nearest bone

// The other reading of Eq. 2's n_joints: near either end, 1 / n over all bones that touch the bone at either end.
Weights either_end_weights(const BoneBinding& binding, const Skeleton& skeleton);

// The weights of Eq. 2 where these bones meet at the head and at the tail of each bone.
using BonesAtEnd = std::vector<std::vector<int>>;  // of each bone
Weights weights_by_end(const BoneBinding& binding, const BonesAtEnd& at_head, const BonesAtEnd& at_tail);

// Weights from a matrix with one row per vertex and one column per bone: entries above `negligible`, scaled to a sum of
// one. A vertex without such an entry has its weights of `otherwise`.
Weights sparse_weights(const Eigen::MatrixXd& dense, double negligible, const Weights& otherwise);

// Smooth weights of the bones in the flesh, by linear elements. Weights are 1 where their bone grips the flesh, 0 where
// another one does, and harmonic between. They predict where the flesh moves with the bones, for example as an initial
// guess of a solver. gripping_bone: #V, -1 where no bone grips. A connected part that nothing grips belongs to the
// first bone.
Weights harmonic_weights(const TetMesh& mesh, const std::vector<int>& gripping_bone, int bones);

// The same with given weights, of which a vertex may have several: known: #V, which rows of `weights` are given;
// weights: #V x #bones.
Weights harmonic_extension(const TetMesh& mesh, const std::vector<bool>& known, const Eigen::MatrixXd& weights);

// Weights that vary smoothly because given ones have diffused through the flesh.
//   const Weights smooth = diffused_weights(mesh, paper_weights(binding, skeleton));

// Steps of the default. Each goes half-way to the mean over the neighbours along the tets' edges, so that weights stay
// in [0, 1], add up to one and cannot alternate from vertex to vertex. After 8 steps a weight has spread by about two
// edges.
inline constexpr int diffusion_steps = 8;

// Weights below 1e-6 are left out, and the others of the vertex are scaled to a sum of one. A vertex without tets keeps
// its own.
Weights diffused_weights(const TetMesh& mesh, const Weights& weights, int steps = diffusion_steps);

}  // namespace pbs
