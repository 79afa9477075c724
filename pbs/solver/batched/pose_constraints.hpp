// Constraints as many poses of a mesh are projected with side by side. Plain data, for builders and kernels alike.
#pragma once

#include <cstdint>

namespace pbs {

// Poses of one vertex side by side: x of sixteen poses [m], then y, then z.
inline constexpr int poses_a_block = 16;

// Selects the stiffness of a pose that applies to a constraint.
enum class StiffnessOf : std::uint32_t { stretch, jiggling_stretch, volume };
inline constexpr int stiffness_classes = 3;  // values of StiffnessOf

// A constraint shared by all poses, except for its stiffness.
template <typename Scalar>
struct PoseEdge {
    std::uint32_t vertex[2];  // in the new order
    StiffnessOf stiffness;    // of each pose
    Scalar rest_length;       // [m]
    Scalar w[2];              // inverse masses
    Scalar one_over_w;        // 1 / (w1 + w2), zero where both are pinned
};

// Likewise.
template <typename Scalar>
struct PoseTet {
    std::uint32_t vertex[4];  // in the new order
    StiffnessOf stiffness;    // of each pose
    Scalar six_rest_volume;   // [m^3]
    Scalar w[4];              // inverse masses
};

// The bind constraint of one vertex in all poses.
template <typename Scalar>
struct PoseBind {
    Scalar rest_distance;  // [m]
    Scalar free;           // 1, or 0 where the vertex is pinned
};

}  // namespace pbs
