// Reference: volumes known in closed form.

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/closed_surfaces.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Dense>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace {

const pbs::Vec3 origin(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);

TEST(TetVolume, OfTheUnitCornerAndOfMirroredFlatAndCollapsedTetsScalesWithTheCube)
{
    EXPECT_DOUBLE_EQ(pbs::tet_volume(origin, x, y, z), 1.0 / 6.0);
    EXPECT_DOUBLE_EQ(pbs::tet_volume(origin, y, x, z), -1.0 / 6.0);
    EXPECT_EQ(pbs::tet_volume(origin, x, y, x + y), 0.0);
    EXPECT_EQ(pbs::tet_volume(x, x, x, x), 0.0);
    for (const double size : {1e-6, 1e-3, 1e3, 1e6})
        EXPECT_NEAR(pbs::tet_volume(origin, size * x, size * y, size * z) * 6.0 / (size * size * size), 1.0,
                    test_support::rounding_error(8, 1.0));
}

TEST(TetVolumes, AddUpToTheBar)
{
    const pbs::TetMesh bar = test_support::structured_bar({-1, -0.15, -0.15}, {1, 0.15, 0.15}, {10, 3, 3});
    const Eigen::VectorXd volumes = pbs::tet_volumes(bar.rest, bar.tets);
    EXPECT_EQ(volumes.size(), 6 * 10 * 3 * 3);
    EXPECT_GT(volumes.minCoeff(), 0.0);
    const double rounding_m3 = test_support::volume_error(bar.rest, bar.tets);
    EXPECT_NEAR(volumes.sum(), 0.18, rounding_m3);
    // Sums over at most 24 tets about a vertex, and over the vertices.
    const double of_sums = test_support::rounding_error(24.0 + static_cast<double>(bar.rest.rows()), 0.18);
    EXPECT_NEAR(pbs::lumped_volumes(bar.rest, bar.tets).sum(), 0.18, rounding_m3 + of_sums);
}

TEST(LumpedVolumes, AreAQuarterOfEachTetAround)
{
    pbs::TetMesh tet = test_support::unit_tet();
    tet.rest.conservativeResize(5, 3);
    tet.rest.row(4) << 9, 9, 9;
    const Eigen::VectorXd lumped = pbs::lumped_volumes(tet.rest, tet.tets);
    for (int corner = 0; corner < 4; ++corner) EXPECT_DOUBLE_EQ(lumped(corner), 1.0 / 24.0);
    EXPECT_EQ(lumped(4), 0.0);
}

// Reference: Heron's formula for the sides 3, 4 and 5, in which nothing is rounded.
TEST(TriangleAreas, AddUpAndBelongToTheirCorners)
{
    pbs::Positions points(5, 3);
    points << 0, 0, 0, 3, 0, 0, 0, 4, 0, 0, 0, 4, 9, 9, 9;
    pbs::Triangles triangles(2, 3);
    triangles << 0, 1, 2, 0, 3, 1;
    EXPECT_EQ(pbs::triangle_area(points.row(0), points.row(1), points.row(2)), 6.0);
    EXPECT_EQ(pbs::surface_area(points, triangles), 12.0);
    EXPECT_EQ(pbs::lumped_areas(points, triangles), (Eigen::VectorXd(5) << 4, 4, 2, 2, 0).finished());
}

// Reference: counts of red refinement (V + E vertices, 2E + 3F + T edges, 8T tets), Euler's formula, and the definition
// of a midpoint.

using pbs::Refinement;
using pbs::TetMesh;

TetMesh one_tet()
{
    return {pbs::Positions{{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}, {0.1, 0.3, 1}}, pbs::Tets{{0, 1, 2, 3}}};
}

// The smallest of the four determinants of a tet in which the point replaces a corner: not negative where the point
// lies in the tet. It is exact where all coordinates are small multiples of 1/4.
double smallest_determinant(const TetMesh& mesh, Eigen::Index tet, const pbs::Vec3& point)
{
    double smallest = std::numeric_limits<double>::infinity();
    for (int replaced = 0; replaced < 4; ++replaced) {
        std::array<pbs::Vec3, 4> p;
        for (int corner = 0; corner < 4; ++corner) p[corner] = mesh.rest.row(mesh.tets(tet, corner));
        p[replaced] = point;
        smallest = std::min(smallest, (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]));
    }
    return smallest;
}

