// Reference: colours found by hand, the definition of a colouring, and the same projections in random sequences.
#include "pbs/packed/groups.hpp"

#include "pbs/constraints/volume.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/solver/projection.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/tet_rings.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using namespace test_support;
using pbs::ConstraintGroup;
using pbs::projection_sequence;

void expect_a_sequence(const std::vector<ConstraintGroup>& groups, int vertices)
{
    std::vector<int> places = projection_sequence(groups, vertices);
    ASSERT_EQ(places.size(), groups.size());
    std::sort(places.begin(), places.end());
    for (std::size_t i = 0; i < places.size(); ++i) ASSERT_EQ(places[i], static_cast<int>(i));
}

TEST(ProjectionSequence, NoGroups)
{
    EXPECT_TRUE(projection_sequence({}, 3).empty());
    EXPECT_TRUE(projection_sequence({}, 0).empty());
}

// Two colours: 0, 2, 4 and then 1, 3.
TEST(ProjectionSequence, AChainOfEdges)
{
    EXPECT_EQ(projection_sequence(pbs::single_edges({{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}}), 6), (std::vector<int>{0, 3, 1, 4, 2}));
}

TEST(ProjectionSequence, GroupsWithoutNeighboursKeepTheirOrder)
{
    EXPECT_EQ(projection_sequence(pbs::single_edges({{6, 7}, {0, 1}, {4, 5}, {2, 3}}), 8), (std::vector<int>{0, 1, 2, 3}));
}

//                   face  edge  vertex
// A  0 1 2 3           0     0     0
// B  0 1 4 5           0     1     1     an edge with A
// C  0 6 7 8           0     0     2     a vertex with A and B
// D  1 2 3 9           1     1     2     a face with A, a vertex with B
// Ascending by face, descending by edge, ascending by vertex: B, A, C, D.
TEST(ProjectionSequence, TetsByFaceThenEdgeThenVertex)
{
    const std::vector<std::array<int, 4>> tets = {{0, 1, 2, 3}, {0, 1, 4, 5}, {0, 6, 7, 8}, {1, 2, 3, 9}};
    EXPECT_EQ(projection_sequence(pbs::single_tets(tets), 10), (std::vector<int>{1, 0, 2, 3}));
}

// The same tets twice share four vertices, which is a face and more.
TEST(ProjectionSequence, TheSameTetTwice)
{
    EXPECT_EQ(projection_sequence(pbs::single_tets({{0, 1, 2, 3}, {3, 2, 1, 0}}), 4), (std::vector<int>{0, 1}));
}

// Fans 0 1 | 2 3 4 and 0 1 | 5 6 7 share an edge. It does not count in groups of several tets, so the first one stays first.
TEST(ProjectionSequence, SharedEdgesDoNotCountBetweenFans)
{
    const ConstraintGroup one{pbs::GroupKind::tet_fan_2, {0, 1, 2, 3, 4}, {0, 1}},
        other{pbs::GroupKind::tet_fan_2, {0, 1, 5, 6, 7}, {2, 3}};
    EXPECT_EQ(projection_sequence({one, other}, 8), (std::vector<int>{0, 1}));
}

TEST(ProjectionSequence, EveryGroupOfABarHasOnePlace)
{
    const pbs::TetMesh bar = structured_bar({0, 0, 0}, {10, 4, 4}, {10, 4, 4});
    const int vertices = static_cast<int>(bar.rest.rows());
    const auto edges = rows_of(pbs::edges_of(bar.tets));
    const auto tets = rows_of(bar.tets);
    for (const auto& groups :
         {pbs::single_edges(edges), pbs::single_tets(tets), pbs::grouped_edges(edges, bar.tets), pbs::grouped_tets(tets)})
        expect_a_sequence(groups, vertices);
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

// This is the purpose of the sequence. Random sequences differ by 2 to 4 % among themselves; a sweep along the bar is behind their median.
TEST(ProjectionSequence, LeavesNoMoreVolumeChangeThanRandomSequences)
{
    for (const auto& [axis, angle_deg] : {std::pair(pbs::Vec3(pbs::Vec3::UnitX()), 150.0), {pbs::Vec3(pbs::Vec3::UnitZ()), 90.0}}) {
        const TwoBoneLimb limb = two_bone_limb({16, 4, 4}, axis, angle_deg);
        const auto constraints = pbs::make_constraint_set<double>(limb.mesh, limb.binding.distance, {}, pbs::PbsOptions());
        EXPECT_LE(volume_change(limb, constraints, pbs::Order::ordered), median_of_random_sequences(limb, constraints)) << angle_deg;
    }
}

}  // namespace
