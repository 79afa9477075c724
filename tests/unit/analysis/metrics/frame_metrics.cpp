// Reference: closed forms on maps with known results. Tolerances: the roundings of volumes, lengths and sums. Where
// coordinates are small multiples of powers of two, a volume is rounded once, by its division by 6, and so are its
// multiples.

#include "analysis/metrics/frame_metrics.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

namespace frame_metrics_tests {
namespace {

using analysis::FrameMetrics;
using analysis::MeshMetrics;
using pbs::Positions;
using test_support::rounding_error;
using test_support::two_tets;
using test_support::unit_tet;

// Cells of 0.25 x 0.15 x 0.15.
const pbs::TetMesh flat_bar = test_support::structured_bar({-1.0, -0.15, -0.15}, {1.0, 0.15, 0.15}, {8, 2, 2});

FrameMetrics measured(const pbs::TetMesh& mesh, const Eigen::Matrix3d& map)
{
    return MeshMetrics(mesh.rest, mesh.tets).measure(Positions(mesh.rest * map.transpose()));
}

// A coordinate of at most s is rounded once by the map, over a cell of at least 0.15 s: 2 / 0.15 = 14 roundings of an
// edge and 40 of a volume. A volume goes through ten of products of three edges, of at most five times its own size; a
// ratio contains two volumes. At rest and mirrored nothing is rounded but the changes in percent, by a product and a
// quotient.
TEST(FrameMetrics, OfAScaledOrMirroredBar)
{
    for (const double s : {1.0, 0.5, 0.9, 1.01, 3.0, -1.0}) {
        SCOPED_TRACE(s);
        const bool exact = std::abs(s) == 1.0;
        const FrameMetrics metrics =
            measured(flat_bar, exact ? Eigen::Matrix3d(Eigen::Vector3d(s, 1.0, 1.0).asDiagonal())
                                     : Eigen::Matrix3d(s * Eigen::Matrix3d::Identity()));
        const double j = s * s * s, of_ratio = exact ? 0.0 : rounding_error(40 + 2 * 5 * 10, j);
        const double of_change = of_ratio + rounding_error(exact ? 2 : 4, exact ? std::abs(j - 1.0) : 1.0 + j);
        EXPECT_NEAR(metrics.volume_change_pct, 100.0 * (j - 1.0), 100.0 * of_change);
        EXPECT_NEAR(metrics.volume_abs_change_pct, 100.0 * std::abs(j - 1.0), 100.0 * of_change);
        EXPECT_EQ(metrics.inverted_tets, s < 0.0 ? flat_bar.tets.rows() : 0);
        EXPECT_NEAR(metrics.j_min, j, of_ratio);
        EXPECT_NEAR(metrics.mean_abs_j_minus_1, std::abs(j - 1.0), of_change);
        EXPECT_NEAR(metrics.stretch_rms, exact ? 0.0 : std::abs(s - 1.0),
                    exact ? 0.0 : rounding_error(14 + 2 * 5, s) + rounding_error(4, 1.0 + s));
    }
}

// x += g y on the corner tet: only the edges that touch (0,1,0) change, (0,1,0)-(0,0,0) to sqrt(1+g^2), (0,1,0)-(1,0,0)
// to sqrt((1-g)^2+1), (0,1,0)-(0,0,1) to sqrt(g^2+2).
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

TEST(FrameMetrics, MeanOfVolumeRatiosIsWeightedByRestVolumeAndBindRmsIsThatOfResiduals)
{
    const auto mesh = two_tets(3.0);  // rest volumes 1/6 and 3/6
    Positions frame = mesh.rest;
    frame(3, 2) = 0.5;  // J = 1/2 in the small one
    const MeshMetrics mesh_metrics(mesh.rest, mesh.tets);
    EXPECT_NEAR(mesh_metrics.measure(frame).mean_abs_j_minus_1, 0.25 * 0.5,
                rounding_error(4, 0.25 * 0.5));  // volumes, their sum, a quotient
    EXPECT_EQ(mesh_metrics.volume_ratios(frame)(0), 0.5);
    EXPECT_EQ(mesh_metrics.volume_ratios(frame)(1), 1.0);
    const Positions points{{3, 4, 0}, {0, 0, 2}}, bones = Positions::Zero(2, 3);
    EXPECT_EQ(analysis::bind_rms(points, bones, Eigen::Vector2d(5.0, 1.0)), std::sqrt(0.5));
    EXPECT_EQ(analysis::bind_rms(Positions(0, 3), Positions(0, 3), Eigen::VectorXd(0)), 0.0);
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
        frame = mesh.rest;
        frame.row(vertex).setZero();
        EXPECT_EQ(MeshMetrics(mesh.rest, mesh.tets).measure(frame).inverted_tets, 1) << "a flat tet counts as inverted";
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

// Reference: theory. A stretch by s along x lengthens edges along x by s and does not change those perpendicular to it.
TEST(EdgeStrain, IsOfTheEdgeStretchedOrPressedMostAndTheMedianIsTheUnitsFactor)
{
    const auto corner = [](double x) { return Positions{{0, 0, 0}, {x, 0, 0}, {0, 1, 0}}; };
    const pbs::Edges edges{{0, 1}, {0, 2}};
    for (const auto& [x, strain] : {std::pair(1.25, 0.25), {0.5, 0.5}, {1.0, 0.0}})
        EXPECT_EQ(analysis::largest_edge_strain(corner(1.0), edges, corner(x)), strain);
    EXPECT_TRUE(std::isnan(analysis::largest_edge_strain(corner(1.0), edges, corner(std::nan("")))));
    EXPECT_THROW(analysis::largest_edge_strain(corner(1.0), edges, Positions(2, 3)), pbs::InputError);
    EXPECT_EQ(analysis::median_edge_ratio(corner(1.0), edges, 1000.0 * corner(1.0)), 1000.0);
    EXPECT_EQ(analysis::median_edge_ratio(corner(1.0), pbs::Edges(0, 2), corner(2.0)), 1.0);
}

// Reference: volumes of stretched unit cubes by hand; regions that cover all tets add up to the whole volume.
// Tolerances: a volume is rounded once, by its division by 6, and then there are the differences and sums over the tets
// of a region.

const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {2, 1, 1});

// Region 0 is left of x = 1, region 1 right of it.
const std::vector<int> halves = {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1};

TEST(RegionVolume, OnlyTheStretchedHalfGrows)
{
    pbs::Positions stretched = bar.rest;
    for (Eigen::Index i = 0; i < stretched.rows(); ++i) stretched(i, 0) += 0.5 * std::max(0.0, bar.rest(i, 0) - 1.0);
    const auto changes = analysis::RegionMetrics(bar.rest, bar.tets, halves).measure(stretched);
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
    const auto changes = analysis::RegionMetrics(bar.rest, bar.tets, halves).measure(mirrored);
    EXPECT_NEAR(changes[0].change_m3, -2.0, rounding_error(2 + 6, 2.0));
    EXPECT_NEAR(changes[0].abs_change_m3, 2.0, rounding_error(2 + 6, 2.0));
    pbs::Positions moved = bar.rest;
    for (Eigen::Index i = 0; i < moved.rows(); ++i)
        if (bar.rest(i, 0) == 1.0) moved(i, 0) = 1.25;
    const auto both = analysis::RegionMetrics(bar.rest, bar.tets, std::vector<int>(bar.tets.rows(), 0)).measure(moved);
    EXPECT_NEAR(both[0].change_m3, 0.0, rounding_error(2 + 12, 2.0 + 2.0));
    EXPECT_NEAR(both[0].abs_change_m3, 0.5, rounding_error(2 + 12, 2.0 + 2.0));
}

TEST(RegionVolume, RegionsAddUpToTheWholeAndNoneIsLeftOut)
{
    pbs::Positions bent = bar.rest;
    for (Eigen::Index i = 0; i < bent.rows(); ++i) bent(i, 2) += 0.3 * bar.rest(i, 0) * bar.rest(i, 1);
    const auto changes = analysis::RegionMetrics(bar.rest, bar.tets, halves).measure(bent);
    const double whole = pbs::tet_volumes(bent, bar.tets).sum() - pbs::tet_volumes(bar.rest, bar.tets).sum();
    // the same volumes twice
    EXPECT_NEAR(changes[0].change_m3 + changes[1].change_m3, whole, 2.0 * rounding_error(2 + 12, 2.0 + 2.0));
    const std::vector<int> none(bar.tets.rows(), -1);
    EXPECT_TRUE(analysis::RegionMetrics(bar.rest, bar.tets, none).measure(bent).empty());
    EXPECT_THROW(analysis::RegionMetrics(bar.rest, bar.tets, {0, 1}), pbs::InputError) << "regions of another mesh";
    EXPECT_NEAR(analysis::RegionMetrics(bar.rest, bar.tets, none).rest_volume_m3(), 2.0, rounding_error(1 + 12, 2.0));
}

// Reference: 4/3 for the octahedron, the tets inside a boundary, and s^3. Tolerances: the roundings of volumes. Each
// volume between an octahedron's triangle and one of its vertices is rounded once, by its division by 6; the sum is
// compensated.

using analysis::enclosed_volume;
using pbs::Triangles;

const Positions points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
const Triangles triangles{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};

TEST(SurfaceVolume, OfAnOctahedronEvenFarFromTheOriginAndOfOneInsideOut)
{
    EXPECT_NEAR(enclosed_volume(points, triangles), 4.0 / 3.0, rounding_error(3, 4.0 / 3.0));
    const Positions far = points.rowwise() + Eigen::RowVector3d(1e8, -1e8, 1e8);
    EXPECT_EQ(enclosed_volume(far, triangles), enclosed_volume(points, triangles));
    const Triangles inward = triangles.rowwise().reverse();
    EXPECT_NEAR(enclosed_volume(points, inward), -4.0 / 3.0, rounding_error(3, 4.0 / 3.0));
    EXPECT_THROW(analysis::surface_volume_change_pct(points, points, inward), pbs::InputError);
    // 1.1 is rounded, three times as a factor; its products, the volumes and their ratio go through ten more roundings.
    EXPECT_NEAR(analysis::surface_volume_change_pct(points, 1.1 * points, triangles), 33.1,
                rounding_error(3 + 10, 133.1));
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

TEST(SurfaceVolume, RefusesSurfacesThatAreNotClosed)
{
    Triangles flipped = triangles, out_of_range = triangles;
    std::swap(flipped(3, 0), flipped(3, 1));
    out_of_range(0, 0) = 6;
    for (const Triangles& bad : {Triangles(triangles.topRows(7)), flipped, out_of_range, Triangles(0, 3)})
        EXPECT_THROW(enclosed_volume(points, bad), pbs::InputError);
    EXPECT_THROW(analysis::surface_volume_change_pct(points, points.topRows(5), triangles), pbs::InputError);
}

}  // namespace
}  // namespace frame_metrics_tests
