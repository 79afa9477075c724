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

// The polar decomposition F = R S with det R = +1, by the signed singular values F = U diag(s) V^T: where det F < 0 the smallest is
// negative, so that R turns F as little as a rotation can and S takes the reflection
// (G. Irving, J. Teran, R. Fedkiw, Invertible Finite Elements for Robust Simulation of Large Deformation, SCA 2004).

// F = U diag(s) V^T and S = V diag(s) V^T.
struct PolarDecomposition {
    Eigen::Matrix3d left, right;  // U, V: orthogonal
    Eigen::Vector3d stretches;    // s, falling; the last may be negative: the eigenvalues of S
    Eigen::Matrix3d rotation;     // R = U V^T
};

// f: finite.
PolarDecomposition polar_decomposition(const Eigen::Matrix3d& f);

// d vec R / d vec F: the three twist modes (U [e_k]x V^T) / sqrt 2, each by 2 / (s_i + s_j); symmetric, not negative.
// Where s_i + s_j = 0 the rotation is not unique and jumps. There and closer than 1e-8 max(1, s_1) the sum is taken for that bound.
Tangent rotation_derivative(const PolarDecomposition& polar);

}  // namespace reference_fem
