// Eq. 2 as the published code reads it. Reference: the rule in author_solver.hpp, by hand.
#include "pbs/author/author_solver.hpp"

#include <gtest/gtest.h>

#include <map>

namespace {

using pbs::Vec3;

// A root along x with three children. Two start at its tail, one at its middle; one child has a sibling at its own head.
const pbs::Skeleton skeleton = {{{"root", -1, Vec3(0, 0, 0), Vec3(6, 0, 0)},
                                 {"up", 0, Vec3(6, 0, 0), Vec3(6, 6, 0)},
                                 {"down", 0, Vec3(6, 0, 0), Vec3(6, -6, 0)},
                                 {"middle", 0, Vec3(3, 0, 4), Vec3(3, 0, 10)},
                                 {"point", 1, Vec3(20, 20, 20), Vec3(20, 20, 20)}}};

std::map<int, double> weights_at(const Vec3& vertex)
{
    const pbs::Positions rest = vertex.transpose();
    const pbs::Weights weights = pbs::author_weights(pbs::bind_to_nearest_bone(rest, skeleton), skeleton);
    std::map<int, double> by_bone;
    for (int entry = weights.first[0]; entry < weights.first[1]; ++entry) by_bone[weights.bone[entry]] = weights.weight[entry];
    return by_bone;
}

using Expected = std::map<int, double>;

TEST(AuthorWeights, GiveTheMiddleToTheBoneAlone)
{
    EXPECT_EQ(weights_at({3.0, 0.1, 0.0}), (Expected{{0, 1.0}}));
}

TEST(AuthorWeights, GiveTheHeadOfARootToTheRootAlone)
{
    EXPECT_EQ(weights_at({0.5, 0.1, 0.0}), (Expected{{0, 1.0}}));
    EXPECT_EQ(weights_at({-1.0, 0.1, 0.0}), (Expected{{0, 1.0}}));
}

TEST(AuthorWeights, ShareTheTailWithAllChildrenWhereverTheyStart)
{
    EXPECT_EQ(weights_at({5.5, 0.0, 0.1}), (Expected{{0, 0.25}, {1, 0.25}, {2, 0.25}, {3, 0.25}}));
}

TEST(AuthorWeights, ShareTheHeadWithTheParentButNotWithSiblings)
{
    EXPECT_EQ(weights_at({6.0, 0.5, 0.1}), (Expected{{1, 0.5}, {0, 0.5}}));
    EXPECT_EQ(weights_at({3.0, 0.0, 4.5}), (Expected{{3, 0.5}, {0, 0.5}}));
}

TEST(AuthorWeights, GiveATailWithoutChildrenToTheBoneAlone)
{
    EXPECT_EQ(weights_at({6.0, -5.9, 0.0}), (Expected{{2, 1.0}}));
}

TEST(AuthorWeights, TakeTheHeadOfABoneWithoutLength)
{
    EXPECT_EQ(weights_at({20.0, 20.0, 21.0}), (Expected{{4, 0.5}, {1, 0.5}}));
}

}  // namespace
