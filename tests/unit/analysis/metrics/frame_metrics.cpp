// Reference: closed forms on maps with known results. Tolerances: the roundings of volumes, lengths and sums. Where coordinates are small
// multiples of powers of two, a volume is rounded once, by its division by 6, and so are its multiples.

#include "analysis/metrics/frame_metrics.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/unit_tet.hpp"
#include "tests/support/volume_rounding.hpp"

#include <gtest/gtest.h>

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

// Reference: theory. A stretch by s along x lengthens edges along x by s and does not change those perpendicular to it.
using analysis::largest_edge_strain;
using analysis::median_edge_ratio;

namespace {

pbs::Positions corner(double x)
{
    pbs::Positions points(3, 3);
    points << 0, 0, 0, x, 0, 0, 0, 1, 0;
    return points;
}

pbs::Edges two_edges()
{
    pbs::Edges edges(2, 2);
    edges << 0, 1, 0, 2;
    return edges;
}

}  // namespace

TEST(EdgeStrain, TheEdgeStretchedOrPressedMost)
{
    EXPECT_EQ(largest_edge_strain(corner(1.0), two_edges(), corner(1.25)), 0.25);
    EXPECT_EQ(largest_edge_strain(corner(1.0), two_edges(), corner(0.5)), 0.5);
    EXPECT_EQ(largest_edge_strain(corner(1.0), two_edges(), corner(1.0)), 0.0);
}

TEST(EdgeStrain, NotANumberStays)
{
    EXPECT_TRUE(std::isnan(largest_edge_strain(corner(1.0), two_edges(), corner(std::numeric_limits<double>::quiet_NaN()))));
}

TEST(EdgeStrain, TheMedianIsTheUnitsFactor)
{
    EXPECT_EQ(median_edge_ratio(corner(1.0), two_edges(), 1000.0 * corner(1.0)), 1000.0);
    EXPECT_EQ(median_edge_ratio(corner(1.0), pbs::Edges(0, 2), corner(2.0)), 1.0);
}

TEST(EdgeStrain, AnotherNumberOfPointsIsRefused)
{
    EXPECT_THROW(largest_edge_strain(corner(1.0), two_edges(), pbs::Positions(2, 3)), pbs::InputError);
}

// Reference: volumes of stretched unit cubes by hand; regions that cover all tets add up to the whole volume. Tolerances: a volume is
// rounded once, by its division by 6, and then there are the differences and sums over the tets of a region.

namespace {

using namespace analysis;

const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {2, 1, 1});

// Region 0 is left of x = 1, region 1 right of it.
std::vector<int> halves()
{
    std::vector<int> region;
    for (Eigen::Index t = 0; t < bar.tets.rows(); ++t) {
        double x = 0.0;
        for (const int vertex : bar.tets.row(t)) x += bar.rest(vertex, 0) / 4.0;
        region.push_back(x < 1.0 ? 0 : 1);
    }
    return region;
}

TEST(RegionVolume, OnlyTheStretchedHalfGrows)
{
    pbs::Positions stretched = bar.rest;
    for (Eigen::Index i = 0; i < stretched.rows(); ++i) stretched(i, 0) += 0.5 * std::max(0.0, bar.rest(i, 0) - 1.0);
    const auto changes = RegionMetrics(bar.rest, bar.tets, halves()).measure(stretched);
    ASSERT_EQ(changes.size(), 2u);
    const double of_change = rounding_error(2 + 6, 1.5 + 1.0);
    EXPECT_EQ(changes[0].change_m3, 0.0);
    EXPECT_NEAR(changes[1].change_m3, 0.5, of_change);
    EXPECT_NEAR(changes[1].abs_change_m3, 0.5, of_change);
    EXPECT_NEAR(changes[1].rest_m3, 1.0, rounding_error(1 + 6, 1.0));
}

TEST(RegionVolume, InsideOutIsTwiceTheVolumeAndSignsDoNotCancelInTheAbsolute)
{
    pbs::Positions mirrored = bar.rest;
    mirrored.col(1) *= -1.0;
    const auto changes = RegionMetrics(bar.rest, bar.tets, halves()).measure(mirrored);
    EXPECT_NEAR(changes[0].change_m3, -2.0, rounding_error(2 + 6, 2.0));
    EXPECT_NEAR(changes[0].abs_change_m3, 2.0, rounding_error(2 + 6, 2.0));
    pbs::Positions moved = bar.rest;
    for (Eigen::Index i = 0; i < moved.rows(); ++i)
        if (bar.rest(i, 0) == 1.0) moved(i, 0) = 1.25;
    const auto both = RegionMetrics(bar.rest, bar.tets, std::vector<int>(bar.tets.rows(), 0)).measure(moved);
    EXPECT_NEAR(both[0].change_m3, 0.0, rounding_error(2 + 12, 2.0 + 2.0));
    EXPECT_NEAR(both[0].abs_change_m3, 0.5, rounding_error(2 + 12, 2.0 + 2.0));
}

