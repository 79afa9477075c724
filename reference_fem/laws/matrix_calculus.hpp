// Pieces that the derivatives of the laws share. vec stacks columns, so entry (i, j) of a 3 x 3 matrix is entry 3 j + i of a 9-vector.
#pragma once

#include "reference_fem/laws/constitutive_law.hpp"

namespace reference_fem {

using Vector9 = Eigen::Matrix<double, 9, 1>;  // of a 3 x 3 matrix, column under column

// Entry (i, j) becomes entry 3 j + i.
inline Vector9 vec(const Eigen::Matrix3d& matrix)
{
    return Eigen::Map<const Vector9>(matrix.data());
}

// vec(A) vec(B)^T.
inline Tangent outer(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b)
{
    return vec(a) * vec(b).transpose();
}

// d det F / d F = det F  F^-T, defined for every F.
Eigen::Matrix3d cofactor(const Eigen::Matrix3d& f);
// d vec cofactor(F) / d vec F, linear in F: symmetric.
Tangent cofactor_derivative(const Eigen::Matrix3d& f);
// d vec(A D^T A) / d vec D for a fixed A: entry (ij, kl) is A_il A_kj.
Tangent transposing_product(const Eigen::Matrix3d& a);

// Changes against F = I. Near it they are sums of small terms in G = F - I, not small differences of large ones, so that an energy made of
// them is exact to rounding relative to itself.
struct Invariants {
    double volume;               // J = det F
    double volume_change;        // J - 1
    double squared_norm_change;  // |F|^2 - 3
    double shear;                // (|F|^2 - 3) / 2 - (J - 1)

    double log_volume() const;  // ln J, for J > 0
};
Invariants invariants(const Eigen::Matrix3d& f);  // of any finite F, inverted ones too

}  // namespace reference_fem
