// Bounds of rounding errors, for tolerances. A sum of products of which each goes through at most n roundings is in
// error by at most n times the unit roundoff, eps / 2, times the sum of their magnitudes (N. Higham, Accuracy and
// stability of numerical algorithms, 2nd ed., SIAM 2002, Sec. 3.1). n counts the sums as well, and both sides of a
// comparison where both are rounded.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/random_points.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

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

// The rounding error of a position after so many rigid motions, in the unit of `farthest`, the largest norm on the way.
// An entry of a rotation goes through eight roundings from an angle and an axis, a quaternion or a blend of two, and a
// coordinate through four more of its product with the entries of a row, of norm one.
inline double motion_error(int motions, double farthest)
{
    return std::sqrt(3.0) * rounding_error((8.0 + 4.0) * motions, farthest);
}

// The rounding error of the matrix of their product in the Frobenius norm, of nine entries and a translation.
inline double motion_matrix_error(int motions, double translation)
{
    return 3.0 * rounding_error((8.0 + 4.0) * motions, 1.0) + motion_error(motions, translation);
}

// The rounding error of the sum of the tets' volumes [m^3]: each goes through ten roundings of products of three edges,
// over 6, whose magnitudes add up to at most 2 / sqrt 3 times the product of the edges' lengths.
inline double volume_error(const pbs::Positions& positions, const pbs::Tets& tets)
{
    double magnitudes = 0.0;
    for (const auto& tet : tets.rowwise()) {
        double product = 2.0 / std::sqrt(3.0) / 6.0;
        for (int corner = 1; corner < 4; ++corner)
            product *= (positions.row(tet(corner)) - positions.row(tet(0))).norm();
        magnitudes += product;
    }
    return rounding_error(10.0 + static_cast<double>(tets.rows()), magnitudes);
}

// How strongly the worst tet of a mesh magnifies rounding: the condition number of its matrix of edges, in the
// Frobenius norm, for its inverse and for barycentric coordinates, which go through a dozen roundings; and the norm of
// that inverse [1/m], the largest change of a barycentric coordinate, or of a displacement's gradient, for a motion of
// a metre.
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

// The rounding error of slopes of fitted lines, for tolerances. The slope of points (x, y) on a line is sum (x - mean)
// y / S, where S = sum (x - mean)^2. Errors e_x and e_y of the points change it by at most (e_y + |slope| e_x) sum |x -
// mean| / S, which is at most (e_y + |slope| e_x) sqrt(n / S). Each coordinate goes through n + 1 roundings of its mean
// and difference; the two sums have terms of one sign, of which each goes through three for each of the points. x and y
// may be in error by so much themselves.
inline double slope_error(const std::vector<double>& x, const std::vector<double>& y, double slope,
                          double x_error = 0.0, double y_error = 0.0)
{
    const double n = static_cast<double>(x.size()), mean = std::accumulate(x.begin(), x.end(), 0.0) / n;
    double squares = 0.0, largest_x = 0.0, largest_y = 0.0;
    for (const double value : x)
        squares += (value - mean) * (value - mean), largest_x = std::max(largest_x, std::abs(value));
    for (const double value : y) largest_y = std::max(largest_y, std::abs(value));
    const double of_points =
        y_error + rounding_error(n + 1, largest_y) + std::abs(slope) * (x_error + rounding_error(n + 1, largest_x));
    return of_points * std::sqrt(n / squares) + rounding_error(6 * n + 1, std::abs(slope));
}

// The rounding error of the exponent of a power law. It is the slope between logarithms of two roundings each; y goes
// through so many roundings itself.
inline double exponent_error(std::vector<double> x, std::vector<double> y, double exponent, double roundings_of_y)
{
    double of_x = 0.0, of_y = rounding_error(roundings_of_y, 1.0);
    for (double& value : x) value = std::log(value), of_x = std::max(of_x, rounding_error(2, std::abs(value)));
    for (double& value : y)
        value = std::log(value),
        of_y = std::max(of_y, rounding_error(2, std::abs(value)) + rounding_error(roundings_of_y, 1.0));
    return slope_error(x, y, exponent, of_x, of_y);
}

// The change of a value by the rounding of the positions that it is computed from, where no bound is near: for sections
// of curved skin, or ratios of strains, whose worst case is a plane along an edge or a flat tet. The condition number
// is measured: random changes of all coordinates by up to the rounding itself change the value, and rounding is one
// more such change. A normally distributed change exceeds three times the largest of 32 others with a probability of
// 6e-7.
//   EXPECT_NEAR(of_float, of_double, value_rounding(positions, single_rounding_m(positions), value));
//
// value: a function of positions, in any unit, which the result has as well. rounding_m: of a coordinate. A value that
// is not finite is a failure of the test.
template <typename Value>
double value_rounding(const pbs::Positions& positions, double rounding_m, Value value)
{
    RandomPoints random(71);
    const double undisturbed = value(positions);
    double largest = 0.0;
    for (int draw = 0; draw < 32; ++draw) {
        pbs::Positions moved = positions;
        for (Eigen::Index v = 0; v < moved.rows(); ++v) moved.row(v) += random.point(rounding_m).transpose();
        const double change = std::abs(value(moved) - undisturbed);
        EXPECT_TRUE(std::isfinite(change)) << "draw " << draw;
        largest = std::max(largest, change);
    }
    return 3.0 * largest;
}

// The rounding of coordinates that are rounded to float once, relative to an origin among them.
inline double single_rounding_m(const pbs::Positions& positions)
{
    return rounding_error_in<float>(1, (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).maxCoeff());
}

// The rounding of coordinates that go through so many roundings in double.
inline double coordinate_rounding_m(const pbs::Positions& positions, double roundings)
{
    return rounding_error_in<double>(roundings, positions.cwiseAbs().maxCoeff());
}

}  // namespace test_support