TEST(RegionVolume, RegionsAddUpToTheWholeAndNoneIsLeftOut)
{
    pbs::Positions bent = bar.rest;
    for (Eigen::Index i = 0; i < bent.rows(); ++i) bent(i, 2) += 0.3 * bar.rest(i, 0) * bar.rest(i, 1);
    const auto changes = RegionMetrics(bar.rest, bar.tets, halves()).measure(bent);
    const double whole = pbs::tet_volumes(bent, bar.tets).sum() - pbs::tet_volumes(bar.rest, bar.tets).sum();
    EXPECT_NEAR(changes[0].change_m3 + changes[1].change_m3, whole, 2.0 * rounding_error(2 + 12, 2.0 + 2.0));  // the same volumes twice
    const std::vector<int> none(bar.tets.rows(), -1);
    EXPECT_TRUE(RegionMetrics(bar.rest, bar.tets, none).measure(bent).empty());
    EXPECT_NEAR(RegionMetrics(bar.rest, bar.tets, none).rest_volume_m3(), 2.0, rounding_error(1 + 12, 2.0));
}

TEST(RegionVolume, RefusesRegionsOfAnotherMesh)
{
    EXPECT_THROW(RegionMetrics(bar.rest, bar.tets, {0, 1}), pbs::InputError);
}

// Reference: 4/3 for the octahedron, the tets inside a boundary, and s^3. Tolerances: the roundings of volumes. Each volume between an
// octahedron's triangle and one of its vertices is rounded once, by its division by 6; the sum is compensated.

using analysis::enclosed_volume;
using pbs::Triangles;

Positions octahedron_points()
{
    Positions points(6, 3);
    points << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
    return points;
}

Triangles octahedron_triangles()
{
    Triangles triangles(8, 3);
    triangles << 0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5;
    return triangles;
}

TEST(SurfaceVolume, OfAnOctahedron)
{
    EXPECT_NEAR(enclosed_volume(octahedron_points(), octahedron_triangles()), 4.0 / 3.0, rounding_error(3, 4.0 / 3.0));
}

TEST(SurfaceVolume, FarFromTheOriginLosesNoDigits)
{
    const Positions far = octahedron_points().rowwise() + Eigen::RowVector3d(1e8, -1e8, 1e8);
    EXPECT_EQ(enclosed_volume(far, octahedron_triangles()), enclosed_volume(octahedron_points(), octahedron_triangles()));
}

TEST(SurfaceVolume, InsideOutIsNegative)
{
    const Triangles inward = octahedron_triangles().rowwise().reverse();
    EXPECT_NEAR(enclosed_volume(octahedron_points(), inward), -4.0 / 3.0, rounding_error(3, 4.0 / 3.0));
    EXPECT_THROW(analysis::surface_volume_change_pct(octahedron_points(), octahedron_points(), inward), pbs::InputError);
}

TEST(SurfaceVolume, OfABoundaryIsThatOfTheTetsInside)
{
    const auto bar = test_support::structured_bar({-1.0, -0.15, -0.15}, {1.0, 0.15, 0.15}, {6, 2, 2});
    Positions bent = bar.rest;
    bent.col(2).array() += 0.3 * bent.col(0).array().square();
    const Triangles skin = pbs::boundary_of(bar.tets);
    pbs::Tets between(skin.rows(), 4);  // the triangles and one vertex
    between << Eigen::VectorXi::Constant(skin.rows(), skin(0, 0)), skin;
    EXPECT_NEAR(enclosed_volume(bent, skin), pbs::tet_volumes(bent, bar.tets).sum(),
                test_support::volume_error(bent, bar.tets) + test_support::volume_error(bent, between));
}

TEST(SurfaceVolume, ChangeOfAScaledSurface)
{
    const Positions rest = octahedron_points();
    // 1.1 is rounded, three times as a factor; its products, the volumes and their ratio go through ten more roundings.
    EXPECT_NEAR(analysis::surface_volume_change_pct(rest, 1.1 * rest, octahedron_triangles()), 33.1, rounding_error(3 + 10, 133.1));
}

TEST(SurfaceVolume, RefusesSurfacesThatAreNotClosed)
{
    const Positions points = octahedron_points();
    Triangles flipped = octahedron_triangles();
    std::swap(flipped(3, 0), flipped(3, 1));
    Triangles out_of_range = octahedron_triangles();
    out_of_range(0, 0) = 6;
    EXPECT_THROW(enclosed_volume(points, octahedron_triangles().topRows(7)), pbs::InputError);
    EXPECT_THROW(enclosed_volume(points, flipped), pbs::InputError);
    EXPECT_THROW(enclosed_volume(points, out_of_range), pbs::InputError);
    EXPECT_THROW(enclosed_volume(points, Triangles(0, 3)), pbs::InputError);
    EXPECT_THROW(analysis::surface_volume_change_pct(points, points.topRows(5), octahedron_triangles()), pbs::InputError);
}

}  // namespace
