// Reference: the shapes written by hand, and that groups of one are the constraints in file order.
#include "pbs/packed/groups.hpp"

#include "pbs/geometry/topology.hpp"
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

}  // namespace
