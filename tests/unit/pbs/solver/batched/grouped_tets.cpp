// Reference: each tet in one group with its own orientation, and small meshes whose fans are counted by hand.
#include "tests/support/expect_groups.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/tet_rings.hpp"

namespace {

using namespace test_support;
using pbs::GroupKind;
using pbs::Tets;
using TetList = std::vector<std::array<int, 4>>;
using Counts = std::map<GroupKind, int>;

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