// Each volume goes through ten roundings of products of edges, whose sum is bounded in
// tests/support/rounding_error.hpp. A midpoint is rounded once; its coordinates are at most twice as long as an edge of
// a child, which has two ends: twelve more for three edges.
TEST(Refinement, OfOneTetIsEightOfAnEighthOfItsVolume)
{
    const Refinement fine = pbs::refine(one_tet());
    ASSERT_EQ(fine.mesh.rest.rows(), 10);
    ASSERT_EQ(fine.mesh.tets.rows(), 8);
    const double volume = pbs::tet_volumes(one_tet().rest, one_tet().tets)(0);
    const Eigen::VectorXd volumes = pbs::tet_volumes(fine.mesh.rest, fine.mesh.tets);
    const double edge_m = pbs::quality_of(fine.mesh).longest_edge_m,
                 magnitude = 2.0 / std::sqrt(3.0) * std::pow(edge_m, 3) / 6.0;
    for (const double child : volumes)
        EXPECT_NEAR(child, volume / 8.0, test_support::rounding_error(10 + 10 + 12, magnitude));
}

TEST(Refinement, KeepsTheCoarseVerticesAndHalvesTheEdges)
{
    const TetMesh bar = test_support::structured_bar({-1, 0, 0}, {1, 1, 1}, {3, 2, 2});
    const Refinement fine = pbs::refine(bar);
    EXPECT_EQ(fine.mesh.rest.topRows(bar.rest.rows()), bar.rest);
    ASSERT_EQ(fine.mesh.rest.rows(), bar.rest.rows() + fine.parents.rows());
    EXPECT_EQ(fine.parents, pbs::edges_of(bar.tets));  // each once
    for (Eigen::Index e = 0; e < fine.parents.rows(); ++e)
        EXPECT_EQ(fine.mesh.rest.row(bar.rest.rows() + e),
                  0.5 * (bar.rest.row(fine.parents(e, 0)) + bar.rest.row(fine.parents(e, 1))));
}

TEST(Refinement, CountsAreThoseOfRedRefinement)
{
    const TetMesh bar = test_support::structured_bar({0, 0, 0}, {4, 3, 2}, {4, 3, 2});
    const pbs::Quality coarse = pbs::quality_of(bar), fine = pbs::quality_of(pbs::refine(bar).mesh);
    const int faces = (4 * coarse.tets + coarse.boundary_triangles) / 2;
    EXPECT_EQ(fine.vertices, coarse.vertices + coarse.edges);
    EXPECT_EQ(fine.tets, 8 * coarse.tets);
    EXPECT_EQ(fine.edges, 2 * coarse.edges + 3 * faces + coarse.tets);
    EXPECT_EQ(fine.boundary_triangles, 4 * coarse.boundary_triangles);  // neighbours agree on the faces between them
    // Coordinates are multiples of 1/2: only the division by 6 in three terms of each tet is rounded, their sum, and
    // the sum over tets.
    EXPECT_NEAR(fine.volume_m3, coarse.volume_m3, test_support::rounding_error(2 * 5 + fine.tets + coarse.tets, 24.0));
}

TEST(Refinement, ABodyWithAHandleKeepsIt)
{
    const auto all_but_the_middle = [](int i, int j, int) { return i != 1 || j != 1; };
    for (TetMesh mesh = test_support::carved_box({3, 3, 1}, all_but_the_middle); mesh.tets.rows() < 10000;
         mesh = pbs::refine(mesh).mesh) {
        const pbs::Topology topology = pbs::topology_of(mesh.tets, mesh.rest.rows());
        EXPECT_TRUE(topology.boundary_manifold);
        EXPECT_EQ(topology.boundary_euler, 0);
        EXPECT_EQ(topology.components, 1);
        EXPECT_EQ(topology.unused_vertices, 0);
    }
}

TEST(Refinement, ChildrenLieInTheirParentAndAtItsCorners)
{
    const TetMesh bar = test_support::structured_bar({0, 0, 0}, {1, 2, 3}, {2, 2, 2});
    const TetMesh fine = pbs::refine(bar).mesh;
    for (Eigen::Index t = 0; t < fine.tets.rows(); ++t) {
        for (const int v : fine.tets.row(t)) EXPECT_GE(smallest_determinant(bar, t / 8, fine.rest.row(v)), 0.0);
        if (const Eigen::Index child = t % 8; child < 4) {
            EXPECT_EQ(fine.tets(t, child), bar.tets(t / 8, child));
        }
    }
}

TEST(Refinement, CutsTheOctahedronAlongItsShortestDiagonal)
{
    // pairs of opposite edges of a box, so that the diagonals are its extents
    for (int longest = 0; longest < 3; ++longest) {
        const pbs::Vec3 extent = pbs::Vec3(longest == 0 ? 1 : 3, longest == 1 ? 1 : 3, longest == 2 ? 1 : 3);
        TetMesh mesh{pbs::Positions{{0, 0, 0}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}}, pbs::Tets{{0, 1, 2, 3}}};
        mesh.rest = mesh.rest * extent.asDiagonal();
        const TetMesh fine = pbs::refine(mesh).mesh;
        // lengths of the edges between the midpoints of opposite edges, which lie along one axis
        std::set<double> inner;
        for (Eigen::Index t = 4; t < 8; ++t)
            for (int a = 0; a < 4; ++a)
                for (int b = 0; b < a; ++b) {
                    const pbs::Vec3 edge = fine.rest.row(fine.tets(t, a)) - fine.rest.row(fine.tets(t, b));
                    if ((edge.array() != 0.0).count() == 1) inner.insert(edge.norm());
                }
        EXPECT_EQ(inner, std::set<double>{1.0});
    }
}

