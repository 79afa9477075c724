// The motion of a scene with its remarks. Reference: clips and a model written here, whose joints and angles are known.
#include "experiments/scene/scene.hpp"

#include "pbs/character/model_character.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/rigged_gltf.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

// A BVH chain of these joints; each turns by 30 degrees per frame about z, in three frames after a first one at rest.
std::string chain(const std::vector<std::string>& names)
{
    std::string text = "HIERARCHY\n", end, rows;
    for (const std::string& name : names) {
        const bool is_root = name == names.front();
        text += std::string(is_root ? "ROOT " : "JOINT ") + name + "\n{\nOFFSET " + (is_root ? "-1" : "1") + " 0 0\nCHANNELS " +
                (is_root ? "6 Xposition Yposition Zposition " : "3 ") + "Zrotation Xrotation Yrotation\n";
        end += "}\n";
    }
    for (const int angle_deg : {0, 0, 30, 60}) {
        rows += "-1 0 0";
        for (std::size_t joint = 0; joint < names.size(); ++joint) rows += " " + std::to_string(angle_deg) + " 0 0";
        rows += "\n";
    }
    return text + "End Site\n{\nOFFSET 1 0 0\n}\n" + end + "MOTION\nFrames: 4\nFrame Time: 0.01\n" + rows;
}

class MotionCase : public testing::Test {
protected:
    MotionCase() : character(test_support::bar_character({4, 1, 1})) {}

    CaseMotion made(const MotionSpec& spec) const { return make_case_motion(spec, character, "scene.toml"); }

    MotionSpec clip(const std::vector<std::string>& names) const
    {
        MotionSpec spec;
        spec.clip = folder.file("walk.bvh", chain(names));
        return spec;
    }

    pbs::Character character;
    test_support::ScratchFolder folder;
};

TEST_F(MotionCase, ASweepTurnsItsJoint)
{
    MotionSpec sweep;
    sweep.joint = "forearm";
    sweep.angle_deg = 60.0;
    sweep.frames = 3;
    const CaseMotion motion = made(sweep);
    EXPECT_NEAR(motion.largest_rotation_deg, 60.0, 1e-10);
    EXPECT_EQ(motion.motion.frames(), 3);
    EXPECT_TRUE(motion.remarks.empty());
    sweep.joint = "tail";
    expect_input_error([&] { made(sweep); }, "scene.toml: motion.joint = tail: ", "expected one of upper, forearm");
}

TEST_F(MotionCase, AMotionInWhichNothingTurnsIsRemarkedOn)
{
    MotionSpec sweep;
    sweep.joint = "forearm";
    sweep.angle_deg = 0.05;
    sweep.frames = 2;  // about the axis of the bone
    EXPECT_EQ(made(sweep).remarks,
              std::vector<std::string>{"scene.toml: no joint moves: the bones turn by at most 0.05 degrees and move by at most 0 m"});
    sweep.angle_deg = 0.2;
    EXPECT_TRUE(made(sweep).remarks.empty());
}

TEST_F(MotionCase, AClipWhoseJointsAllMatch)
{
    const CaseMotion motion = made(clip({"upper", "forearm"}));
    EXPECT_EQ(motion.clip_joints, 2);
    EXPECT_EQ(motion.matched_joints, 2);
    EXPECT_EQ(motion.partial_match, "");
    EXPECT_TRUE(motion.remarks.empty());
    EXPECT_NEAR(motion.largest_rotation_deg, 120.0, 1e-3);  // the forearm follows both joints; BVH's numbers are single precision
}

TEST_F(MotionCase, AClipThatMatchesInPartNamesTheOthers)
{
    const MotionSpec walk = clip({"upper", "forearm", "hand"});
    const CaseMotion motion = made(walk);
    EXPECT_EQ(motion.clip_joints, 3);
    EXPECT_EQ(motion.matched_joints, 2);
    EXPECT_EQ(motion.partial_match, walk.clip + ": 2 of 3 moving joints of the clip match a bone; without a bone: hand");
    EXPECT_TRUE(motion.remarks.empty());  // the run remarks on it, unless the body is made for other clips too
}

TEST_F(MotionCase, AClipThatMatchesLessThanHalfIsRefusedUnlessItIsAllowed)
{
    MotionSpec walk = clip({"upper", "forearm", "a", "b", "c", "d", "e", "f", "g", "h"});
    expect_input_error([&] { made(walk); }, walk.clip + ": joints = 2 of 10 moving joints: ",
                       "expected at least one half to match a bone of the character (motion.allow_partial = true in the scene, or "
                       "--allow-partial of `pbskin try`, accepts fewer); without a bone: a, b, c, d, "
                       "e, f and 2 others");
    walk.allow_partial = true;
    EXPECT_EQ(made(walk).matched_joints, 2);
    walk = clip({"upper", "forearm", "a", "b", "c"});
    expect_input_error([&] { made(walk); }, walk.clip + ": joints = 2 of 5 moving joints: ", "without a bone: a, b, c");
    walk.allow_partial = true;
    EXPECT_EQ(made(walk).matched_joints, 2);
    EXPECT_EQ(made(clip({"upper", "forearm", "a", "b"})).matched_joints, 2);  // one half is enough
}

TEST_F(MotionCase, AnAnimationOfTheModel)
{
    const auto model = pbs::read_model(test_support::write_rigged_gltf(folder, "arm.gltf", {"Bend"}), "Bend", 1.0);
    character.artist = pbs::ArtistSkin{{}, model};
    MotionSpec spec;
    spec.of_model = true;
    spec.rate_hz = 10.0;
    const CaseMotion motion = made(spec);
    EXPECT_NEAR(motion.largest_rotation_deg, 90.0, 1e-3);  // glTF's numbers are single precision
    EXPECT_EQ(motion.motion.frames(), 21);
    EXPECT_EQ(motion.clip_joints, 0);
    EXPECT_TRUE(motion.remarks.empty());
}

TEST_F(MotionCase, AModelWithoutAnimationIsRefused)
{
    const auto model = pbs::read_model(test_support::write_rigged_gltf(folder, "arm.gltf", {}), "", 1.0);
    character.artist = pbs::ArtistSkin{{}, model};
    MotionSpec spec;
    spec.of_model = true;
    expect_input_error([&] { made(spec); }, "scene.toml: motion.animation: ", "the model has no animation: expected a joint or a clip");
}

}  // namespace
