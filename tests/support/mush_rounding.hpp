// The rounding error of delta mush in float or double, for tolerances.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/delta_mush.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

namespace test_support {

// The limb with one more vertex, which no tet uses and the forearm alone moves.
inline TwoBoneLimb with_loose_vertex(TwoBoneLimb limb)
{
    const Eigen::Index last = limb.mesh.rest.rows();
    limb.mesh.rest.conservativeResize(last + 1, 3);
    limb.mesh.rest.row(last) << 0.9, 0.5, 0.25;
    limb.weights.first.push_back(limb.weights.first.back() + 1);
    limb.weights.bone.push_back(1);
    limb.weights.weight.push_back(1.0);
    pbs::linear_blend_skinning(limb.mesh.rest, limb.weights, limb.pose, limb.lbs);
    return limb;
}

// Mean positions of the neighbours, again and again, half-way: the default step.
inline pbs::Positions halfway_smoothed(const pbs::Adjacency& neighbours, pbs::Positions positions, int iterations)
{
    for (int iteration = 0; iteration < iterations; ++iteration) {
        const pbs::Positions last = positions;
        for (int i = 0; i < last.rows(); ++i) {
            const int count = neighbours.first[i + 1] - neighbours.first[i];
            positions.row(i) *= 0.5;
            for (int k = neighbours.first[i]; k < neighbours.first[i + 1]; ++k)
                positions.row(i) += 0.5 / count * last.row(neighbours.neighbour[k]);
        }
    }
    return positions;
}

// s_2 + sign(det) s_3 of a covariance, by how much its rotation stands out.
inline double rotation_gap(const Eigen::Matrix3d& covariance)
{
    const pbs::Vec3 s = Eigen::JacobiSVD<Eigen::Matrix3d>(covariance).singularValues();
    return s(1) + std::copysign(s(2), covariance.determinant());
}

// How far rounding may move a mushed position [m] of coordinates up to `farthest`, with the default step.
//   Smoothing: each mean of n neighbours goes through n + 4 roundings, and means do not amplify those before. Without a motion, the blend
//   and the rest shape are smoothed in the same roundings.
//   Rotation: the covariance is a sum of n products of smoothed edges, whose ends are in error by smoothing on both sides, and its
//   decomposition rounds some 30 times. An error E of the covariance turns its rotation by at most 2 |E| / (s2 + s3), with s2 and s3 its
//   smaller singular values, the last with the sign of its determinant (C. Kenney, A. J. Laub, SIAM J. Matrix Anal. Appl. 12, 1991), which
//   moves the vertex by that share of its detail. Sum: the detail, its rotated coordinates and their sum go through six roundings.
template <class Scalar>
double mush_error(const pbs::TetMesh& mesh, const pbs::Positions& blended, bool moved, double farthest,
                  int iterations = pbs::DeltaMushOptions().iterations)
{
    const pbs::Adjacency neighbours = pbs::adjacency_of(mesh.tets, static_cast<int>(mesh.rest.rows()));
    const auto count = [&](int i) { return neighbours.first[i + 1] - neighbours.first[i]; };
    const pbs::Positions rest = halfway_smoothed(neighbours, mesh.rest, iterations),
                         posed = halfway_smoothed(neighbours, blended, iterations);
    int most = 0;
    for (int i = 0; i < rest.rows(); ++i) most = std::max(most, count(i));
    const double of_smoothing = moved ? std::sqrt(3.0) * rounding_error_in<Scalar>(iterations * (most + 4), farthest) : 0.0;
    double largest = 0.0;
    for (int i = 0; i < rest.rows(); ++i) {
        Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
        double magnitude = 0.0, lengths = 0.0;
        for (int k = neighbours.first[i]; k < neighbours.first[i + 1]; ++k) {
            const int j = neighbours.neighbour[k];
            const Eigen::RowVector3d to = posed.row(j) - posed.row(i), from = rest.row(j) - rest.row(i);
            covariance += to.transpose() * from;
            magnitude += to.norm() * from.norm();
            lengths += to.norm() + from.norm();
        }
        const double of_covariance = rounding_error_in<Scalar>(count(i) + 3 + 30, magnitude) + 2.0 * of_smoothing * lengths;
        const double of_rotation = 2.0 * of_covariance / rotation_gap(covariance);
        largest = std::max(largest, of_rotation * (mesh.rest.row(i) - rest.row(i)).norm());
    }
    return largest + of_smoothing + std::sqrt(3.0) * rounding_error_in<Scalar>(6, farthest);
}

}  // namespace test_support