TEST(Refinement, AnInvertedTetStaysInvertedAndAnUnusedVertexIsKept)
{
    TetMesh mesh = one_tet();
    mesh.tets << 1, 0, 2, 3;
    mesh.rest.conservativeResize(5, 3);
    mesh.rest.row(4) << 7, 8, 9;
    const TetMesh fine = pbs::refine(mesh).mesh;
    EXPECT_LT(pbs::tet_volumes(fine.rest, fine.tets).maxCoeff(), 0.0);
    EXPECT_EQ(fine.rest.rows(), 11);
    EXPECT_EQ(fine.rest.row(4), mesh.rest.row(4));
    EXPECT_EQ(pbs::topology_of(fine.tets, fine.rest.rows()).unused_vertices, 1);
    const Refinement nothing = pbs::refine({pbs::Positions(0, 3), pbs::Tets(0, 4)});
    EXPECT_EQ(nothing.mesh.rest.rows() + nothing.mesh.tets.rows() + nothing.parents.rows(), 0);
}

TEST(Prolongated, CarriesAnAffineFieldExactly)
{
    const TetMesh bar = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
    const Refinement fine = pbs::refine(bar);
    const Eigen::Matrix3d map = (Eigen::Matrix3d() << 1, 2, 3, -4, 5, 6, 7, 8, -9).finished();
    const pbs::Positions carried = pbs::prolongated(bar.rest * map, fine.parents);
    EXPECT_EQ(carried, fine.mesh.rest * map);  // of multiples of 1/4 by whole numbers, which no product or sum rounds
}

// Reference: the barycentric coordinates of a point that was placed in a known tet, and a search through all tets.

using pbs::Location;
using pbs::PointLocation;
using pbs::Vec3;

const pbs::TetMesh bar = test_support::structured_bar({-1, -0.15, -0.15}, {1, 0.15, 0.15}, {20, 3, 3});

Vec3 point_in(const pbs::TetMesh& mesh, int tet, const Vec3& barycentric)
{
    Vec3 point = (1.0 - barycentric.sum()) * mesh.rest.row(mesh.tets(tet, 0)).transpose();
    for (int c = 0; c < 3; ++c) point += barycentric(c) * mesh.rest.row(mesh.tets(tet, c + 1)).transpose();
    return point;
}

// The first tet, in order, whose smallest barycentric coordinate is at least -1e-10.
int first_tet_by_search(const pbs::TetMesh& mesh, const Vec3& point)
{
    for (int t = 0; t < mesh.tets.rows(); ++t) {
        Eigen::Matrix4d corners;
        for (int c = 0; c < 4; ++c) corners.col(c) << mesh.rest.row(mesh.tets(t, c)).transpose(), 1.0;
        const Eigen::Vector4d barycentric = corners.lu().solve(Eigen::Vector4d(point(0), point(1), point(2), 1.0));
        if (barycentric.minCoeff() >= -1e-10) return t;
    }
    return -1;
}

TEST(PointLocation, FindsEveryTetByItsOwnInnerPoint)
{
    const PointLocation where(bar);
    const Vec3 barycentric(0.2, 0.3, 0.4);
    // The point, of norm below 1.1, goes through six roundings. The inverse of the edges, of norm sqrt 5 / 0.1 on a
    // Kuhn tet, magnifies them, and goes through a dozen of its own, times the condition number sqrt 6 sqrt 5.
    using test_support::rounding_error;
    const double rounding =
        rounding_error(6, 1.1) * std::sqrt(5.0) / 0.1 + rounding_error(12 * std::sqrt(30.0) + 3, barycentric.norm());
    for (int t = 0; t < bar.tets.rows(); ++t) {
        const Location found = where.locate(point_in(bar, t, barycentric));
        EXPECT_EQ(found.tet, t);
        EXPECT_LT((found.barycentric - barycentric).norm(), rounding);
    }
}

TEST(PointLocation, AgreesWithASearchThroughAllTetsInsideAndOutside)
{
    const PointLocation where(bar);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> along(-1.1, 1.1), across(-0.18, 0.18);
    for (int i = 0; i < 500; ++i) {
        const Vec3 point(along(random), across(random), across(random));
        EXPECT_EQ(where.locate(point).tet, first_tet_by_search(bar, point)) << point.transpose();
    }
}

