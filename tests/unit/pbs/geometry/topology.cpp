// Reference: counts and Euler's formula for bodies that can be counted by hand.
#include "pbs/geometry/topology.hpp"

#include "pbs/geometry/tet_volume.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::Tets;
using pbs::Topology;
using pbs::Triangles;

Tets one_tet()
{
    Tets tets(1, 4);
    tets << 0, 1, 2, 3;
    return tets;
}

// Keeps only those tets of a Kuhn-split box of unit cubes for which keep(cell along x, y, z) is true.
template <typename Keep>
pbs::TetMesh carved_box(const std::array<int, 3>& cells, Keep keep)
{
    pbs::TetMesh box = test_support::structured_bar({0, 0, 0}, {double(cells[0]), double(cells[1]), double(cells[2])}, cells);
    Tets kept(box.tets.rows(), 4);
    Eigen::Index count = 0;
    for (Eigen::Index t = 0; t < box.tets.rows(); ++t) {
        const int cell = static_cast<int>(t) / 6;
        if (keep(cell % cells[0], cell / cells[0] % cells[1], cell / (cells[0] * cells[1]))) kept.row(count++) = box.tets.row(t);
    }
    box.tets = kept.topRows(count);
    return box;
}

TEST(Edges, OfOneTetAreSixSortedPairs)
{
    pbs::Edges expected(6, 2);
    expected << 0, 1, 0, 2, 0, 3, 1, 2, 1, 3, 2, 3;
    EXPECT_EQ(pbs::edges_of(one_tet()), expected);
}

TEST(Edges, OfABallObeyEulersFormula)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {4, 3, 2});
    const auto edges = pbs::edges_of(bar.tets), repeated = pbs::edges_of(bar.tets);
    const auto faces = (4 * bar.tets.rows() + pbs::boundary_of(bar.tets).rows()) / 2;
    EXPECT_EQ(bar.rest.rows() - edges.rows() + faces - bar.tets.rows(), 1);  // V - E + F - T = 1
    EXPECT_EQ(edges, repeated);
}

TEST(Edges, OfNothingAreNone)
{
    EXPECT_EQ(pbs::edges_of(Tets(0, 4)).rows(), 0);
}

TEST(Boundary, OfOneTetIsItsFourFacesOutward)
{
    const Triangles boundary = pbs::boundary_of(one_tet());
    ASSERT_EQ(boundary.rows(), 4);
    const std::array<pbs::Vec3, 4> point = {pbs::Vec3(0, 0, 0), pbs::Vec3(1, 0, 0), pbs::Vec3(0, 1, 0), pbs::Vec3(0, 0, 1)};
    const pbs::Vec3 middle(0.25, 0.25, 0.25);
    for (int f = 0; f < 4; ++f)  // the tet from a face to an inner point is negative if the face points outward
        EXPECT_LT(pbs::tet_volume(point[boundary(f, 0)], point[boundary(f, 1)], point[boundary(f, 2)], middle), 0.0);
}

TEST(Boundary, EnclosesTheVolumeOfTheBar)
{
    const pbs::TetMesh bar = test_support::structured_bar({1, 2, 3}, {3, 3, 4}, {4, 2, 2});
    const Triangles boundary = pbs::boundary_of(bar.tets);
    double six_volumes = 0.0;  // divergence theorem; exact, since all coordinates are small multiples of 1/2
    for (Eigen::Index f = 0; f < boundary.rows(); ++f) {
        const pbs::Vec3 a = bar.rest.row(boundary(f, 0)), b = bar.rest.row(boundary(f, 1)), c = bar.rest.row(boundary(f, 2));
        six_volumes += a.dot(b.cross(c));
    }
    EXPECT_EQ(six_volumes, 6.0 * 2.0);
    EXPECT_EQ(boundary.rows(), 2 * 2 * (4 * 2 + 4 * 2 + 2 * 2));
}

TEST(Boundary, VerticesAreAllButTheInnerOnes)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {4, 3, 2});
    const std::vector<bool> on_boundary = pbs::boundary_vertices(bar.tets, bar.rest.rows());
    EXPECT_EQ(std::count(on_boundary.begin(), on_boundary.end(), false), 3 * 2 * 1);
}

TEST(Topology, OfABallIsManifoldWithEulerCharacteristicTwo)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {4, 3, 2});
    const Topology topology = pbs::topology_of(bar.tets, bar.rest.rows() + 3);
    EXPECT_TRUE(topology.boundary_manifold);
    EXPECT_EQ(topology.boundary_components, 1);
    EXPECT_EQ(topology.boundary_euler, 2);
    EXPECT_EQ(topology.components, 1);
    EXPECT_EQ(topology.unused_vertices, 3);
}

TEST(Topology, OfAHandleHasEulerCharacteristicZero)
{
    const pbs::TetMesh ring = carved_box({3, 3, 1}, [](int i, int j, int) { return i != 1 || j != 1; });
    const Topology topology = pbs::topology_of(ring.tets, ring.rest.rows());
    EXPECT_TRUE(topology.boundary_manifold);
    EXPECT_EQ(topology.boundary_euler, 0);
    EXPECT_EQ(topology.unused_vertices, 0);
}

