// The polar decomposition F = R S with det R = +1, by the signed singular values F = U diag(s) V^T: where det F < 0 the smallest is
// negative, so that R turns F as little as a rotation can and S takes the reflection
// (G. Irving, J. Teran, R. Fedkiw, Invertible Finite Elements for Robust Simulation of Large Deformation, SCA 2004).
#pragma once

#include "reference_fem/laws/constitutive_law.hpp"

namespace reference_fem {

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
