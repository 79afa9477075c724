// The inner loops of the order `ordered`, compiled for the machine (PBS_NATIVE): raw pointers only.
// vertices: x, y, z [m] and w, the inverse mass, of each, 16 bytes aligned in float, 32 in double.
#pragma once

#include "pbs/packed/batch.hpp"

#include <cstddef>
#include <cstdint>

namespace pbs {

// Projects `count` batches, Batch<Scalar, kind>, one after the other.
template <typename Scalar>
void project_batches(ConstraintKind kind, const void* batches, int count, Scalar* vertices);

// Projects the bind constraints of vertices 0 .. 16 count - 1.
template <typename Scalar>
void project_bind_batches(const BindBatch<Scalar>* batches, int count, Scalar* vertices);

// Sum over the constraints of (l / l0 - 1)^2, (V / V0 - 1)^2, and of bind's C^2 [m^2].
template <typename Scalar>
double sum_squared_errors(ConstraintKind kind, const void* batches, int count, const Scalar* vertices);
// The largest |l / l0 - 1| or |V / V0 - 1| of each constraint, batch_size a batch; zero for lanes without one.
template <typename Scalar>
void largest_errors(ConstraintKind kind, const void* batches, int count, const Scalar* vertices, Scalar* errors);
// Residuals of the bind constraints of vertices 0 .. 16 count - 1 [m^2].
template <typename Scalar>
double sum_squared_bind_errors(const BindBatch<Scalar>* batches, int count, const Scalar* vertices);

int kernel_lanes(int bytes_of_scalar);  // numbers that these kernels work on at once
const char* kernel_instructions();      // AVX-512, AVX2, AVX, SSE2, baseline

// The inner loops of XPBD in the order `ordered`, compiled for the machine (PBS_NATIVE): raw pointers
// only. They are twins of project_batches: the same batches and vertices, with a compliance and a multiplier for each
// constraint. A batch's stiffness is 1 / alpha here: of an edge [N/m], and of six times the volume of a tet [N/m^5];
// zero: there is no constraint. vertices: x, y, z [m] and w [1/kg] of each, 16 bytes aligned in float, 32 in double.

// Projects `count` batches, Batch<Scalar, kind>, one after the other. dt2: the square of the substep [s^2].
// multipliers: lambda of each constraint of each batch in each lane, by batches, then constraints, 64 bytes aligned.
template <typename Scalar>
void project_compliant_batches(ConstraintKind kind, const void* batches, int count, Scalar dt2, Scalar* multipliers,
                               Scalar* vertices);

// Constraints as many poses of a mesh are projected with side by side. Plain data, for builders and kernels alike.

// Poses of one vertex side by side: x of sixteen poses [m], then y, then z.
inline constexpr int poses_a_block = 16;

// Selects the stiffness of a pose that applies to a constraint.
enum class StiffnessOf : std::uint32_t { stretch, jiggling_stretch, volume };
inline constexpr int stiffness_classes = 3;  // values of StiffnessOf

// A constraint of n vertices shared by all poses, except for its stiffness.
template <typename Scalar, int n>
struct PoseConstraint {
    std::uint32_t vertex[n];  // in the new order
    StiffnessOf stiffness;    // of each pose
    Scalar rest;              // rest length [m] of an edge, six times the rest volume [m^3] of a tet
    Scalar w[n];              // inverse masses
};
template <typename Scalar>
using PoseTet = PoseConstraint<Scalar, 4>;
template <typename Scalar>
struct PoseEdge : PoseConstraint<Scalar, 2> {
    Scalar one_over_w;  // 1 / (w1 + w2), zero where both are pinned
};

// The bind constraint of one vertex in all poses.
template <typename Scalar>
struct PoseBind {
    Scalar rest_distance;  // [m]
    Scalar free;           // 1, or 0 where the vertex is pinned
};

// The inner loops of many poses side by side, compiled for the machine: raw pointers only. One constraint works on
// sixteen poses at once, so nothing is gathered. poses: of each vertex x, y, z [m] of poses_a_block poses; stiffness:
// of each class, k of every pose.

// Eq. 10, edge by edge.
template <typename Scalar>
void project_pose_edges(const PoseEdge<Scalar>* edges, std::size_t count, const Scalar* stiffness, Scalar* poses);
// Eq. 11, tet by tet.
template <typename Scalar>
void project_pose_tets(const PoseTet<Scalar>* tets, std::size_t count, const Scalar* stiffness, Scalar* poses);
// bind_points: q_i like poses; k_bind: of every pose. Vertex i has constraint i.
template <typename Scalar>
void project_pose_binds(const PoseBind<Scalar>* binds, std::size_t count, const Scalar* k_bind,
                        const Scalar* bind_points, Scalar* poses);

}  // namespace pbs