TEST(Topology, OfAVoidHasTwoBoundaries)
{
    const pbs::TetMesh hollow = carved_box({3, 3, 3}, [](int i, int j, int k) { return i != 1 || j != 1 || k != 1; });
    const Topology topology = pbs::topology_of(hollow.tets, hollow.rest.rows());
    EXPECT_TRUE(topology.boundary_manifold);
    EXPECT_EQ(topology.boundary_components, 2);
    EXPECT_EQ(topology.boundary_euler, 4);
    EXPECT_EQ(topology.components, 1);
}

TEST(Topology, CountsSeparateBodies)
{
    const pbs::TetMesh pair = carved_box({3, 1, 1}, [](int i, int, int) { return i != 1; });
    const Topology topology = pbs::topology_of(pair.tets, pair.rest.rows());
    EXPECT_TRUE(topology.boundary_manifold);
    EXPECT_EQ(topology.components, 2);
    EXPECT_EQ(topology.boundary_components, 2);
}

TEST(Topology, CubesThatShareAnEdgeAreNotManifold)
{
    const pbs::TetMesh pinched = carved_box({2, 2, 1}, [](int i, int j, int) { return i == j; });
    const Topology topology = pbs::topology_of(pinched.tets, pinched.rest.rows());
    EXPECT_FALSE(topology.boundary_manifold);
    EXPECT_EQ(topology.components, 2);
}

TEST(Topology, CubesThatShareAVertexAreNotManifold)
{
    const pbs::TetMesh pinched = carved_box({2, 2, 2}, [](int i, int j, int k) { return i == j && j == k; });
    const Topology topology = pbs::topology_of(pinched.tets, pinched.rest.rows());
    EXPECT_FALSE(topology.boundary_manifold);  // every edge is in two triangles; only the fans show the defect
    EXPECT_EQ(topology.boundary_components, 2);
}

TEST(Topology, ThreeTetsOnOneFaceAreNotManifold)
{
    Tets tets(3, 4);
    tets << 0, 1, 2, 3, 0, 2, 1, 4, 0, 1, 2, 5;
    EXPECT_FALSE(pbs::topology_of(tets, 6).boundary_manifold);
}

TEST(Topology, OfNothingCountsUnusedVertices)
{
    const Topology topology = pbs::topology_of(Tets(0, 4), 5);
    EXPECT_EQ(topology.components, 0);
    EXPECT_EQ(topology.unused_vertices, 5);
}

// Faces of a tet on these corners, outward if it is positively oriented.
Triangles faces_of(int a, int b, int c, int d)
{
    Triangles faces(4, 3);
    faces << b, c, d, a, d, c, a, b, d, a, c, b;
    return faces;
}

Triangles together(const Triangles& one, const Triangles& other)
{
    Triangles all(one.rows() + other.rows(), 3);
    all << one, other;
    return all;
}

TEST(ClosedTriangles, OfATetAreWatertight)
{
    const Triangles tet = faces_of(0, 1, 2, 3);
    EXPECT_TRUE(pbs::is_closed(tet));
    EXPECT_TRUE(pbs::is_watertight(tet));
    EXPECT_FALSE(pbs::open_edge(tet));
}

TEST(ClosedTriangles, OfTetsThatTouchInAnEdgeAreClosedButNotWatertight)
{
    const Triangles two = together(faces_of(0, 1, 2, 3), faces_of(0, 1, 4, 5));
    EXPECT_TRUE(pbs::is_closed(two));
    EXPECT_FALSE(pbs::is_watertight(two));
}

TEST(ClosedTriangles, WithAHoleAFinOrATurnedTriangleAreOpenAtTheirFirstEdge)
{
    const Triangles tet = faces_of(0, 1, 2, 3);
    const Triangles fin = together(tet, (Triangles(1, 3) << 0, 1, 4).finished());
    Triangles turned = tet;
    turned.row(0) = turned.row(0).reverse().eval();
    for (const auto& [triangles, edge] : {std::pair(Triangles(tet.topRows(3)), pbs::DirectedEdge(0, 1)),
                                          {fin, pbs::DirectedEdge(0, 1)},
                                          {turned, pbs::DirectedEdge(1, 2)}}) {
        EXPECT_FALSE(pbs::is_closed(triangles));
        EXPECT_FALSE(pbs::is_watertight(triangles));
        const auto open = pbs::open_edge(triangles);
        ASSERT_TRUE(open);
        EXPECT_EQ(std::minmax(open->first, open->second), std::minmax(edge.first, edge.second));
    }
}

TEST(ClosedTriangles, NoneEncloseNothing)
{
    EXPECT_FALSE(pbs::is_closed(Triangles(0, 3)));
    EXPECT_FALSE(pbs::is_watertight(Triangles(0, 3)));
    EXPECT_FALSE(pbs::open_edge(Triangles(0, 3)));
}

}  // namespace
