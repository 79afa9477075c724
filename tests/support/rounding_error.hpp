// Bounds of rounding errors, for tolerances. A sum of products of which each goes through at most n roundings is in error by at most n
// times the unit roundoff, eps / 2, times the sum of their magnitudes (N. Higham, Accuracy and stability of numerical algorithms, 2nd ed.,
// SIAM 2002, Sec. 3.1). n counts the sums as well, and both sides of a comparison where both are rounded.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace test_support {

// In the unit of the magnitude, of numbers in float or double.
template <typename Scalar>
constexpr double rounding_error_in(double roundings, double magnitude)
{
    return roundings * (double(std::numeric_limits<Scalar>::epsilon()) / 2.0) * magnitude;
}

constexpr double rounding_error(double roundings, double magnitude)
{
    return rounding_error_in<double>(roundings, magnitude);
}

// The rounding error of the mean of so many values of one sign, each of which is rounded.
constexpr double mean_error(std::size_t values, double mean)
{
    return rounding_error(1.0 + static_cast<double>(values), mean);
}

// The rounding error of a position after so many rigid motions, in the unit of `farthest`, the largest norm on the way. An entry of a
// rotation goes through eight roundings from an angle and an axis, a quaternion or a blend of two, and a coordinate through four more of
// its product with the entries of a row, of norm one.
inline double motion_error(int motions, double farthest)
{
    return std::sqrt(3.0) * rounding_error((8.0 + 4.0) * motions, farthest);
}

// The rounding error of the matrix of their product in the Frobenius norm, of nine entries and a translation.
inline double motion_matrix_error(int motions, double translation)
{
    return 3.0 * rounding_error((8.0 + 4.0) * motions, 1.0) + motion_error(motions, translation);
}

// The rounding error of the sum of the tets' volumes [m^3]: each goes through ten roundings of products of three edges, over 6, whose
// magnitudes add up to at most 2 / sqrt 3 times the product of the edges' lengths.
inline double volume_error(const pbs::Positions& positions, const pbs::Tets& tets)
{
    double magnitudes = 0.0;
    for (const auto& tet : tets.rowwise()) {
        double product = 2.0 / std::sqrt(3.0) / 6.0;
        for (int corner = 1; corner < 4; ++corner) product *= (positions.row(tet(corner)) - positions.row(tet(0))).norm();
        magnitudes += product;
    }
    return rounding_error(10.0 + static_cast<double>(tets.rows()), magnitudes);
}

// How strongly the worst tet of a mesh magnifies rounding: the condition number of its matrix of edges, in the Frobenius norm, for its
// inverse and for barycentric coordinates, which go through a dozen roundings; and the norm of that inverse [1/m], the largest change of a
// barycentric coordinate, or of a displacement's gradient, for a motion of a metre.
struct TetMagnification {
    double condition = 0.0;
    double inverse_edges = 0.0;  // [1/m]
};

inline TetMagnification worst_magnification(const pbs::TetMesh& mesh)
{
    TetMagnification worst;
    for (const auto& tet : mesh.tets.rowwise()) {
        Eigen::Matrix3d edges;
        for (int c = 0; c < 3; ++c) edges.col(c) = mesh.rest.row(tet(c + 1)) - mesh.rest.row(tet(0));
        const double inverse = edges.inverse().norm();
        worst = {std::max(worst.condition, edges.norm() * inverse), std::max(worst.inverse_edges, inverse)};
    }
    return worst;
}

}  // namespace test_support
