// Reference: the shapes written by hand, and that groups of one are the constraints in file order.
#include "pbs/geometry/topology.hpp"
#include "pbs/packed/groups.hpp"
#include "tests/support/expect_groups.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/tet_rings.hpp"

#include <set>

namespace groups_tests {
namespace {

using namespace test_support;
using pbs::GroupKind;

const pbs::TetMesh bar = structured_bar({0, 0, 0}, {3, 2, 2}, {3, 2, 2});

TEST(ConstraintGroups, SizesOfEachKind)
{
    const std::vector<std::array<int, 3>> expected = {{2, 1, 2}, {3, 2, 2}, {3, 3, 2}, {4, 6, 2},
                                                      {4, 1, 4}, {5, 2, 4}, {6, 3, 4}};
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
    for (std::size_t e = 0; e < by_edge.size(); ++e)
        EXPECT_EQ(joined(by_edge[e], 0), std::vector(edges[e].begin(), edges[e].end()));
    for (std::size_t t = 0; t < by_tet.size(); ++t)
        EXPECT_EQ(joined(by_tet[t], 0), std::vector(tets[t].begin(), tets[t].end()));
    EXPECT_TRUE(pbs::single_edges({}).empty() && pbs::single_tets({}).empty());
    EXPECT_TRUE(pbs::grouped_edges({}, bar.tets).empty() && pbs::grouped_tets({}).empty());
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

Tets tets_of(const std::vector<std::array<int, 4>>& rows)
{
    Tets tets(rows.size(), 4);
    for (std::size_t t = 0; t < rows.size(); ++t) tets.row(t) << rows[t][0], rows[t][1], rows[t][2], rows[t][3];
    return tets;
}

TEST(GroupedEdges, OfSmallMeshesAreCounted)
{
    using enum GroupKind;
    const Tets one = tet_ring(1, false), two = tet_ring(2, false),
               apart = tets_of({{0, 1, 2, 3}, {0, 1, 4, 5}, {5, 6, 7, 8}}), none(0, 4);
    struct Case {
        const char* name;
        EdgeList edges;
        Tets tets;
        Counts expected;
    };
    const Case cases[] = {
        {"one tet is one group", edges_of_rows(one), one, {{edge_tet, 1}}},
        {"a second tet adds three edges, all at one vertex",
         edges_of_rows(two),
         two,
         {{edge_tet, 1}, {edge_wedge, 1}, {edge, 1}}},
        {"tets that share an edge or a vertex: the second lacks one edge",
         edges_of_rows(apart),
         apart,
         {{edge_tet, 3}}},
        {"five edges of a tet", {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}}, one, {{edge_tet, 1}}},
        {"a triangle of a tet", {{1, 2}, {2, 3}, {1, 3}}, one, {{edge_triangle, 1}}},
        {"three edges at one corner", {{0, 1}, {0, 2}, {0, 3}}, one, {{edge_wedge, 1}, {edge, 1}}},
        {"opposite edges", {{0, 1}, {2, 3}}, one, {{edge, 2}}},
        {"one edge", {{3, 1}}, one, {{edge, 1}}},
        {"a star of edges of no tet: pairs at its centre",
         {{0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}, {0, 6}, {0, 7}},
         none,
         {{edge_wedge, 3}, {edge, 1}}},
    };
    for (const auto& [name, edges, tets, expected] : cases) {
        SCOPED_TRACE(name);
        EXPECT_EQ(count_by_kind(expect_sound(edges, tets)), expected);
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

// Reference: each tet in one group with its own orientation, and small meshes whose fans are counted by hand.

using TetList = std::vector<std::array<int, 4>>;

std::vector<pbs::ConstraintGroup> expect_sound(const TetList& tets)
{
    const std::vector<pbs::ConstraintGroup> groups = pbs::grouped_tets(tets);
    expect_each_once(groups, tets);
    expect_vertices_differ(groups);
    for (const pbs::ConstraintGroup& group : groups)
        for (int c = 0; c < pbs::constraints_of(group.kind); ++c)
            EXPECT_GE(group.constraint[c], 0) << "a hole in a fan";
    return groups;
}

TEST(GroupedTets, OfSmallMeshesAreCounted)
{
    using enum GroupKind;
    const auto ring = [](int count, bool closed) { return rows_of(tet_ring(count, closed)); };
    struct Case {
        const char* name;
        TetList tets;
        Counts expected;
    };
    const Case cases[] = {
        {"one tet is alone", ring(1, false), {{tet, 1}}},
        {"two tets on a face are a fan", ring(2, false), {{tet_fan_2, 1}}},
        {"an open ring of 3", ring(3, false), {{tet_fan_3, 1}}},
        {"an open ring of 5", ring(5, false), {{tet_fan_3, 1}, {tet_fan_2, 1}}},
        {"an open ring of 6", ring(6, false), {{tet_fan_3, 2}}},
        {"a closed ring of 3: a fan of three would return to its first vertex",
         ring(3, true),
         {{tet_fan_2, 1}, {tet, 1}}},
        {"a closed ring of 4", ring(4, true), {{tet_fan_3, 1}, {tet, 1}}},
        {"a closed ring of 6", ring(6, true), {{tet_fan_3, 2}}},
        {"tets that share no face are alone", {{0, 1, 2, 3}, {0, 1, 4, 5}, {5, 6, 7, 8}, {9, 10, 11, 12}}, {{tet, 4}}},
        {"a mirrored neighbour lies on the same side of the common face", {{0, 1, 2, 3}, {0, 1, 4, 3}}, {{tet, 2}}},
        {"the same tet twice", {{0, 1, 2, 3}, {0, 1, 2, 3}}, {{tet, 2}}},
    };
    for (const auto& [name, tets, expected] : cases) {
        SCOPED_TRACE(name);
        EXPECT_EQ(count_by_kind(expect_sound(tets)), expected);
    }
}

TEST(ConstraintGroups, OfRingsAndOfManyTetsOnOneFaceInAnyNumberingAreSound)
{
    std::vector<Tets> meshes = {tets_of({{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}}),
                                tets_of({{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}, {0, 2, 1, 6}}),
                                tets_of({{0, 1, 2, 3}, {1, 0, 2, 3}, {0, 1, 3, 4}})};
    for (int count = 2; count <= 12; ++count)
        for (const bool closed : {false, true}) {
            if (closed && count == 2) continue;
            meshes.push_back(tet_ring(count, closed));
            for (unsigned seed = 0; seed < 10; ++seed)
                meshes.push_back(shuffled(tet_ring(count, closed), count + 3, seed));
        }
    for (const Tets& tets : meshes) expect_sound(rows_of(tets)), expect_sound(edges_of_rows(tets), tets);
}

// Otherwise grouping saves little or nothing.
TEST(ConstraintGroups, OfABarInAnyNumberingAreFew)
{
    const pbs::TetMesh bar = structured_bar({0, 0, 0}, {8, 3, 3}, {8, 3, 3});
    for (const Tets& tets : {bar.tets, shuffled(bar.tets, static_cast<int>(bar.rest.rows()), 3)}) {
        EXPECT_LT(5 * expect_sound(rows_of(tets)).size(), 2 * std::size_t(tets.rows()));  // 2.5 tets per group
        const EdgeList edges = edges_of_rows(tets);
        const auto groups = expect_sound(edges, tets);
        EXPECT_LT(3 * groups.size(), 2 * edges.size());
        EXPECT_GT(count_by_kind(groups)[GroupKind::edge_tet], 10);
    }
}

}  // namespace
}  // namespace groups_tests
