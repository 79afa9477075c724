// The skeleton of a clip's file. Reference: the offsets in the header of CMU's 01_01.bvh, and the clip's own kinematics.
#include "pbs/character/clip.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

const Clip& clip()
{
    static const Clip read = read_clip(find_clip("01_01.bvh", "."));
    return read;
}

TEST(SkeletonFromClip, BonesAreTheOffsetsOfTheFile)
{
    const Skeleton skeleton = skeleton_from_clip(clip(), 1.0);
    const int thigh = find_bone(skeleton, "LeftUpLeg");
    ASSERT_GE(thigh, 0);
    const Bone& bone = skeleton.bones[thigh];
    // In single precision: both ends are sums of offsets, up to 10 units long.
    EXPECT_NEAR((bone.tail - bone.head - Vec3(2.44811, -6.72613, 0.0)).norm(), 0.0, test_support::rounding_error_in<float>(2 * 3, 10.0));
    EXPECT_EQ(skeleton.bones[bone.parent].name, "LHipJoint");
}

TEST(SkeletonFromClip, NoBoneIsAPointAndParentsComeFirst)
{
    const Skeleton skeleton = skeleton_from_clip(clip(), 1.0);
    EXPECT_GT(skeleton.bones.size(), 20u);
    for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
        EXPECT_GT((skeleton.bones[b].tail - skeleton.bones[b].head).norm(), 0.0) << skeleton.bones[b].name;
        EXPECT_LT(skeleton.bones[b].parent, static_cast<int>(b)) << skeleton.bones[b].name;
    }
    EXPECT_EQ(find_bone(skeleton, "Hips"), -1);  // coincides with all its children
}

TEST(SkeletonFromClip, ScaleIsMetresAUnit)
{
    const Skeleton unit = skeleton_from_clip(clip(), 1.0), metres = skeleton_from_clip(clip(), 0.0254 / 0.45);
    for (std::size_t b = 0; b < unit.bones.size(); ++b) EXPECT_EQ(metres.bones[b].tail, 0.0254 / 0.45 * unit.bones[b].tail);
}

TEST(SkeletonFromClip, JointsInOnePlaceAreRefused)
{
    Clip point;
    point.name = "point.bvh";
    point.joints = {"a", "b"};
    point.parent = {-1, 0};
    point.zero_pose = Positions::Zero(2, 3);
    EXPECT_THROW(skeleton_from_clip(point, 1.0), InputError);
}

}  // namespace
