// The inner loops of many poses side by side, compiled for the machine: raw pointers only. One constraint works on sixteen poses at once,
// so nothing is gathered. poses: of each vertex x, y, z [m] of poses_a_block poses; stiffness: of each class, k of every pose.
#pragma once

#include "pbs/solver/batched/pbs_kernels.hpp"

#include <cstddef>

namespace pbs {

// Eq. 10, edge by edge.
template <typename Scalar>
void project_pose_edges(const PoseEdge<Scalar>* edges, std::size_t count, const Scalar* stiffness, Scalar* poses);
// Eq. 11, tet by tet.
template <typename Scalar>
void project_pose_tets(const PoseTet<Scalar>* tets, std::size_t count, const Scalar* stiffness, Scalar* poses);
// bind_points: q_i like poses; k_bind: of every pose. Vertex i has constraint i.
template <typename Scalar>
void project_pose_binds(const PoseBind<Scalar>* binds, std::size_t count, const Scalar* k_bind, const Scalar* bind_points, Scalar* poses);

}  // namespace pbs
