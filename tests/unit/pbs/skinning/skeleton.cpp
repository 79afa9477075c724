// Reference: the bones that meet at each point, read from the drawing.
#include "pbs/skinning/pose.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::BoneEnd;
using Indices = std::vector<int>;

// A pelvis with two hips that start at its head, a spine that starts at its tail, and a thigh on the left hip.
pbs::Skeleton body()
{
    return {{{"pelvis", -1, {0, 1, 0}, {0, 1.2, 0}},
             {"spine", 0, {0, 1.2, 0}, {0, 1.6, 0}},
             {"hip.L", 0, {0, 1, 0}, {-0.1, 0.95, 0}},
             {"hip.R", 0, {0, 1, 0}, {0.1, 0.95, 0}},
             {"thigh.L", 2, {-0.1, 0.95, 0}, {-0.1, 0.5, 0}}}};
}

TEST(FindBone, ByName)
{
    EXPECT_EQ(pbs::find_bone(body(), "hip.R"), 3);
    EXPECT_EQ(pbs::find_bone(body(), "tail"), -1);
}

TEST(BonesMeeting, AtAHeadAreParentAndSiblingsThatStartThere)
{
    EXPECT_EQ(pbs::bones_meeting(body(), 2, BoneEnd::head), (Indices{2, 0, 3}));
    EXPECT_EQ(pbs::bones_meeting(body(), 1, BoneEnd::head), (Indices{1, 0}));  // the hips start elsewhere
}

TEST(BonesMeeting, AtATailAreChildrenThatStartThere)
{
    EXPECT_EQ(pbs::bones_meeting(body(), 0, BoneEnd::tail), (Indices{0, 1}));
    EXPECT_EQ(pbs::bones_meeting(body(), 2, BoneEnd::tail), (Indices{2, 4}));
}

TEST(BonesMeeting, AtARootsHeadAreChildrenThatStartThere)
{
    EXPECT_EQ(pbs::bones_meeting(body(), 0, BoneEnd::head), (Indices{0, 2, 3}));
}

TEST(BonesMeeting, AtAFreeEndIsTheBoneAlone)
{
    EXPECT_EQ(pbs::bones_meeting(body(), 4, BoneEnd::tail), Indices{4});
}

TEST(BonesMeeting, IsWithinTwoPercentOfTheDiagonal)
{
    pbs::Skeleton skeleton = {{{"a", -1, {0, 0, 0}, {1, 0, 0}}, {"b", 0, {1, 0.019, 0}, {1, 0, 0}}}};
    EXPECT_EQ(pbs::bones_meeting(skeleton, 0, BoneEnd::tail), (Indices{0, 1}));
    skeleton.bones[1].head.y() = 0.021;
    EXPECT_EQ(pbs::bones_meeting(skeleton, 0, BoneEnd::tail), Indices{0});
}

TEST(BonesMeeting, SingleBone)
{
    const pbs::Skeleton skeleton = {{{"only", -1, {0, 0, 0}, {1, 0, 0}}}};
    EXPECT_EQ(pbs::bones_meeting(skeleton, 0, BoneEnd::head), Indices{0});
    EXPECT_EQ(pbs::bones_meeting(skeleton, 0, BoneEnd::tail), Indices{0});
}

TEST(BonesMeeting, ZeroLengthBone)
{
    const pbs::Skeleton skeleton = {{{"a", -1, {0, 0, 0}, {1, 0, 0}}, {"point", 0, {1, 0, 0}, {1, 0, 0}}, {"c", 1, {1, 0, 0}, {2, 0, 0}}}};
    EXPECT_EQ(pbs::bones_meeting(skeleton, 1, BoneEnd::head), (Indices{1, 0, 2}));
}

}  // namespace
