// Skinning weights, sparse in bones.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/pose.hpp"

#include <functional>

namespace pbs {

// How each vertex is bound to the skeleton in rest pose: its nearest bone and its projection on that bone.

// One entry per vertex of the bound mesh.
struct BoneBinding {
    std::vector<int> bone;      // nearest bone of each vertex, #V; the first of equals
    Eigen::VectorXd parameter;  // position along the bone, (v - s).(d - s) / |d - s|^2, not clamped, #V
    Positions rest_point;       // projection on the bone's segment [m], #V x 3: a material point of the bone
    Eigen::VectorXd distance;   // d_i = |v_i - rest_point_i| [m], #V
};

// rest: rest positions [m], #V x 3. A bone without length is the point at its head, with parameter 0. InputError where
// the skeleton has no bone. may_bind(vertex, bone), if given: the nearest of these bones; of all where a vertex has
// none.
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
    void add(int of_bone, double of_weight) { bone.push_back(of_bone), weight.push_back(of_weight); }
    void end_vertex() { first.push_back(static_cast<int>(bone.size())); }
};

// `binding` must belong to this skeleton (unchecked); it determines #V and the order of the vertices.
// Eq. 2: 1 at 1/6 <= t <= 5/6, else 1 / n of bones_meeting
Weights paper_weights(const BoneBinding& binding, const Skeleton& skeleton);
Weights rigid_weights(const BoneBinding& binding);  // nearest bone only

// The other reading of Eq. 2's n_joints: near either end, 1 / n over all bones that touch the bone at either end.
Weights either_end_weights(const BoneBinding& binding, const Skeleton& skeleton);

// The weights of Eq. 2 where these bones meet at the head and at the tail of each bone.
using BonesAtEnd = std::vector<std::vector<int>>;  // of each bone
Weights weights_by_end(const BoneBinding& binding, const BonesAtEnd& at_head, const BonesAtEnd& at_tail);

// One row per vertex and one column per bone: what exceeds `negligible`, scaled to a sum of one. A vertex where nothing
// does has its weights of `otherwise`.
Weights sparse_weights(const Eigen::MatrixXd& dense, double negligible, const Weights& otherwise);

// Smooth weights of the bones in the flesh: each bone's weight is harmonic between the vertices where it is known.

// Weights are 1 where their bone grips the flesh and 0 where another does. They predict where the flesh moves with the
// bones, for example as an initial guess of a solver. gripping_bone: #V, -1 where no bone grips. Linear elements. A
// connected part that nothing grips belongs to the first bone.
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
