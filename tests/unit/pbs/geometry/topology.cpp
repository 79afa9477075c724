// Reference: counts and Euler's formula for bodies that can be counted by hand.

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/closed_surfaces.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>

namespace topology_tests {
namespace {

using pbs::Tets;
using pbs::Topology;
using pbs::Triangles;
using test_support::carved_box;

const Tets one_tet{{0, 1, 2, 3}};

TEST(Edges, OfOneTetAreSixSortedPairs)
{
    EXPECT_EQ(pbs::edges_of(Tets(0, 4)).rows(), 0);
    EXPECT_EQ(pbs::edges_of(one_tet), (pbs::Edges{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}));
}

TEST(Edges, OfABallObeyEulersFormula)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {4, 3, 2});
    const auto edges = pbs::edges_of(bar.tets), repeated = pbs::edges_of(bar.tets);
    const auto faces = (4 * bar.tets.rows() + pbs::boundary_of(bar.tets).rows()) / 2;
    EXPECT_EQ(bar.rest.rows() - edges.rows() + faces - bar.tets.rows(), 1);  // V - E + F - T = 1
    EXPECT_EQ(edges, repeated);
}

TEST(Boundary, OfOneTetIsItsFourFacesOutward)
{
    const Triangles boundary = pbs::boundary_of(one_tet);
    ASSERT_EQ(boundary.rows(), 4);
    const pbs::Positions point = test_support::unit_tet().rest;
    // the tet from a face to an inner point is negative if the face points outward
    for (const auto& f : boundary.rowwise())
        EXPECT_LT(pbs::tet_volume(point.row(f(0)), point.row(f(1)), point.row(f(2)), {0.25, 0.25, 0.25}), 0.0);
}

TEST(Boundary, EnclosesTheVolumeOfTheBar)
{
    const pbs::TetMesh bar = test_support::structured_bar({1, 2, 3}, {3, 3, 4}, {4, 2, 2});
    const Triangles boundary = pbs::boundary_of(bar.tets);
    // exact, since all coordinates are small multiples of 1/2
    EXPECT_EQ(test_support::enclosed_volume(bar.rest, boundary), 2.0);
    EXPECT_EQ(boundary.rows(), 2 * 2 * (4 * 2 + 4 * 2 + 2 * 2));
}

TEST(Boundary, VerticesAreAllButTheInnerOnes)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {4, 3, 2});
    const std::vector<bool> on_boundary = pbs::boundary_vertices(bar.tets, bar.rest.rows());
    EXPECT_EQ(std::count(on_boundary.begin(), on_boundary.end(), false), 3 * 2 * 1);
}

struct CountedBody {
    std::string name;
    pbs::TetMesh mesh;
    Topology expected;
};

TEST(Topology, OfBodiesThatAreCountedByHand)
{
    const CountedBody bodies[] = {
        {"a ball", test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {4, 3, 2}), {true, 1, 2, 1}},
        {"a handle", carved_box({3, 3, 1}, [](int i, int j, int) { return i != 1 || j != 1; }), {true, 1, 0, 1}},
        {"a void",
         carved_box({3, 3, 3}, [](int i, int j, int k) { return i != 1 || j != 1 || k != 1; }),
         {true, 2, 4, 1}},
        {"two bodies", carved_box({3, 1, 1}, [](int i, int, int) { return i != 1; }), {true, 2, 4, 2}},
    };
    for (const auto& [name, mesh, expected] : bodies) {
        SCOPED_TRACE(name);
        const Topology topology = pbs::topology_of(mesh.tets, mesh.rest.rows() + 3);
        EXPECT_EQ(topology.boundary_manifold, expected.boundary_manifold);
        EXPECT_EQ(topology.boundary_components, expected.boundary_components);
        EXPECT_EQ(topology.boundary_euler, expected.boundary_euler);
        EXPECT_EQ(topology.components, expected.components);
        EXPECT_EQ(topology.unused_vertices, 3);
    }
}

