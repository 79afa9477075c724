// Reference: closed forms on maps with known results. Tolerances: the roundings of volumes, lengths and sums. Where coordinates are small
// multiples of powers of two, a volume is rounded once, by its division by 6, and so are its multiples.
#include "analysis/frame_metrics.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/unit_tet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using analysis::FrameMetrics;
using analysis::MeshMetrics;
using pbs::Positions;
using test_support::rounding_error;
using test_support::unit_tet;

// Two tets on the triangle 0 1 2, of rest volume 1/6 each.
pbs::TetMesh two_tets()
{
    pbs::TetMesh mesh;
    mesh.rest.resize(5, 3);
    mesh.rest << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1;
    mesh.tets.resize(2, 4);
    mesh.tets << 0, 1, 2, 3, 0, 2, 1, 4;
    return mesh;
}

FrameMetrics measured(const pbs::TetMesh& mesh, const Eigen::Matrix3d& map)
{
    return MeshMetrics(mesh.rest, mesh.tets).measure(Positions(mesh.rest * map.transpose()));
}

TEST(FrameMetrics, RestMeasuresNothing)
{
    const auto mesh = test_support::structured_bar({-1.0, -0.15, -0.15}, {1.0, 0.15, 0.15}, {8, 2, 2});
    const FrameMetrics metrics = measured(mesh, Eigen::Matrix3d::Identity());
    EXPECT_EQ(metrics.volume_change_pct, 0.0);
    EXPECT_EQ(metrics.volume_abs_change_pct, 0.0);
    EXPECT_EQ(metrics.inverted_tets, 0);
    EXPECT_EQ(metrics.mean_abs_j_minus_1, 0.0);
    EXPECT_EQ(metrics.j_min, 1.0);
    EXPECT_EQ(metrics.stretch_rms, 0.0);
}

// A coordinate of at most s is rounded once by the map, over a cell of at least 0.15 s: 2 / 0.15 = 14 roundings of an edge and 40 of a
// volume. A volume goes through ten of products of three edges, of at most five times its own size; a ratio contains two volumes.
TEST(FrameMetrics, UniformScaleChangesVolumeByItsCube)
{
    const auto mesh = test_support::structured_bar({-1.0, -0.15, -0.15}, {1.0, 0.15, 0.15}, {8, 2, 2});
    for (double s : {0.5, 0.9, 1.01, 3.0}) {
        const FrameMetrics metrics = measured(mesh, s * Eigen::Matrix3d::Identity());
        const double cube = s * s * s;
        const double of_ratio = rounding_error(40 + 2 * 5 * 10, cube), of_change = of_ratio + rounding_error(4, 1.0 + cube);
        EXPECT_NEAR(metrics.volume_change_pct, 100.0 * (cube - 1.0), 100.0 * of_change);
        EXPECT_NEAR(metrics.volume_abs_change_pct, 100.0 * std::abs(cube - 1.0), 100.0 * of_change);
        EXPECT_NEAR(metrics.j_min, cube, of_ratio);
        EXPECT_NEAR(metrics.mean_abs_j_minus_1, std::abs(cube - 1.0), of_change);
        EXPECT_NEAR(metrics.stretch_rms, std::abs(s - 1.0), rounding_error(14 + 2 * 5, s) + rounding_error(4, 1.0 + s));
    }
}

// x += g y on the corner tet: only the edges that touch (0,1,0) change, (0,1,0)-(0,0,0) to sqrt(1+g^2), (0,1,0)-(1,0,0) to
// sqrt((1-g)^2+1), (0,1,0)-(0,0,1) to sqrt(g^2+2).
TEST(FrameMetrics, ShearKeepsVolumeAndStretchesByTheClosedForm)
{
    const double g = 0.7;
    Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
    shear(0, 1) = g;
    const FrameMetrics metrics = measured(unit_tet(), shear);
    const double a = std::sqrt(1.0 + g * g) - 1.0, b = std::sqrt(((1.0 - g) * (1.0 - g) + 1.0) / 2.0) - 1.0,
                 c = std::sqrt((g * g + 2.0) / 2.0) - 1.0;
    EXPECT_EQ(metrics.volume_change_pct, 0.0);
    EXPECT_EQ(metrics.volume_abs_change_pct, 0.0);
    // Lengths of at most 1.3 and their ratios go through eight roundings on both sides.
    EXPECT_NEAR(metrics.stretch_rms, std::sqrt((a * a + b * b + c * c) / 6.0), rounding_error(8 + 8, 1.3));
}