TEST(PointLocation, PointsOnVerticesEdgesAndFacesGoToTheLowestTet)
{
    const PointLocation where(bar);
    for (int t = 0; t < bar.tets.rows(); t += 7)
        for (const Vec3& barycentric :
             {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0.5, 0), Vec3(0.25, 0, 0.25), Vec3(0.2, 0.3, 0.5)}) {
            const Vec3 point = point_in(bar, t, barycentric);
            EXPECT_EQ(where.locate(point).tet, first_tet_by_search(bar, point));
        }
}

TEST(PointLocation, PointsFarOutsideOrNotANumberAreInNoTet)
{
    const PointLocation where(bar);
    EXPECT_EQ(where.locate({1e300, 0, 0}).tet, -1);
    EXPECT_EQ(where.locate({0, -1e9, 0}).tet, -1);
    EXPECT_EQ(where.locate({0, 0, 0.1501}).tet, -1);
    EXPECT_EQ(where.locate(Vec3::Constant(std::nan(""))).tet, -1);
    const pbs::TetMesh tet = test_support::unit_tet();
    const PointLocation in_one_tet(tet);
    EXPECT_EQ(in_one_tet.locate({0.2, 0.2, 0.2}).tet, 0);
    EXPECT_EQ(in_one_tet.locate({0.4, 0.4, 0.4}).tet, -1);
}

// Reference: the definition of a division: every tet in one region, each region connected over faces, sizes between
// half of the wanted size and what the merging of small rests allows; volumes of surfaces by the divergence theorem.

const pbs::TetMesh divided_bar = test_support::structured_bar({0, 0, 0}, {4, 1, 1}, {8, 3, 3});  // 432 tets

pbs::Tets tets_in(const pbs::Tets& tets, const std::vector<int>& region, int which)
{
    std::vector<int> members;
    for (std::size_t t = 0; t < region.size(); ++t)
        if (region[t] == which) members.push_back(int(t));
    return tets(members, Eigen::all);
}

int regions_in(const std::vector<int>& region)
{
    return *std::ranges::max_element(region) + 1;
}

TEST(TetRegions, DivideTheMeshIntoConnectedRegionsOfAboutTheWantedSize)
{
    for (const int size : {1, 7, 40, 100}) {
        const std::vector<int> region = pbs::tet_regions(divided_bar.tets, size);
        ASSERT_EQ(region.size(), std::size_t(divided_bar.tets.rows()));
        for (int r = 0; r < regions_in(region); ++r) {
            const pbs::Tets own = tets_in(divided_bar.tets, region, r);
            EXPECT_GE(2 * own.rows(), size) << size;
            EXPECT_EQ(pbs::topology_of(own, divided_bar.rest.rows()).components, 1) << size << ' ' << r;
        }
        EXPECT_GE(regions_in(region), divided_bar.tets.rows() / (2 * size))
            << "rests may at most double the mean size here";
    }
}

TEST(TetRegions, OneTetOrAllOfThemAndAPartOfItsOwn)
{
    const std::vector<int> single = pbs::tet_regions(divided_bar.tets, 1),
                           whole = pbs::tet_regions(divided_bar.tets, 1000000);
    EXPECT_EQ(regions_in(single), divided_bar.tets.rows());
    EXPECT_EQ(regions_in(whole), 1);
    EXPECT_TRUE(pbs::tet_regions(pbs::Tets(0, 4), 8).empty());
    EXPECT_EQ(pbs::tet_regions(pbs::Tets{{0, 1, 2, 3}, {4, 5, 6, 7}}, 100), (std::vector<int>{0, 1}));
    EXPECT_EQ(pbs::tet_regions(pbs::Tets{{0, 1, 2, 3}, {3, 5, 6, 7}}, 100), (std::vector<int>{0, 1}))
        << "a shared vertex is no shared face";
}

TEST(TetRegions, SurfacesEncloseTheVolumesOfTheirTets)
{
    const std::vector<int> region = pbs::tet_regions(divided_bar.tets, 40);
    const std::vector<pbs::Triangles> surfaces = pbs::region_surfaces(divided_bar.tets, region);
    ASSERT_EQ(int(surfaces.size()), regions_in(region));
    for (std::size_t r = 0; r < surfaces.size(); ++r) {
        const double enclosed = test_support::enclosed_volume(divided_bar.rest, surfaces[r]);
        const pbs::Tets own = tets_in(divided_bar.tets, region, int(r));
        // Triangles with coordinates of up to 4 m, a dozen roundings each, and their sum.
        EXPECT_NEAR(enclosed, pbs::tet_volumes(divided_bar.rest, own).sum(),
                    test_support::rounding_error(200.0 * (12 + 200), 4.0 / 6.0));
    }
}

}  // namespace
