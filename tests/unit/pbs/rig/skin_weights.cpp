// Reference: the definition. The weights of a point are those of its joints divided by their sum.
#include "pbs/rig/skin_weights.hpp"

#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace pbs;

Weights weights_of_one_point(const std::vector<JointShare>& shares, std::vector<std::string>& remarks)
{
    SkinWeights skin;
    skin.add_point(shares);
    return skin.normalised("a.glb", "arm", remarks);
}

TEST(SkinWeights, AreKeptWhereTheySumToOne)
{
    std::vector<std::string> remarks;
    SkinWeights skin;
    skin.add_point({{2, 0.25}, {0, 0.75}});
    skin.add_point({{1, 1.0}});
    const Weights weights = skin.normalised("a.glb", "arm", remarks);
    EXPECT_EQ(weights.first, (std::vector<int>{0, 2, 3}));
    EXPECT_EQ(weights.bone, (std::vector<int>{2, 0, 1}));
    EXPECT_EQ(weights.weight, (std::vector<double>{0.25, 0.75, 1.0}));
    EXPECT_TRUE(remarks.empty());
}

TEST(SkinWeights, AreDividedByTheirSumWithARemark)
{
    std::vector<std::string> remarks;
    const Weights weights = weights_of_one_point({{0, 1.0}, {1, 3.0}}, remarks);
    EXPECT_EQ(weights.weight, (std::vector<double>{0.25, 0.75}));
    ASSERT_EQ(remarks.size(), 1u);
    EXPECT_NE(remarks[0].find("1 of the 1 points of mesh arm do not sum to one"), std::string::npos) << remarks[0];
}

TEST(SkinWeights, WithinAThousandthOfOneTheSumNeedsNoRemark)
{
    std::vector<std::string> remarks;
    const Weights weights = weights_of_one_point({{0, 0.5}, {1, 0.5009}}, remarks);
    EXPECT_DOUBLE_EQ(weights.weight[0] + weights.weight[1], 1.0);
    EXPECT_TRUE(remarks.empty());
}

TEST(SkinWeights, OfAJointThatOccursTwiceAreAdded)
{
    std::vector<std::string> remarks;
    const Weights weights = weights_of_one_point({{3, 0.25}, {1, 0.5}, {3, 0.25}}, remarks);
    EXPECT_EQ(weights.bone, (std::vector<int>{3, 1}));
    EXPECT_EQ(weights.weight, (std::vector<double>{0.5, 0.5}));
}

TEST(SkinWeights, OfZeroAreLeftOut)
{
    std::vector<std::string> remarks;
    EXPECT_EQ(weights_of_one_point({{0, 0.0}, {1, 1.0}}, remarks).bone, std::vector<int>{1});
    EXPECT_TRUE(remarks.empty());
}

TEST(SkinWeights, APointWithoutAnyFollowsTheFirstJointWithARemark)
{
    for (const std::vector<JointShare>& shares : {std::vector<JointShare>{}, {{1, 0.0}, {2, 0.0}}}) {
        SkinWeights skin;
        skin.add_point({{2, 1.0}});
        skin.add_point(shares);
        std::vector<std::string> remarks;
        const Weights weights = skin.normalised("a.glb", "arm", remarks);
        EXPECT_EQ(weights.bone, (std::vector<int>{2, 0}));
        EXPECT_EQ(weights.weight, (std::vector<double>{1.0, 1.0}));
        ASSERT_EQ(remarks.size(), 1u);
        EXPECT_NE(remarks[0].find("1 of the 2 points of mesh arm have no weight"), std::string::npos) << remarks[0];
    }
}

TEST(SkinWeights, AMeshWithoutAnyIsRefused)
{
    std::vector<std::string> remarks;
    expect_input_error(
        [&] {
            weights_of_one_point({{1, 0.0}}, remarks);
        },
        "a.glb: mesh arm, weights = 0: ", "expected a point with a weight");
}

TEST(SkinWeights, ThatAreNegativeOrNotFiniteAreRefusedByPoint)
{
    constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [weight, text] : {std::pair(-0.5, "-0.5"), std::pair(nan, "nan"), std::pair(infinity, "inf")}) {
        SkinWeights skin;
        skin.add_point({{0, 1.0}});
        skin.add_point({{0, 1.0}, {1, weight}});
        std::vector<std::string> remarks;
        expect_input_error([&] { skin.normalised("a.glb", "arm", remarks); },
                           std::string("a.glb: mesh arm, weight of point 1 = ") + text + ": ", "expected a finite number of 0 or more");
    }
}

}  // namespace
