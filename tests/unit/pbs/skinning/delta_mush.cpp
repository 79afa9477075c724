// Reference: rigid motions, and the definition's limits. Tolerances: the rounding of means, and that of the polar decomposition by its
// condition.
#include "pbs/skinning/delta_mush.hpp"

#include "pbs/geometry/tet_volume.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using pbs::DeltaMush;
using pbs::Positions;
using pbs::Vec3;

const test_support::TwoBoneLimb bent = test_support::two_bone_limb({16, 4, 4}, Vec3::UnitZ(), 60.0);

Positions mushed(const Positions& blended, const pbs::DeltaMushOptions& options = {})
{
    Positions posed;
    DeltaMush(bent.mesh, options).apply(blended, posed);
    return posed;
}

const pbs::Adjacency neighbours = pbs::adjacency_of(bent.mesh.tets, static_cast<int>(bent.mesh.rest.rows()));

int neighbours_of(int vertex)
{
    return neighbours.first[vertex + 1] - neighbours.first[vertex];
}

// Mean positions of the neighbours, again and again, half-way: the default options.
Positions smoothed(Positions positions)
{
    for (int iteration = 0; iteration < pbs::DeltaMushOptions().iterations; ++iteration) {
        const Positions last = positions;
        for (int i = 0; i < last.rows(); ++i) {
            positions.row(i) *= 0.5;
            for (int k = neighbours.first[i]; k < neighbours.first[i + 1]; ++k)
                positions.row(i) += 0.5 / neighbours_of(i) * last.row(neighbours.neighbour[k]);
        }
    }
    return positions;
}

// How far rounding may move a mushed position [m] of coordinates up to `farthest`.
//   Smoothing: each mean of n neighbours goes through n + 4 roundings, and means do not amplify those before. Without a motion, the blend
//   and the rest shape are smoothed in the same roundings.
//   Rotation: the covariance is a sum of n products of smoothed edges, whose ends are in error by smoothing on both sides, and its
//   decomposition rounds some 30 times. An error E of the covariance turns its rotation by at most 2 |E| / (s2 + s3), with s2 and s3 its
//   smaller singular values (C. Kenney, A. J. Laub, SIAM J. Matrix Anal. Appl. 12, 1991), which moves the vertex by that share of its
//   detail. Sum: the detail, its rotated coordinates and their sum go through six roundings.
double mush_error(const Positions& blended, bool moved, double farthest)
{
    const Positions rest = smoothed(bent.mesh.rest), posed = smoothed(blended);
    int most = 0;
    for (int i = 0; i < rest.rows(); ++i) most = std::max(most, neighbours_of(i));
    const double of_smoothing =
        moved ? std::sqrt(3.0) * test_support::rounding_error(pbs::DeltaMushOptions().iterations * (most + 4), farthest) : 0.0;
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
        const Vec3 s = Eigen::JacobiSVD<Eigen::Matrix3d>(covariance).singularValues();
        const double of_covariance = test_support::rounding_error(neighbours_of(i) + 3 + 30, magnitude) + 2.0 * of_smoothing * lengths;
        const double of_rotation = 2.0 * of_covariance / (s(1) + s(2));
        largest = std::max(largest, of_rotation * (bent.mesh.rest.row(i) - rest.row(i)).norm());
    }
    return largest + of_smoothing + std::sqrt(3.0) * test_support::rounding_error(6, farthest);
}

TEST(DeltaMush, RestComesBack)
{
    EXPECT_LT((mushed(bent.mesh.rest) - bent.mesh.rest).cwiseAbs().maxCoeff(), mush_error(bent.mesh.rest, false, 1.0));
}

TEST(DeltaMush, TurnsWithARigidMotion)
{
    const Eigen::AngleAxisd turn(2.0, Vec3(1, 2, 3).normalized());
    const Vec3 moved(0.3, -0.2, 0.1);
    const auto place = [&](Positions positions) {
        for (auto row : positions.rowwise()) row = (turn * Vec3(row) + moved).transpose();
        return positions;
    };
    // Both sides of the second comparison are rounded, also by the motion, in some fifteen roundings.
    const double farthest = 1.1 + moved.norm(), of_motion = std::sqrt(3.0) * test_support::rounding_error(15, farthest);
    const double at_rest = mush_error(bent.mesh.rest, true, farthest) + of_motion,
                 blended = 2.0 * mush_error(bent.lbs, true, farthest) + of_motion;
    EXPECT_LT((mushed(place(bent.mesh.rest)) - place(bent.mesh.rest)).cwiseAbs().maxCoeff(), at_rest);
    EXPECT_LT((mushed(place(bent.lbs)) - place(mushed(bent.lbs))).cwiseAbs().maxCoeff(), blended);
    EXPECT_LT(at_rest + blended, 1e-9) << "a bound that would let a wrong rotation pass proves nothing";
}

TEST(DeltaMush, WithoutSmoothingItIsTheBlend)
{
    EXPECT_EQ(mushed(bent.lbs, {.iterations = 0}), bent.lbs);
    EXPECT_EQ(mushed(bent.lbs, {.iterations = 5, .step = 0.0}), bent.lbs);
}

// The bulge and the crease of a blend are its sharpest details: smoothing removes them, and the details that are restored are those of the
// rest shape.
TEST(DeltaMush, LosesLessOfEachTetThanTheBlend)
{
    const auto lost = [&](const Positions& positions) {
        return (pbs::tet_volumes(positions, bent.mesh.tets) - pbs::tet_volumes(bent.mesh.rest, bent.mesh.tets)).cwiseAbs().sum();
    };
    EXPECT_LT(lost(mushed(bent.lbs)), lost(bent.lbs));
}

TEST(DeltaMush, AVertexThatNoTetUsesFollowsTheBlend)
{
    pbs::TetMesh mesh = bent.mesh;
    mesh.rest.conservativeResize(mesh.rest.rows() + 1, 3);
    mesh.rest.bottomRows(1) << 5.0, 6.0, 7.0;
    Positions posed, blended = mesh.rest;
    blended.bottomRows(1) << 1.0, 2.0, 3.0;
    DeltaMush(mesh, {}).apply(blended, posed);
    EXPECT_EQ(posed.bottomRows(1), blended.bottomRows(1));
}

TEST(DeltaMush, NotANumberIsNoRotation)
{
    Positions blended = bent.lbs;
    blended(3, 0) = std::nan("");
    EXPECT_FALSE(mushed(blended).allFinite());
}

}  // namespace
