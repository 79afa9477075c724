// The matrix of determinant one that is nearest to a deformation gradient, the local step for volumes of projective dynamics (S. Bouaziz,
// S. Martin, T. Liu, L. Kavan, M. Pauly: Projective dynamics, ACM Transactions on Graphics 33(4), 2014).
//   const LocalShapes local = local_shapes(f);   // rotation and volume-preserving matrix nearest to F
#pragma once

#include "pbs/geometry/types.hpp"

namespace pbs {

// s* with s*_1 s*_2 s*_3 = 1 that is nearest to s. s: two numbers of zero or more, and a third of either sign, of no larger magnitude. The
// condition of the minimum is s*_i - s_i + kappa / s*_i = 0 for all i with one kappa, so that a single unknown is left; it is found between
// bounds by Newton's method and bisection.
Vec3 nearest_unit_product(const Vec3& s);

struct LocalShapes {
    Eigen::Matrix3d rotation;     // nearest to F with det = +1
    Eigen::Matrix3d unit_volume;  // nearest to F with det = 1
};

// Both by F = R V diag(s) V^T, with R of nearest_rotation.hpp. All entries are not a number where F is not finite.
LocalShapes local_shapes(const Eigen::Matrix3d& f);

}  // namespace pbs
