// Reference: the definition, on bars and tets that are counted by hand.
#include "pbs/geometry/parts.hpp"

#include "pbs/geometry/topology.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <random>

namespace {

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

TEST(Parts, OfOneBodyAreOne)
{
    const std::vector<int> parts = pbs::parts_of(test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {3, 2, 2}).tets);
    EXPECT_EQ(parts, std::vector<int>(72, 0));
}

TEST(Parts, AreNumberedInTheOrderOfTheirFirstTets)
{
    EXPECT_EQ(pbs::parts_of(two_bars().tets), (std::vector<int>{0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1}));
}

TEST(Parts, ThatShareAVertexOrAnEdgeAlone)
{
    EXPECT_EQ(pbs::parts_of((pbs::Tets(2, 4) << 0, 1, 2, 3, 0, 4, 5, 6).finished()), (std::vector<int>{0, 1}));
    EXPECT_EQ(pbs::parts_of((pbs::Tets(2, 4) << 0, 1, 2, 3, 0, 1, 5, 6).finished()), (std::vector<int>{0, 1}));
    EXPECT_EQ(pbs::parts_of((pbs::Tets(2, 4) << 0, 1, 2, 3, 4, 2, 1, 0).finished()), (std::vector<int>{0, 0}));
}

TEST(Parts, OfNoTetsAreNone)
{
    EXPECT_TRUE(pbs::parts_of(pbs::Tets(0, 4)).empty());
}

TEST(Parts, DoNotDependOnTheOrderOfTets)
{
    const pbs::TetMesh bars = two_bars();
    std::vector<int> order(12);
    for (int t = 0; t < 12; ++t) order[std::size_t(t)] = t;
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    pbs::Tets shuffled(12, 4);
    for (int t = 0; t < 12; ++t) shuffled.row(t) = bars.tets.row(order[std::size_t(t)]);
    const std::vector<int> parts = pbs::parts_of(shuffled);
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
}

TEST(KeptTets, AllAndNone)
{
    const pbs::TetMesh bars = two_bars();
    EXPECT_EQ(pbs::kept_tets(bars, std::vector<bool>(12, true)).tets, bars.tets);
    const pbs::TetMesh none = pbs::kept_tets(bars, std::vector<bool>(12, false));
    EXPECT_EQ(none.tets.rows(), 0);
    EXPECT_EQ(none.rest.rows(), 0);
}

}  // namespace
