// Refinement depends neither on the orientation of a body nor on its numbering, and children are never much worse than
// their parents. Reference: the body is the same; with the shortest diagonal, a child's mean ratio is at least 3/4 of
// its parent's (tet_mesh.hpp).
#include "pbs/geometry/tet_mesh.hpp"

#include "pbs/geometry/topology.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace {

using pbs::TetMesh;

// A bar in which no two diagonals of an octahedron are equally long.
TetMesh jittered_bar()
{
    TetMesh bar = test_support::structured_bar({-1, -0.15, -0.15}, {1, 0.15, 0.15}, {6, 2, 2});
    test_support::RandomPoints random(5);
    for (Eigen::Index v = 0; v < bar.rest.rows(); ++v) bar.rest.row(v) += random.point(0.01).transpose();
    return bar;
}

// 1 for a regular tet, 0 for a flat one.
double mean_ratio(const TetMesh& mesh, Eigen::Index t)
{
    double squares = 0.0;
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < a; ++b)
            squares += (mesh.rest.row(mesh.tets(t, a)) - mesh.rest.row(mesh.tets(t, b))).squaredNorm();
    const double volume = pbs::tet_volume(mesh.rest.row(mesh.tets(t, 0)), mesh.rest.row(mesh.tets(t, 1)),
                                          mesh.rest.row(mesh.tets(t, 2)), mesh.rest.row(mesh.tets(t, 3)));
    return 12.0 * std::cbrt(9.0 * volume * volume) / squares;
}

// The relative rounding error of the mean ratio of the flattest tet: that of its volume, of ten roundings and twelve of
// midpoints with coordinates up to twice as long as edges, to the power 2/3, and some twenty of the other operations.
double mean_ratio_error(const TetMesh& mesh)
{
    const double edge_m = pbs::quality_of(mesh).longest_edge_m,
                 magnitude_m3 = 2.0 / std::sqrt(3.0) * std::pow(edge_m, 3) / 6.0;
    const double smallest_m3 = pbs::tet_volumes(mesh.rest, mesh.tets).cwiseAbs().minCoeff();
    return 2.0 / 3.0 * test_support::rounding_error(10 + 12, magnitude_m3 / smallest_m3) +
           test_support::rounding_error(20, 1.0);
}

double worst_mean_ratio(const TetMesh& mesh)
{
    double worst = 1.0;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) worst = std::min(worst, mean_ratio(mesh, t));
    return worst;
}

TEST(RefinementInvariance, RigidMotion)
{
    const TetMesh bar = jittered_bar();
    const Eigen::Isometry3d motion = test_support::RandomPoints(3).rigid_motion(10.0);
    const TetMesh fine = pbs::refine(bar).mesh,
                  moved = pbs::refine({test_support::transformed(bar.rest, motion), bar.tets}).mesh;
    EXPECT_EQ(moved.tets, fine.tets);
    // Both sides round a product with a row of the rotation and a midpoint, in five roundings of coordinates up to 10 m
    // and the bar's 1.1 m.
    EXPECT_LT((moved.rest - test_support::transformed(fine.rest, motion)).cwiseAbs().maxCoeff(),
              test_support::rounding_error(2 * 5, 11.1));
}

TEST(RefinementInvariance, OrderOfVerticesTetsAndCorners)
{
    using Corner = std::array<double, 3>;
    const auto as_set = [](const TetMesh& mesh) {
        std::set<std::set<Corner>> tets;
        for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
            std::set<Corner> corners;
            for (const int v : mesh.tets.row(t)) corners.insert({mesh.rest(v, 0), mesh.rest(v, 1), mesh.rest(v, 2)});
            tets.insert(corners);
        }
        return tets;
    };
    const TetMesh bar = jittered_bar();
    std::vector<int> place(bar.rest.rows());
    std::iota(place.begin(), place.end(), 0);
    std::shuffle(place.begin(), place.end(), std::mt19937(11));
    TetMesh shuffled = bar;
    for (std::size_t v = 0; v < place.size(); ++v) shuffled.rest.row(place[v]) = bar.rest.row(v);
    for (Eigen::Index t = 0; t < bar.tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner)  // an even permutation of the corners
            shuffled.tets(bar.tets.rows() - 1 - t, corner) = place[bar.tets(t, corner < 3 ? (corner + 1) % 3 : 3)];
    EXPECT_EQ(as_set(pbs::refine(shuffled).mesh), as_set(pbs::refine(bar).mesh));
}

TEST(RefinementQuality, OfAJitteredBarIsBoundedOverThreeRefinements)
{
    TetMesh mesh = jittered_bar();
    const pbs::Quality coarse = pbs::quality_of(mesh);
    const double worst = worst_mean_ratio(mesh);
    for (int level = 1; level <= 3; ++level) {
        mesh = pbs::refine(mesh).mesh;
        EXPECT_GE(worst_mean_ratio(mesh), 0.75 * worst);
        EXPECT_GT(pbs::tet_volumes(mesh.rest, mesh.tets).minCoeff(), 0.0);
    }
    const pbs::Quality fine = pbs::quality_of(mesh);
    const TetMesh bar = jittered_bar();
    EXPECT_NEAR(fine.volume_m3, coarse.volume_m3,
                test_support::volume_error(mesh.rest, mesh.tets) + test_support::volume_error(bar.rest, bar.tets));
    EXPECT_TRUE(fine.topology.boundary_manifold);
    EXPECT_EQ(fine.topology.boundary_euler, 2);
    // an edge or a diagonal
    EXPECT_NEAR(fine.longest_edge_m, coarse.longest_edge_m / 8.0, 0.25 * coarse.longest_edge_m / 8.0);
}

// Flat tets, needles and slivers: the worst child arises in the first or second refinement, and none falls below 3/4.
TEST(RefinementQuality, OfRandomTetsIsBoundedOverThreeRefinements)
{
    test_support::RandomPoints random(2);
    for (int sample = 0; sample < 200; ++sample) {
        TetMesh mesh{pbs::Positions(4, 3), pbs::Tets(1, 4)};
        const pbs::Vec3 extent(1.0, sample % 3 == 0 ? 0.1 : 1.0, sample % 3 == 1 ? 0.1 : 1.0);
        for (int v = 0; v < 4; ++v) mesh.rest.row(v) = random.point(1.0).cwiseProduct(extent);
        mesh.tets << 0, 1, 2, 3;
        const double whole = mean_ratio(mesh, 0), of_whole = mean_ratio_error(mesh);
        for (int level = 1; level <= 3; ++level) {
            mesh = pbs::refine(mesh).mesh;
            ASSERT_GE(worst_mean_ratio(mesh), 0.75 * whole * (1.0 - of_whole - mean_ratio_error(mesh)))
                << "sample " << sample << ", level " << level;
        }
    }
}

// Two diagonals of a Kuhn tet are equally long; with either of them, the children are no worse than 3/4.
TEST(RefinementQuality, OfAKuhnSplitBarIsBounded)
{
    TetMesh mesh = test_support::structured_bar({0, 0, 0}, {2, 2, 2}, {2, 2, 2});
    const double whole = worst_mean_ratio(mesh);
    for (int level = 1; level <= 3; ++level) {
        mesh = pbs::refine(mesh).mesh;
        EXPECT_GE(worst_mean_ratio(mesh), 0.75 * whole);
        // acos(sqrt(2/3)), for the children around the other diagonal
        EXPECT_GE(pbs::quality_of(mesh).min_dihedral_deg, 35.26);
    }
}

}  // namespace
