// Reference: each edge in one group, and small meshes whose groups are counted by hand.
#include "pbs/geometry/topology.hpp"
#include "tests/support/expect_groups.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/tet_rings.hpp"

namespace {

using namespace test_support;
using pbs::GroupKind;
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

}  // namespace
