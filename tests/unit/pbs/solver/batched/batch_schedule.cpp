// Reference: the conditions on which the kernels rely, checked for every batch: at most sixteen groups, no vertex twice, none of the
// previous batch; and the order given, which groups that share a vertex keep.
#include "pbs/packed/groups.hpp"

#include "pbs/geometry/topology.hpp"
#include "tests/support/expect_groups.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/tet_rings.hpp"

#include <map>
#include <set>

namespace {

using namespace test_support;
using pbs::BatchScheduler;
using pbs::ConstraintGroup;
using Batches = std::vector<std::vector<int>>;

Batches expect_sound(BatchScheduler& scheduler, const std::vector<ConstraintGroup>& groups)
{
    const Batches batches = scheduler.schedule(groups);
    std::vector<int> uses(groups.size(), 0);
    std::set<int> before;
    std::map<int, int> last_at;  // group that each vertex belonged to last
    for (const std::vector<int>& batch : batches) {
        EXPECT_LE(batch.size(), std::size_t(pbs::batch_size));
        std::set<int> touched;
        for (const int g : batch) {
            ++uses[g];
            for (int v = 0; v < pbs::vertices_of(groups[g].kind); ++v) {
                EXPECT_TRUE(touched.insert(groups[g].vertex[v]).second) << "twice in a batch: " << groups[g].vertex[v];
                EXPECT_FALSE(before.contains(groups[g].vertex[v])) << "in the batch before: " << groups[g].vertex[v];
                const auto [last, is_first] = last_at.try_emplace(groups[g].vertex[v], g);
                EXPECT_TRUE(is_first || last->second < g) << "group " << g << " follows " << last->second;
                last->second = g;
            }
        }
        before = touched;
    }
    EXPECT_EQ(std::count(uses.begin(), uses.end(), 1), std::ptrdiff_t(groups.size()));
    return batches;
}

Batches expect_sound(int vertices, const std::vector<ConstraintGroup>& groups)
{
    BatchScheduler scheduler(vertices);
    return expect_sound(scheduler, groups);
}

std::vector<ConstraintGroup> edges_between(const std::vector<std::array<int, 2>>& edges)
{
    return pbs::single_edges(edges);
}

TEST(BatchSchedule, NothingIsNoBatch)
{
    EXPECT_TRUE(expect_sound(3, {}).empty());
}

TEST(BatchSchedule, OneGroup)
{
    EXPECT_EQ(expect_sound(2, edges_between({{0, 1}})).size(), 1u);
}

// Groups without common vertices fill every lane.
TEST(BatchSchedule, DisjointGroupsFillAllLanes)
{
    std::vector<std::array<int, 2>> edges;
    for (int e = 0; e < 100; ++e) edges.push_back({2 * e, 2 * e + 1});
    const Batches batches = expect_sound(200, edges_between(edges));
    ASSERT_EQ(batches.size(), 7u);
    for (std::size_t b = 0; b + 1 < batches.size(); ++b) EXPECT_EQ(batches[b].size(), 16u);
}

// One group per batch, with an empty batch between two: the only possible schedule.
TEST(BatchSchedule, AllGroupsShareOneVertex)
{
    std::vector<std::array<int, 2>> edges;
    for (int i = 1; i <= 40; ++i) edges.push_back({0, i});
    const Batches batches = expect_sound(41, edges_between(edges));
    ASSERT_EQ(batches.size(), 79u);
    for (std::size_t b = 0; b < batches.size(); ++b) EXPECT_EQ(batches[b].size(), b % 2 == 0 ? 1u : 0u);
}

TEST(BatchSchedule, TwoGroupsOnTheSameVertices)
{
    EXPECT_EQ(expect_sound(2, edges_between({{0, 1}, {1, 0}})).size(), 3u);
}

// Each edge waits for the one before, and pauses for one batch: the only possible schedule that keeps the order.
TEST(BatchSchedule, AChainOfEdgesKeepsItsOrder)
{
    std::vector<std::array<int, 2>> edges;
    for (int i = 0; i < 40; ++i) edges.push_back({i, i + 1});
    const Batches batches = expect_sound(41, edges_between(edges));
    ASSERT_EQ(batches.size(), 79u);
    for (std::size_t b = 0; b < batches.size(); ++b) EXPECT_EQ(batches[b], b % 2 == 0 ? std::vector<int>{int(b) / 2} : std::vector<int>{});
}

// The chain in two colours: first every other edge, then those between. Each half has 200 edges in 13 batches.
TEST(BatchSchedule, AChainOfEdgesByColours)
{
    std::vector<std::array<int, 2>> edges;
    for (const int colour : {0, 1})
        for (int i = colour; i < 400; i += 2) edges.push_back({i, i + 1});
    EXPECT_LE(expect_sound(401, edges_between(edges)).size(), 2u * 13);
}

// Thirty edges without neighbours come before a chain in the order given, and fill its lanes nevertheless.
TEST(BatchSchedule, TheLongestChainComesFirst)
{
    std::vector<std::array<int, 2>> edges;
    for (int i = 0; i < 30; ++i) edges.push_back({100 + 2 * i, 101 + 2 * i});
    for (int i = 0; i < 10; ++i) edges.push_back({i, i + 1});
    const Batches batches = expect_sound(160, edges_between(edges));
    ASSERT_EQ(batches.size(), 19u);
    EXPECT_EQ(batches[0].front(), 30);
    EXPECT_EQ(batches[0].size(), 16u);
}

TEST(BatchSchedule, EveryKindOfGroupOnABar)
{
    const pbs::TetMesh bar = structured_bar({0, 0, 0}, {10, 4, 4}, {10, 4, 4});
    const int vertices = static_cast<int>(bar.rest.rows());
    const auto edges = rows_of(pbs::edges_of(bar.tets));
    std::map<pbs::GroupKind, std::vector<ConstraintGroup>> by_kind;
    for (const auto& groups : {pbs::single_edges(edges), pbs::single_tets(rows_of(bar.tets)), pbs::grouped_edges(edges, bar.tets),
                               pbs::grouped_tets(rows_of(bar.tets))})
        for (const ConstraintGroup& group : groups) by_kind[group.kind].push_back(group);
    BatchScheduler scheduler(vertices);
    for (const auto& [kind, groups] : by_kind) expect_sound(scheduler, groups);
    EXPECT_LE(by_kind.size(), 7u);
    EXPECT_GE(by_kind.size(), 5u);
}

TEST(BatchSchedule, AClusterLeavesNoTraceForTheNext)
{
    const pbs::TetMesh bar = structured_bar({0, 0, 0}, {6, 3, 3}, {6, 3, 3});
    const auto tets = pbs::single_tets(rows_of(bar.tets));
    BatchScheduler scheduler(static_cast<int>(bar.rest.rows()));
    const Batches first = expect_sound(scheduler, tets);
    EXPECT_EQ(expect_sound(scheduler, tets), first);
}

}  // namespace
