// Reference: the shapes written by hand, and that groups of one are the constraints in file order.
#include "pbs/geometry/topology.hpp"
#include "pbs/packed/groups.hpp"
#include "tests/support/expect_groups.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/tet_rings.hpp"

#include <set>

namespace {

using namespace test_support;
using pbs::GroupKind;

const pbs::TetMesh bar = structured_bar({0, 0, 0}, {3, 2, 2}, {3, 2, 2});

TEST(ConstraintGroups, SizesOfEachKind)
{
    const std::vector<std::array<int, 3>> expected = {{2, 1, 2}, {3, 2, 2}, {3, 3, 2}, {4, 6, 2}, {4, 1, 4}, {5, 2, 4}, {6, 3, 4}};
    for (int kind = 0; kind < static_cast<int>(expected.size()); ++kind) {
        EXPECT_EQ(pbs::vertices_of(GroupKind(kind)), expected[kind][0]) << kind;
        EXPECT_EQ(pbs::constraints_of(GroupKind(kind)), expected[kind][1]) << kind;
        const pbs::ConstraintGroup group{GroupKind(kind), {0, 1, 2, 3, 4, 5}, {}};
        EXPECT_EQ(joined(group, 0).size(), std::size_t(expected[kind][2])) << kind;
        EXPECT_LE(pbs::vertices_of(GroupKind(kind)), pbs::largest_group);
        EXPECT_LE(pbs::constraints_of(GroupKind(kind)), pbs::largest_group);
    }
}

// Some constraint joins each vertex of a group, and no two constraints of a group join the same vertices.
TEST(ConstraintGroups, ShapesUseEachVertexAndRepeatNothing)
{
    for (int kind = 0; kind <= static_cast<int>(GroupKind::tet_fan_3); ++kind) {
        const pbs::ConstraintGroup group{GroupKind(kind), {0, 1, 2, 3, 4, 5}, {}};
        std::set<int> used;
        std::set<std::set<int>> constraints;
        for (int c = 0; c < pbs::constraints_of(group.kind); ++c) {
            const std::vector<int> vertices = joined(group, c);
            used.insert(vertices.begin(), vertices.end());
            constraints.emplace(vertices.begin(), vertices.end());
        }
        EXPECT_EQ(used.size(), std::size_t(pbs::vertices_of(group.kind))) << kind;
        EXPECT_EQ(constraints.size(), std::size_t(pbs::constraints_of(group.kind))) << kind;
    }
}

TEST(ConstraintGroups, SinglesAreInFileOrder)
{
    const auto edges = rows_of(pbs::edges_of(bar.tets));
    const auto tets = rows_of(bar.tets);
    const auto by_edge = pbs::single_edges(edges), by_tet = pbs::single_tets(tets);
    expect_each_once(by_edge, edges);
    expect_each_once(by_tet, tets);
    for (std::size_t e = 0; e < by_edge.size(); ++e) EXPECT_EQ(joined(by_edge[e], 0), std::vector(edges[e].begin(), edges[e].end()));
    for (std::size_t t = 0; t < by_tet.size(); ++t) EXPECT_EQ(joined(by_tet[t], 0), std::vector(tets[t].begin(), tets[t].end()));
}

TEST(ConstraintGroups, NoConstraintsAreNoGroups)
{
    EXPECT_TRUE(pbs::single_edges({}).empty());
    EXPECT_TRUE(pbs::single_tets({}).empty());
    EXPECT_TRUE(pbs::grouped_edges({}, bar.tets).empty());
    EXPECT_TRUE(pbs::grouped_tets({}).empty());
}

// Reference: each edge in one group, and small meshes whose groups are counted by hand.

using pbs::Tets;
using EdgeList = std::vector<std::array<int, 2>>;
using Counts = std::map<GroupKind, int>;

std::vector<pbs::ConstraintGroup> expect_sound(const EdgeList& edges, const Tets& tets)
{
    const std::vector<pbs::ConstraintGroup> groups = pbs::grouped_edges(edges, tets);
    expect_each_once(groups, edges);
    expect_vertices_differ(groups);
    return groups;
}

EdgeList edges_of_rows(const Tets& tets)
{
    return rows_of(pbs::edges_of(tets));
}

TEST(GroupedEdges, OneTetIsOneGroup)
{
    const Tets tet = tet_ring(1, false);
    EXPECT_EQ(count_by_kind(expect_sound(edges_of_rows(tet), tet)), (Counts{{GroupKind::edge_tet, 1}}));
}

// The second tet adds three edges, all at one vertex.
TEST(GroupedEdges, TwoTets)
{
    const Tets tets = tet_ring(2, false);
    EXPECT_EQ(count_by_kind(expect_sound(edges_of_rows(tets), tets)),
              (Counts{{GroupKind::edge_tet, 1}, {GroupKind::edge_wedge, 1}, {GroupKind::edge, 1}}));
}

TEST(GroupedEdges, RingsOfTets)
{
    for (int count = 3; count <= 9; ++count)
        for (const bool closed : {false, true}) {
            const Tets tets = tet_ring(count, closed);
            expect_sound(edges_of_rows(tets), tets);
        }
}

TEST(GroupedEdges, ThreeTetsOnOneFace)
{
    Tets tets(3, 4);
    tets << 0, 1, 2, 3, 0, 2, 1, 4, 0, 1, 2, 5;
    expect_sound(edges_of_rows(tets), tets);
}

TEST(GroupedEdges, TetsThatShareAnEdgeOrAVertexOnly)
{
    Tets tets(3, 4);
    tets << 0, 1, 2, 3, 0, 1, 4, 5, 5, 6, 7, 8;
    // The second tet lacks one edge and still forms a group; the third is complete.
    EXPECT_EQ(count_by_kind(expect_sound(edges_of_rows(tets), tets)), (Counts{{GroupKind::edge_tet, 3}}));
}

TEST(GroupedEdges, BarInAnyNumbering)
{
    const pbs::TetMesh bar = structured_bar({0, 0, 0}, {8, 3, 3}, {8, 3, 3});
    const int vertices = static_cast<int>(bar.rest.rows());
    for (const Tets& tets : {bar.tets, shuffled(bar.tets, vertices, 3)}) {
        const EdgeList edges = edges_of_rows(tets);
        const auto groups = expect_sound(edges, tets);
        EXPECT_LT(3 * groups.size(), 2 * edges.size());  // otherwise grouping saves nothing
        EXPECT_GT(count_by_kind(groups)[GroupKind::edge_tet], 10);
    }
}

// k_stretch = 0 in part of the body: the list lacks edges that the mesh has.
TEST(GroupedEdges, OnlySomeEdgesAreConstrained)
{
    const pbs::TetMesh bar = structured_bar({0, 0, 0}, {6, 2, 2}, {6, 2, 2});
    const EdgeList all = edges_of_rows(bar.tets);
    for (const std::size_t every : {2, 3, 5, 7}) {
        EdgeList some, but_some;
        for (std::size_t e = 0; e < all.size(); ++e) (e % every == 0 ? some : but_some).push_back(all[e]);
        expect_sound(some, bar.tets);
        expect_sound(but_some, bar.tets);
    }
}

TEST(GroupedEdges, PartsOfOneTet)
{
    const Tets tet = tet_ring(1, false);
    EXPECT_EQ(count_by_kind(expect_sound({{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}}, tet)), (Counts{{GroupKind::edge_tet, 1}}));
    EXPECT_EQ(count_by_kind(expect_sound({{1, 2}, {2, 3}, {1, 3}}, tet)), (Counts{{GroupKind::edge_triangle, 1}}));
    EXPECT_EQ(count_by_kind(expect_sound({{0, 1}, {0, 2}, {0, 3}}, tet)), (Counts{{GroupKind::edge_wedge, 1}, {GroupKind::edge, 1}}));
    EXPECT_EQ(count_by_kind(expect_sound({{0, 1}, {2, 3}}, tet)), (Counts{{GroupKind::edge, 2}}));
    EXPECT_EQ(count_by_kind(expect_sound({{3, 1}}, tet)), (Counts{{GroupKind::edge, 1}}));
}

// A star of edges that belong to no tet: they form pairs at its centre.
TEST(GroupedEdges, EdgesOfNoTet)
{
    EdgeList star;
    for (int i = 1; i <= 7; ++i) star.push_back({0, i});
    EXPECT_EQ(count_by_kind(expect_sound(star, Tets(0, 4))), (Counts{{GroupKind::edge_wedge, 3}, {GroupKind::edge, 1}}));
}

// Reference: each tet in one group with its own orientation, and small meshes whose fans are counted by hand.

using TetList = std::vector<std::array<int, 4>>;

std::vector<pbs::ConstraintGroup> expect_sound(const TetList& tets)
{
    const std::vector<pbs::ConstraintGroup> groups = pbs::grouped_tets(tets);
    expect_each_once(groups, tets);
    expect_vertices_differ(groups);
    for (const pbs::ConstraintGroup& group : groups)
        for (int c = 0; c < pbs::constraints_of(group.kind); ++c) EXPECT_GE(group.constraint[c], 0) << "a hole in a fan";
    return groups;
}

Counts kinds_of_ring(int count, bool closed)
{
    return count_by_kind(expect_sound(rows_of(tet_ring(count, closed))));
}

TEST(GroupedTets, OneTetIsAlone)
{
    EXPECT_EQ(kinds_of_ring(1, false), (Counts{{GroupKind::tet, 1}}));
}

TEST(GroupedTets, TwoTetsOnAFaceAreAFan)
{
    EXPECT_EQ(kinds_of_ring(2, false), (Counts{{GroupKind::tet_fan_2, 1}}));
}

TEST(GroupedTets, OpenRings)
{
    EXPECT_EQ(kinds_of_ring(3, false), (Counts{{GroupKind::tet_fan_3, 1}}));
    EXPECT_EQ(kinds_of_ring(5, false), (Counts{{GroupKind::tet_fan_3, 1}, {GroupKind::tet_fan_2, 1}}));
    EXPECT_EQ(kinds_of_ring(6, false), (Counts{{GroupKind::tet_fan_3, 2}}));
}

// In a closed ring of three tets, a fan of three would return to its first vertex: it has five vertices, not six.
TEST(GroupedTets, ClosedRings)
{
    EXPECT_EQ(kinds_of_ring(3, true), (Counts{{GroupKind::tet_fan_2, 1}, {GroupKind::tet, 1}}));
    EXPECT_EQ(kinds_of_ring(4, true), (Counts{{GroupKind::tet_fan_3, 1}, {GroupKind::tet, 1}}));
    EXPECT_EQ(kinds_of_ring(6, true), (Counts{{GroupKind::tet_fan_3, 2}}));
    for (int count = 5; count <= 12; ++count) kinds_of_ring(count, true);
}

TEST(GroupedTets, RingsInAnyNumbering)
{
    for (int count = 2; count <= 8; ++count)
        for (unsigned seed = 0; seed < 20; ++seed) {
            const bool closed = count > 2 && seed % 2 == 0;
            expect_sound(rows_of(shuffled(tet_ring(count, closed), count + 3, seed)));
        }
}

TEST(GroupedTets, TetsThatShareNoFaceAreAlone)
{
    EXPECT_EQ(count_by_kind(expect_sound({{0, 1, 2, 3}, {0, 1, 4, 5}, {5, 6, 7, 8}, {9, 10, 11, 12}})), (Counts{{GroupKind::tet, 4}}));
}

// A mirrored neighbour lies on the same side of the common face, and no fan contains both.
TEST(GroupedTets, MirroredNeighbourIsNoFan)
{
    EXPECT_EQ(count_by_kind(expect_sound({{0, 1, 2, 3}, {0, 1, 4, 3}})), (Counts{{GroupKind::tet, 2}}));
}

TEST(GroupedTets, ThreeAndFourTetsOnOneFace)
{
    expect_sound({{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}});
    expect_sound({{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}, {0, 2, 1, 6}});
}

TEST(GroupedTets, TheSameTetTwice)
{
    EXPECT_EQ(count_by_kind(expect_sound({{0, 1, 2, 3}, {0, 1, 2, 3}})), (Counts{{GroupKind::tet, 2}}));
    expect_sound({{0, 1, 2, 3}, {1, 0, 2, 3}, {0, 1, 3, 4}});
}

TEST(GroupedTets, BarInAnyNumbering)
{
    const pbs::TetMesh bar = structured_bar({0, 0, 0}, {8, 3, 3}, {8, 3, 3});
    for (const Tets& tets : {bar.tets, shuffled(bar.tets, static_cast<int>(bar.rest.rows()), 4)}) {
        const auto groups = expect_sound(rows_of(tets));
        EXPECT_LT(5 * groups.size(), 2 * std::size_t(tets.rows()));  // 2.5 tets per group; otherwise grouping saves little
    }
}

}  // namespace
