// Reference: colours found by hand, the definition of a colouring, and the same projections in random sequences.
#include "pbs/constraints/volume.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/packed/constraint_sequence.hpp"
#include "pbs/solver/projection.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/tet_rings.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

namespace {

using namespace test_support;
using pbs::PackedConstraint;
using pbs::projection_sequence;

TEST(PackedConstraints, AreTheConstraintsInTheOrderGiven)
{
    const std::vector<PackedConstraint> edges = pbs::packed_edges({{3, 1}, {0, 2}}),
                                        tets = pbs::packed_tets({{4, 2, 7, 1}});
    ASSERT_EQ(edges.size(), 2u);
    ASSERT_EQ(tets.size(), 1u);
    EXPECT_EQ(std::pair(edges[0].vertex[0], edges[0].vertex[1]), std::pair(3, 1));
    EXPECT_EQ(std::pair(edges[1].vertex[0], edges[1].vertex[1]), std::pair(0, 2));
    EXPECT_EQ(std::pair(edges[0].constraint, edges[1].constraint), std::pair(0, 1));
    EXPECT_EQ(tets[0].vertex, (std::array{4, 2, 7, 1}));
    EXPECT_EQ(std::pair(edges[0].kind, tets[0].kind), std::pair(pbs::ConstraintKind::edge, pbs::ConstraintKind::tet));
    EXPECT_TRUE(pbs::packed_edges({}).empty() && pbs::packed_tets({}).empty());
}

void expect_a_sequence(const std::vector<PackedConstraint>& constraints, int vertices)
{
    std::vector<int> places = projection_sequence(constraints, vertices);
    ASSERT_EQ(places.size(), constraints.size());
    std::sort(places.begin(), places.end());
    for (std::size_t i = 0; i < places.size(); ++i) ASSERT_EQ(places[i], static_cast<int>(i));
}

// A chain of edges has two colours: 0, 2, 4 and then 1, 3. The same tets twice share four vertices, which is a face and
// more.
//                   face  edge  vertex
// A  0 1 2 3           0     0     0
// B  0 1 4 5           0     1     1     an edge with A
// C  0 6 7 8           0     0     2     a vertex with A and B
// D  1 2 3 9           1     1     2     a face with A, a vertex with B
// Ascending by face, descending by edge, ascending by vertex: B, A, C, D.
TEST(ProjectionSequence, OfSmallMeshes)
{
    struct Case {
        const char* name;
        std::vector<PackedConstraint> constraints;
        int vertices;
        std::vector<int> expected;
    };
    const Case cases[] = {
        {"no constraints", {}, 3, {}},
        {"no vertices", {}, 0, {}},
        {"a chain of edges", pbs::packed_edges({{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}}), 6, {0, 3, 1, 4, 2}},
        {"constraints without neighbours", pbs::packed_edges({{6, 7}, {0, 1}, {4, 5}, {2, 3}}), 8, {0, 1, 2, 3}},
        {"tets A to D", pbs::packed_tets({{0, 1, 2, 3}, {0, 1, 4, 5}, {0, 6, 7, 8}, {1, 2, 3, 9}}), 10, {1, 0, 2, 3}},
        {"the same tet twice", pbs::packed_tets({{0, 1, 2, 3}, {3, 2, 1, 0}}), 4, {0, 1}},
    };
    for (const auto& [name, constraints, vertices, expected] : cases)
        EXPECT_EQ(projection_sequence(constraints, vertices), expected) << name;
}

TEST(ProjectionSequence, EveryConstraintOfABarHasOnePlace)
{
    const pbs::TetMesh bar = structured_bar({0, 0, 0}, {10, 4, 4}, {10, 4, 4});
    const int vertices = static_cast<int>(bar.rest.rows());
    const auto edges = rows_of(pbs::edges_of(bar.tets));
    const auto tets = rows_of(bar.tets);
    for (const auto& constraints : {pbs::packed_edges(edges), pbs::packed_tets(tets)})
        expect_a_sequence(constraints, vertices);
}

// 24 iterations from LBS: sum |V - V0| over the rest volume.
double volume_change(const TwoBoneLimb& limb, pbs::ConstraintSet<double> constraints, pbs::Order order)
{
    pbs::PbsOptions options;
    options.order = order;
    const auto projection = pbs::make_projection<double>(constraints, limb.mesh.tets, options);
    projection->load(limb.lbs, limb.bind_points, pbs::Vec3::Zero());
    for (int iteration = 0; iteration < options.iterations; ++iteration) {
        projection->project_bind_constraints();
        projection->project_stretch_constraints();
        projection->project_volume_constraints();
    }
    pbs::Positions p(limb.lbs.rows(), 3);
    projection->store(pbs::Vec3::Zero(), p);
    double change = 0.0, volume = 0.0;
    for (const auto& tet : constraints.volume) {
        const auto [i, j, k, l] = tet.vertex;
        change += std::abs(pbs::value<double>(tet, p.row(i), p.row(j), p.row(k), p.row(l)));
        volume += tet.rest_volume;
    }
    return change / volume;
}

double median_of_random_sequences(const TwoBoneLimb& limb, const pbs::ConstraintSet<double>& constraints)
{
    std::vector<double> changes;
    for (unsigned seed = 1; seed <= 5; ++seed) {
        std::mt19937 engine(seed);
        pbs::ConstraintSet<double> shuffled = constraints;
        std::shuffle(shuffled.stretch.begin(), shuffled.stretch.end(), engine);
        std::shuffle(shuffled.volume.begin(), shuffled.volume.end(), engine);
        changes.push_back(volume_change(limb, shuffled, pbs::Order::plain));
    }
    std::sort(changes.begin(), changes.end());
    return changes[2];
}

// This is the purpose of the sequence. Random sequences differ by 2 to 4 % among themselves; a sweep along the bar is
// behind their median.
TEST(ProjectionSequence, LeavesNoMoreVolumeChangeThanRandomSequences)
{
    for (const auto& [axis, angle_deg] :
         {std::pair(pbs::Vec3(pbs::Vec3::UnitX()), 150.0), {pbs::Vec3(pbs::Vec3::UnitZ()), 90.0}}) {
        const TwoBoneLimb limb = two_bone_limb({16, 4, 4}, axis, angle_deg);
        const auto constraints =
            pbs::make_constraint_set<double>(limb.mesh, limb.binding.distance, {}, pbs::PbsOptions());
        EXPECT_LE(volume_change(limb, constraints, pbs::Order::ordered), median_of_random_sequences(limb, constraints))
            << angle_deg;
    }
}

// Reference: the conditions on which the kernels rely, checked for every batch: at most sixteen constraints, no vertex
// twice, none of the previous batch; and the order given, which constraints that share a vertex keep.

using pbs::BatchScheduler;
using Batches = std::vector<std::vector<int>>;

Batches expect_sound(BatchScheduler& scheduler, const std::vector<PackedConstraint>& constraints)
{
    const Batches batches = scheduler.schedule(constraints);
    std::vector<int> uses(constraints.size(), 0);
    std::set<int> before;
    std::map<int, int> last_at;  // constraint that each vertex belonged to last
    for (const std::vector<int>& batch : batches) {
        EXPECT_LE(batch.size(), std::size_t(pbs::batch_size));
        std::set<int> touched;
        for (const int g : batch) {
            ++uses[g];
            for (int v = 0; v < pbs::corners(constraints[g].kind); ++v) {
                EXPECT_TRUE(touched.insert(constraints[g].vertex[v]).second)
                    << "twice in a batch: " << constraints[g].vertex[v];
                EXPECT_FALSE(before.contains(constraints[g].vertex[v]))
                    << "in the batch before: " << constraints[g].vertex[v];
                const auto [last, is_first] = last_at.try_emplace(constraints[g].vertex[v], g);
                EXPECT_TRUE(is_first || last->second < g) << "constraint " << g << " follows " << last->second;
                last->second = g;
            }
        }
        before = touched;
    }
    EXPECT_EQ(std::count(uses.begin(), uses.end(), 1), std::ptrdiff_t(constraints.size()));
    return batches;
}

Batches expect_sound(int vertices, const std::vector<PackedConstraint>& constraints)
{
    BatchScheduler scheduler(vertices);
    return expect_sound(scheduler, constraints);
}

TEST(BatchSchedule, OfFewConstraintsHasThisManyBatches)
{
    EXPECT_TRUE(expect_sound(3, {}).empty());
    EXPECT_EQ(expect_sound(2, pbs::packed_edges({{0, 1}})).size(), 1u);
    EXPECT_EQ(expect_sound(2, pbs::packed_edges({{0, 1}, {1, 0}})).size(), 3u)
        << "two constraints on the same vertices";
}

// Constraints without common vertices fill every lane. A chain in two colours has first every other edge, then those
// between, and each half has 200 edges in 13 batches.
TEST(BatchSchedule, DisjointConstraintsFillAllLanes)
{
    std::vector<std::array<int, 2>> disjoint, by_colours;
    for (int e = 0; e < 100; ++e) disjoint.push_back({2 * e, 2 * e + 1});
    const Batches batches = expect_sound(200, pbs::packed_edges(disjoint));
    ASSERT_EQ(batches.size(), 7u);
    for (std::size_t b = 0; b + 1 < batches.size(); ++b) EXPECT_EQ(batches[b].size(), 16u);
    for (const int colour : {0, 1})
        for (int i = colour; i < 400; i += 2) by_colours.push_back({i, i + 1});
    EXPECT_LE(expect_sound(401, pbs::packed_edges(by_colours)).size(), 2u * 13);
}

// One constraint per batch, with an empty batch between two: the only possible schedule. Each edge of a chain waits for
// the one before, and pauses for one batch, which alone keeps the order.
TEST(BatchSchedule, AllConstraintsShareOneVertexOrAreAChain)
{
    std::vector<std::array<int, 2>> star, chain;
    for (int i = 0; i < 40; ++i) star.push_back({0, i + 1}), chain.push_back({i, i + 1});
    const Batches of_star = expect_sound(41, pbs::packed_edges(star)),
                  of_chain = expect_sound(41, pbs::packed_edges(chain));
    ASSERT_EQ(of_star.size(), 79u);
    ASSERT_EQ(of_chain.size(), 79u);
    for (std::size_t b = 0; b < 79; ++b) {
        EXPECT_EQ(of_star[b].size(), b % 2 == 0 ? 1u : 0u);
        EXPECT_EQ(of_chain[b], b % 2 == 0 ? std::vector<int>{int(b) / 2} : std::vector<int>{});
    }
}

// Thirty edges without neighbours come before a chain in the order given, and fill its lanes nevertheless.
TEST(BatchSchedule, TheLongestChainComesFirst)
{
    std::vector<std::array<int, 2>> edges;
    for (int i = 0; i < 30; ++i) edges.push_back({100 + 2 * i, 101 + 2 * i});
    for (int i = 0; i < 10; ++i) edges.push_back({i, i + 1});
    const Batches batches = expect_sound(160, pbs::packed_edges(edges));
    ASSERT_EQ(batches.size(), 19u);
    EXPECT_EQ(batches[0].front(), 30);
    EXPECT_EQ(batches[0].size(), 16u);
}

TEST(BatchSchedule, EdgesAndTetsOfABar)
{
    const pbs::TetMesh bar = structured_bar({0, 0, 0}, {10, 4, 4}, {10, 4, 4});
    BatchScheduler scheduler(static_cast<int>(bar.rest.rows()));
    for (const auto& constraints :
         {pbs::packed_edges(rows_of(pbs::edges_of(bar.tets))), pbs::packed_tets(rows_of(bar.tets))})
        expect_sound(scheduler, constraints);
}

TEST(BatchSchedule, AClusterLeavesNoTraceForTheNext)
{
    const pbs::TetMesh bar = structured_bar({0, 0, 0}, {6, 3, 3}, {6, 3, 3});
    const auto tets = pbs::packed_tets(rows_of(bar.tets));
    BatchScheduler scheduler(static_cast<int>(bar.rest.rows()));
    const Batches first = expect_sound(scheduler, tets);
    EXPECT_EQ(expect_sound(scheduler, tets), first);
}

}  // namespace
