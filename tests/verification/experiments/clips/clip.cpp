// Reference: an independent forward kinematics of BVH (bvh_kinematics.hpp) on a CMU clip, and a clip in closed form.
// Needs Debian's assimp-testmodels, which set-up installs.
#include "experiments/clips/clip.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/verification/experiments/characters/bvh_kinematics.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;
using test_support::rounding_error_in;

// assimp reads the time of a frame in single precision.
double of_time_s(double frame_time_s)
{
    return rounding_error_in<float>(1, frame_time_s);
}

TEST(ReadClip, AgreesWithIndependentKinematicsOnACmuClip)
{
    const std::string path = find_clip("01_01.bvh", ".");
    const bvh_kinematics::Bvh expected = bvh_kinematics::read(path);
    const Clip clip = read_clip(path);
    ASSERT_EQ(clip.frames(), 2752);
    ASSERT_EQ(static_cast<std::size_t>(clip.frames()), expected.frames.size());
    ASSERT_EQ(clip.joints.size(), expected.joints.size());
    EXPECT_NEAR(clip.frame_time_s, expected.frame_time_s, of_time_s(expected.frame_time_s));

    double largest = 0.0;
    for (int frame = 0; frame < clip.frames(); frame += 10) {
        const Positions& positions = clip.places[frame];
        const std::vector<Eigen::Isometry3d> joints = bvh_kinematics::forward(expected, expected.frames[frame]);
        for (std::size_t j = 0; j < joints.size(); ++j) {
            ASSERT_EQ(clip.joints[j], expected.joints[j].name);
            largest = std::max(largest, (Vec3(positions.row(j)) - joints[j].translation()).norm());
        }
    }
    RecordProperty("largest_difference_clip_units", std::to_string(largest));
    // assimp computes in single precision, with coordinates up to 30 units, over a chain of 9 joints with three
    // products of rotations each, of which each is rounded twice, as a product and as a sum.
    EXPECT_LT(largest, rounding_error_in<float>(2 * 3 * 9, 30.0));
}

const char* const closed_form = R"(HIERARCHY
ROOT upper
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
  JOINT forearm
  {
    OFFSET 2 0 0
    CHANNELS 3 Zrotation Yrotation Xrotation
    End Site
    {
      OFFSET 0 3 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.025
1 2 3 0 0 0 0 0 0
-1 0 5 90 0 0 0 0 90
)";

TEST(ReadClip, ClosedForm)
{
    const test_support::ScratchFolder folder;
    const Clip clip = read_clip(folder.file("closed.bvh", closed_form));
    ASSERT_EQ(clip.frames(), 2);
    EXPECT_NEAR(clip.frame_time_s, 0.025, of_time_s(0.025));
    EXPECT_EQ(clip.joints, (std::vector<std::string>{"upper", "forearm", "EndSite_forearm"}));
    EXPECT_EQ(clip.parent, (std::vector<int>{-1, 0, 1}));
    Positions zero(3, 3), turned(3, 3);
    zero << 0, 0, 0, 2, 0, 0, 2, 3, 0;
    // The root turns x to y; the forearm turns its y to z about its own x, so the end site points along the world's z.
    turned << -1, 0, 5, -1, 2, 5, -1, 2, 8;
    EXPECT_EQ(clip.zero_pose, zero);
    EXPECT_EQ(clip.places[0], zero.rowwise() + Eigen::RowVector3d(1, 2, 3));
    // In single precision, a quarter turn and its quaternion go through some eight roundings, twice, on a path of 5 m.
    EXPECT_LT((clip.places[1] - turned).cwiseAbs().maxCoeff(), rounding_error_in<float>(2 * 8, 5.0));
}

TEST(ReadClip, OtherFormatsThanBvh)
{
    // assimp's own simple_skin.gltf from the glTF tutorial: joint 2 turns about z to 90 degrees and back, 5.5 s.
    const Clip clip = read_clip("/usr/share/assimp/models/glTF2/simple_skin/simple_skin.gltf");
    EXPECT_NEAR(clip.frames() * clip.frame_time_s, 5.5, clip.frame_time_s);  // whole frames
    double largest = 0.0;
    for (const auto& frame : clip.local)
        for (const Eigen::Quaterniond& rotation : frame)
            largest = std::max(largest, rotation.angularDistance(Eigen::Quaterniond::Identity()));
    // The file's quaternions are in single precision, and each has an angle of half a turn of its rotation.
    EXPECT_NEAR(largest, M_PI / 2.0, 2.0 * rounding_error_in<float>(8, 1.0));
}

// The skeleton of a clip's file. Reference: the offsets in the header of CMU's 01_01.bvh, and the clip's own
// kinematics.

const Clip& cmu_clip()
{
    static const Clip read = read_clip(find_clip("01_01.bvh", "."));
    return read;
}

TEST(SkeletonFromClip, BonesAreTheOffsetsOfTheFile)
{
    const Skeleton skeleton = skeleton_from_clip(cmu_clip(), 1.0);
    const int thigh = find_bone(skeleton, "LeftUpLeg");
    ASSERT_GE(thigh, 0);
    const Bone& bone = skeleton.bones[thigh];
    // In single precision: both ends are sums of offsets, up to 10 units long.
    EXPECT_NEAR((bone.tail - bone.head - Vec3(2.44811, -6.72613, 0.0)).norm(), 0.0,
                rounding_error_in<float>(2 * 3, 10.0));
    EXPECT_EQ(skeleton.bones[bone.parent].name, "LHipJoint");
}

TEST(SkeletonFromClip, NoBoneIsAPointAndParentsComeFirst)
{
    const Skeleton skeleton = skeleton_from_clip(cmu_clip(), 1.0);
    EXPECT_GT(skeleton.bones.size(), 20u);
    for (std::size_t b = 0; b < skeleton.bones.size(); ++b) {
        EXPECT_GT((skeleton.bones[b].tail - skeleton.bones[b].head).norm(), 0.0) << skeleton.bones[b].name;
        EXPECT_LT(skeleton.bones[b].parent, static_cast<int>(b)) << skeleton.bones[b].name;
    }
    EXPECT_EQ(find_bone(skeleton, "Hips"), -1);  // coincides with all its children
}

TEST(SkeletonFromClip, ScaleIsMetresAUnit)
{
    const Skeleton unit = skeleton_from_clip(cmu_clip(), 1.0), metres = skeleton_from_clip(cmu_clip(), 0.0254 / 0.45);
    for (std::size_t b = 0; b < unit.bones.size(); ++b)
        EXPECT_EQ(metres.bones[b].tail, 0.0254 / 0.45 * unit.bones[b].tail);
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
