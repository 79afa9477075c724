// The rotation nearest to a 3 x 3 matrix: the R with det R = +1 that maximizes tr(R^T M), which is also the one that
// minimizes |M - R| (orthogonal Procrustes problem). For det M > 0 it is the rotation of the polar decomposition.
//   const Eigen::Matrix3d r = nearest_rotation(covariance);   also Eigen::Matrix3f
// The formulae of rotation_formula.hpp give it without an iterative singular value decomposition, three to four times
// as fast. They refuse matrices whose nearest rotation is not unique or nearly so (rank one or zero, reflections with
// equal smaller singular values). Those go to Eigen's JacobiSVD in double, which returns one of the nearest rotations,
// the identity for the zero matrix. A matrix that is not finite has a result of which all entries are not a number.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

namespace pbs {

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix);
Eigen::Matrix3f nearest_rotation(const Eigen::Matrix3f& matrix);  // what its formulae refuse is computed in double

// By JacobiSVD alone.
Eigen::Matrix3d nearest_rotation_by_svd(const Eigen::Matrix3d& matrix);

}  // namespace pbs
