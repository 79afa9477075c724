// Reference: Eq. 2 evaluated by hand.
#include "pbs/skinning/weights.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::Vec3;

pbs::Weights weights_at(const pbs::Skeleton& skeleton, const Vec3& vertex)
{
    const pbs::BoneBinding binding = pbs::bind_to_nearest_bone(pbs::Positions(vertex.transpose()), skeleton);
    return pbs::paper_weights(binding, skeleton);
}

// A palm with three fingers that start at its tail.
pbs::Skeleton palm()
{
    return {{{"palm", -1, {0, 0, 0}, {1, 0, 0}},
             {"thumb", 0, {1, 0, 0}, {1, 1, 0}},
             {"middle", 0, {1, 0, 0}, {2, 0, 0}},
             {"little", 0, {1, 0, 0}, {1, -1, 0}}}};
}

TEST(PaperWeights, AreOneInTheMiddle)
{
    const pbs::Weights weights = weights_at(palm(), {0.5, 0.1, 0});
    EXPECT_EQ(weights.bone, std::vector{0});
    EXPECT_EQ(weights.weight, std::vector{1.0});
    EXPECT_FALSE(weights.blended(0));
}

TEST(PaperWeights, AreSharedByTheBonesAtTheJoint)
{
    const pbs::Weights weights = weights_at(palm(), {0.9, 0.01, 0});
    EXPECT_EQ(weights.bone, (std::vector{0, 1, 2, 3}));
    EXPECT_EQ(weights.weight, std::vector(4, 0.25));
    EXPECT_TRUE(weights.blended(0));
    EXPECT_EQ(weights_at(palm(), {1.1, 0.01, 0}).bone, (std::vector{2, 0, 1, 3}));  // the same four bones from the other side
}

TEST(PaperWeights, AreOneWhereOnlyOneBoneMeets)
{
    for (const Vec3& vertex : {Vec3(0.05, 0.1, 0), Vec3(-0.5, 0, 0), Vec3(2.5, 0, 0)}) {
        const pbs::Weights weights = weights_at(palm(), vertex);
        EXPECT_EQ(weights.weight, std::vector{1.0}) << vertex.transpose();
    }
}

TEST(PaperWeights, BoundsAreInclusive)
{
    const pbs::Skeleton skeleton = {{{"a", -1, {-6, 0, 0}, {0, 0, 0}}, {"b", 0, {0, 0, 0}, {6, 0, 0}}}};
    EXPECT_FALSE(weights_at(skeleton, {1, 0, 0}).blended(0));   // t = 1/6 of b
    EXPECT_FALSE(weights_at(skeleton, {-1, 0, 0}).blended(0));  // t = 5/6 of a
    EXPECT_TRUE(weights_at(skeleton, {0.999, 0, 0}).blended(0));
    EXPECT_TRUE(weights_at(skeleton, {-0.999, 0, 0}).blended(0));
}

TEST(PaperWeights, SingleBone)
{
    const pbs::Skeleton single = {{{"only", -1, {0, 0, 0}, {1, 0, 0}}}};
    for (const double x : {-1.0, 0.0, 0.5, 1.0, 2.0}) EXPECT_EQ(weights_at(single, {x, 0, 0}).weight, std::vector{1.0});
}

TEST(PaperWeights, ZeroLengthBoneIsSharedAtItsJoint)
{
    const pbs::Skeleton skeleton = {{{"point", -1, {0, 0, 0}, {0, 0, 0}}, {"bone", 0, {0, 0, 0}, {1, 0, 0}}}};
    const pbs::Weights weights = weights_at(skeleton, {-0.5, 0, 0});
    EXPECT_EQ(weights.bone, (std::vector{0, 1}));
    EXPECT_EQ(weights.weight, (std::vector{0.5, 0.5}));
}

TEST(PaperWeights, SumToOne)
{
    for (double x = -0.5; x < 2.5; x += 0.01) {
        const pbs::Weights weights = weights_at(palm(), {x, 0.02, 0.01});
        double sum = 0.0;
        for (const double weight : weights.weight) sum += weight;
        EXPECT_NEAR(sum, 1.0, test_support::mean_error(weights.weight.size(), 1.0));
    }
}

TEST(RigidWeights, AreTheNearestBoneAlone)
{
    pbs::Positions rest(2, 3);
    rest << 0.95, 0, 0, 1.9, 0, 0;
    const pbs::Weights weights = pbs::rigid_weights(pbs::bind_to_nearest_bone(rest, palm()));
    EXPECT_EQ(weights.vertices(), 2);
    EXPECT_EQ(weights.bone, (std::vector{0, 2}));
    EXPECT_EQ(weights.weight, (std::vector{1.0, 1.0}));
}

// Bones a, b, c in a row: b touches a and c; near its far end, a touches only b.
TEST(EitherEndWeights, AreOfAllBonesThatTouchTheBone)
{
    const pbs::Skeleton row = {{{"a", -1, {-3, 0, 0}, {0, 0, 0}}, {"b", 0, {0, 0, 0}, {3, 0, 0}}, {"c", 1, {3, 0, 0}, {6, 0, 0}}}};
    pbs::Positions rest(3, 3);
    rest << 2.9, 0.1, 0, 1.5, 0.1, 0, -2.9, 0.1, 0;
    const pbs::Weights weights = pbs::either_end_weights(pbs::bind_to_nearest_bone(rest, row), row);
    EXPECT_EQ(weights.first, (std::vector{0, 3, 4, 6}));
    EXPECT_EQ(weights.bone, (std::vector{1, 0, 2, 1, 0, 1}));
    EXPECT_EQ(weights.weight, (std::vector{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, 1.0, 0.5, 0.5}));
}

}  // namespace
