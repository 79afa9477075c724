// The null space of a stiffness matrix without supports: the six rigid motions. Smoothed aggregation keeps them on its coarse levels.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

namespace reference_fem {

// Three translations and three rotations about `centre` over `length_m`, #dofs x 6; nodes [m], degree of freedom 3 n + c.
Eigen::MatrixXd rigid_body_modes(const pbs::Positions& nodes, const pbs::Vec3& centre, double length_m);
Eigen::MatrixXd rigid_body_modes(const pbs::Positions& nodes);  // about the middle of their bounding box, over its diagonal

}  // namespace reference_fem