TEST(FrameMetrics, MirrorInvertsEveryTet)
{
    const auto mesh = test_support::structured_bar({-1.0, -0.15, -0.15}, {1.0, 0.15, 0.15}, {8, 2, 2});
    const FrameMetrics metrics = measured(mesh, Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal());
    EXPECT_NEAR(metrics.volume_change_pct, -200.0, rounding_error(2, 200.0));  // a product and a quotient
    EXPECT_NEAR(metrics.volume_abs_change_pct, 200.0, rounding_error(2, 200.0));
    EXPECT_EQ(metrics.inverted_tets, mesh.tets.rows());
    EXPECT_EQ(metrics.j_min, -1.0);
    EXPECT_EQ(metrics.stretch_rms, 0.0);
}

// Apices at heights -1 and -3 instead of 1 and -1: volumes -1/6 and 3/6, sum unchanged.
TEST(FrameMetrics, InvertedTetThatCancelsShowsInTheAbsoluteMeasure)
{
    const auto mesh = two_tets();
    Positions frame = mesh.rest;
    frame(3, 2) = -1.0;
    frame(4, 2) = -3.0;
    const FrameMetrics metrics = MeshMetrics(mesh.rest, mesh.tets).measure(frame);
    // Two differences of volumes of at most 1/2 and their sum, relative to a rest volume of 1/3.
    const double rounding_pct = 100.0 * rounding_error(6, 0.5) / (1.0 / 3.0);
    EXPECT_NEAR(metrics.volume_change_pct, 0.0, rounding_pct);
    EXPECT_NEAR(metrics.volume_abs_change_pct, 200.0, rounding_pct + rounding_error(2, 200.0));
    EXPECT_EQ(metrics.inverted_tets, 1);
    EXPECT_EQ(metrics.j_min, -1.0);
}

TEST(FrameMetrics, FlatTetCountsAsInverted)
{
    auto mesh = unit_tet();
    Positions frame = mesh.rest;
    frame.row(3).setZero();
    EXPECT_EQ(MeshMetrics(mesh.rest, mesh.tets).measure(frame).inverted_tets, 1);
}

TEST(FrameMetrics, MeanOfVolumeRatiosIsWeightedByRestVolume)
{
    auto mesh = two_tets();
    mesh.rest(4, 2) = -3.0;  // rest volumes 1/6 and 3/6
    Positions frame = mesh.rest;
    frame(3, 2) = 0.5;  // J = 1/2 in the small one
    const MeshMetrics mesh_metrics(mesh.rest, mesh.tets);
    EXPECT_NEAR(mesh_metrics.measure(frame).mean_abs_j_minus_1, 0.25 * 0.5,
                rounding_error(4, 0.25 * 0.5));  // volumes, their sum, a quotient
    EXPECT_EQ(mesh_metrics.volume_ratios(frame)(0), 0.5);
    EXPECT_EQ(mesh_metrics.volume_ratios(frame)(1), 1.0);
}

TEST(FrameMetrics, BrokenFrameIsMeasuredNotRefused)
{
    const auto mesh = two_tets();
    for (int vertex : {3, 4}) {
        Positions frame = mesh.rest;
        frame(vertex, 2) = std::numeric_limits<double>::quiet_NaN();
        const FrameMetrics metrics = MeshMetrics(mesh.rest, mesh.tets).measure(frame);
        EXPECT_EQ(metrics.inverted_tets, 1);
        EXPECT_TRUE(std::isnan(metrics.volume_change_pct));
        EXPECT_TRUE(std::isnan(metrics.j_min));
        EXPECT_TRUE(std::isnan(metrics.stretch_rms));
    }
}

TEST(FrameMetrics, RefusesWhatCannotBeMeasured)
{
    const auto mesh = unit_tet();
    EXPECT_THROW(MeshMetrics(mesh.rest, pbs::Tets(0, 4)), pbs::InputError);
    EXPECT_THROW(MeshMetrics(mesh.rest.topRows(3), mesh.tets), pbs::InputError);
    EXPECT_THROW(MeshMetrics(-mesh.rest, mesh.tets), pbs::InputError);
    EXPECT_THROW(MeshMetrics(mesh.rest, mesh.tets).measure(mesh.rest.topRows(3)), pbs::InputError);
}

TEST(BindRms, IsTheRootMeanSquareOfTheDistanceResiduals)
{
    Positions points(2, 3), bones = Positions::Zero(2, 3);
    points << 3, 4, 0, 0, 0, 2;
    EXPECT_EQ(analysis::bind_rms(points, bones, Eigen::Vector2d(5.0, 1.0)), std::sqrt(0.5));
    EXPECT_EQ(analysis::bind_rms(Positions(0, 3), Positions(0, 3), Eigen::VectorXd(0)), 0.0);
}

}  // namespace