// Where cubes share a vertex alone, every edge is in two triangles; only the fans show the defect.
TEST(Topology, CubesThatShareAnEdgeOrAVertexAndThreeTetsOnOneFaceAreNotManifold)
{
    const pbs::TetMesh on_an_edge = carved_box({2, 2, 1}, [](int i, int j, int) { return i == j; });
    const pbs::TetMesh on_a_vertex = carved_box({2, 2, 2}, [](int i, int j, int k) { return i == j && j == k; });
    const Topology of_edge = pbs::topology_of(on_an_edge.tets, on_an_edge.rest.rows());
    const Topology of_vertex = pbs::topology_of(on_a_vertex.tets, on_a_vertex.rest.rows());
    EXPECT_FALSE(of_edge.boundary_manifold);
    EXPECT_EQ(of_edge.components, 2);
    EXPECT_FALSE(of_vertex.boundary_manifold);
    EXPECT_EQ(of_vertex.boundary_components, 2);
    EXPECT_FALSE(pbs::topology_of(Tets{{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}}, 6).boundary_manifold);
    const Topology nothing = pbs::topology_of(Tets(0, 4), 5);
    EXPECT_EQ(nothing.components, 0);
    EXPECT_EQ(nothing.unused_vertices, 5);
}

// Faces of a tet on these corners, outward if it is positively oriented.
Triangles faces_of(int a, int b, int c, int d)
{
    return Triangles{{b, c, d}, {a, d, c}, {a, b, d}, {a, c, b}};
}

Triangles together(const Triangles& one, const Triangles& other)
{
    Triangles all(one.rows() + other.rows(), 3);
    all << one, other;
    return all;
}

TEST(ClosedTriangles, AreWatertightOrOpenAtTheirFirstEdge)
{
    const Triangles tet = faces_of(0, 1, 2, 3);
    Triangles turned = tet;
    turned.row(0) = turned.row(0).reverse().eval();
    struct Case {
        const char* name;
        Triangles triangles;
        bool closed, watertight;
        std::optional<std::pair<int, int>> open_edge;
    };
    for (const auto& [name, triangles, closed, watertight, edge] :
         {Case{"a tet", tet, true, true, {}},
          Case{"tets that touch in an edge", together(tet, faces_of(0, 1, 4, 5)), true, false, {}},
          Case{"a hole", tet.topRows(3), false, false, {{0, 1}}},
          Case{"a fin", together(tet, Triangles{{0, 1, 4}}), false, false, {{0, 1}}},
          Case{"a turned triangle", turned, false, false, {{1, 2}}}, Case{"none", Triangles(0, 3), false, false, {}}}) {
        SCOPED_TRACE(name);
        EXPECT_EQ(pbs::is_closed(triangles), closed);
        EXPECT_EQ(pbs::is_watertight(triangles), watertight);
        const auto open = pbs::open_edge(triangles);
        if (!edge && closed == watertight) {
            EXPECT_FALSE(open);
        }
        if (!edge) continue;
        ASSERT_TRUE(open);
        EXPECT_EQ(std::minmax(open->first, open->second), std::minmax(edge->first, edge->second));
    }
}

// Reference: the definition, on bars and tets that are counted by hand.

// Two bars of six tets whose tets alternate: those of the first one have even numbers.
pbs::TetMesh two_bars()
{
    const pbs::TetMesh left = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    pbs::TetMesh both{pbs::Positions(16, 3), pbs::Tets(12, 4)};
    both.rest << left.rest, (left.rest.array() + 3.0).matrix();
    for (Eigen::Index t = 0; t < 6; ++t) {
        both.tets.row(2 * t) = left.tets.row(t);
        both.tets.row(2 * t + 1) = left.tets.row(t).array() + 8;
    }
    return both;
}

TEST(Parts, AreNumberedInTheOrderOfTheirFirstTets)
{
    EXPECT_TRUE(pbs::parts_of(Tets(0, 4)).empty());
    EXPECT_EQ(pbs::parts_of(test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {3, 2, 2}).tets),
              std::vector<int>(72, 0));
    EXPECT_EQ(pbs::parts_of(two_bars().tets), (std::vector<int>{0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1}));
}

TEST(Parts, ThatShareAVertexOrAnEdgeAlone)
{
    EXPECT_EQ(pbs::parts_of(Tets{{0, 1, 2, 3}, {0, 4, 5, 6}}), (std::vector<int>{0, 1}));
    EXPECT_EQ(pbs::parts_of(Tets{{0, 1, 2, 3}, {0, 1, 5, 6}}), (std::vector<int>{0, 1}));
    EXPECT_EQ(pbs::parts_of(Tets{{0, 1, 2, 3}, {4, 2, 1, 0}}), (std::vector<int>{0, 0}));
}

TEST(Parts, DoNotDependOnTheOrderOfTets)
{
    const pbs::TetMesh bars = two_bars();
    std::vector<int> order(12);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    const std::vector<int> parts = pbs::parts_of(bars.tets(order, Eigen::all));
    for (std::size_t a = 0; a < 12; ++a)
        for (std::size_t b = 0; b < 12; ++b) EXPECT_EQ(parts[a] == parts[b], order[a] % 2 == order[b] % 2);
}

TEST(KeptTets, HaveTheVerticesThatTheyUseInTheirOrder)
{
    const pbs::TetMesh bars = two_bars();
    std::vector<bool> kept(12);
    for (std::size_t t = 1; t < 12; t += 2) kept[t] = true;
    const pbs::TetMesh right = pbs::kept_tets(bars, kept);
    EXPECT_EQ(right.rest, pbs::Positions(bars.rest.bottomRows(8)));
    EXPECT_EQ(right.tets, test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {1, 1, 1}).tets);
    EXPECT_EQ(pbs::kept_tets(bars, std::vector<bool>(12, true)).tets, bars.tets);
    const pbs::TetMesh none = pbs::kept_tets(bars, std::vector<bool>(12, false));
    EXPECT_EQ(none.tets.rows(), 0);
    EXPECT_EQ(none.rest.rows(), 0);
}

// Reference: angles and sizes of tets known in closed form.

constexpr double degree = 180.0 / std::numbers::pi;

// Angles of tets whose coordinates are whole numbers: normals are exact; their norm, the angle, two conversions and pi
// are rounded. Those of comparison go through seven roundings: a root and a quotient in the cosine, the angle, the
// conversion and pi.
constexpr double of_angles_deg = test_support::rounding_error(5 + 7, 90.0);

TEST(DihedralAngles, OfARegularTetAreAcosOfAThirdAndOfTheUnitCornerRightOnTheAxes)
{
    for (const double angle_deg : pbs::dihedral_angles_deg({1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}))
        EXPECT_NEAR(angle_deg, std::acos(1.0 / 3.0) * degree, of_angles_deg);
    const auto angles_deg = pbs::dihedral_angles_deg({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    for (int e = 0; e < 6; ++e)
        EXPECT_NEAR(angles_deg[e], e < 3 ? 90.0 : std::acos(1.0 / std::sqrt(3.0)) * degree, of_angles_deg);
}

TEST(DihedralAngles, OfAFlatTetAreZeroOr180AndOfACollapsedOneZero)
{
    for (const double angle_deg : pbs::dihedral_angles_deg({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}))
        EXPECT_TRUE(angle_deg == 0.0 || angle_deg == 180.0) << angle_deg;
    for (const double angle_deg : pbs::dihedral_angles_deg({1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}))
        EXPECT_EQ(angle_deg, 0.0);
}

TEST(Quality, OfAKuhnSplitBar)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {4, 3, 2}, {4, 3, 2});
    const pbs::Quality quality = pbs::quality_of(bar);
    EXPECT_EQ(quality.vertices, 5 * 4 * 3);
    EXPECT_EQ(quality.boundary_vertices, 5 * 4 * 3 - 3 * 2 * 1);
    EXPECT_EQ(quality.tets, 6 * 4 * 3 * 2);
    EXPECT_EQ(quality.boundary_triangles, 4 * (4 * 3 + 4 * 2 + 3 * 2));
    EXPECT_NEAR(quality.volume_m3, 24.0, test_support::volume_error(bar.rest, bar.tets));
    EXPECT_NEAR(quality.min_dihedral_deg, 45.0, of_angles_deg);  // Kuhn's tet: 45, 60 and 90 degrees
    EXPECT_NEAR(quality.max_dihedral_deg, 90.0, of_angles_deg);
    EXPECT_DOUBLE_EQ(quality.shortest_edge_m, 1.0);
    EXPECT_DOUBLE_EQ(quality.longest_edge_m, std::sqrt(3.0));
    EXPECT_TRUE(quality.topology.boundary_manifold);
    EXPECT_NE(pbs::describe(quality).find("boundary manifold, 1 component(s), Euler characteristic 2"),
              std::string::npos);
}

TEST(Quality, OfNothingIsZeros)
{
    const pbs::Quality quality = pbs::quality_of(pbs::TetMesh{pbs::Positions(0, 3), pbs::Tets(0, 4)});
    EXPECT_EQ(quality.tets, 0);
    EXPECT_EQ(quality.min_dihedral_deg, 0.0);
    EXPECT_EQ(quality.shortest_edge_m, 0.0);
}

}  // namespace
}  // namespace topology_tests
