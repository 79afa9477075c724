// Reference: one motion in the dialects of BVH, whose plain form is compared with independent kinematics elsewhere;
// refusals by file, line and field.

#include "experiments/clips/clip.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

namespace {

using namespace pbs;

std::string bvh(const std::string& frames, const std::string& time)
{
    return "HIERARCHY\nROOT a { CHANNELS 3 Xrotation Yrotation Zrotation\n}\n\nMOTION\nFrames: " + frames +
           "\nFrame Time: " + time + "\n0 0 0\n0 0 0\n";  // Frames is in line 6
}

TEST(BvhHeader, ABvhIsKnownByItsExtensionOrItsFirstWord)
{
    for (const std::string before : {"", "\n", " \t\r\n\v\f\n", "\xef\xbb\xbf", "\xef\xbb\xbf\n"})
        EXPECT_TRUE(is_bvh(before + bvh("2", "0.01"), "a.clip")) << before;
    EXPECT_TRUE(is_bvh("noise", "folder/a.BVH"));
    EXPECT_TRUE(is_bvh("hierarchy", "a.clip"));
    for (const std::string text : {"", " \n", "solid HIERARCHY", "HIERARCH"})
        EXPECT_FALSE(is_bvh(text, "a.bvh.clip")) << text;
}

TEST(BvhHeader, WhatIsMissingIsNamed)
{
    expect_input_error([&] { read_bvh("", "a.bvh"); }, "a.bvh:1: no clip in BVH", "HIERARCHY");
    expect_input_error([&] { read_bvh("HIERARCHY\nMOTION\n", "a.bvh"); }, "a.bvh:2: CHANNELS = 0", "holds no motion");
    expect_input_error([&] { read_bvh("HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n", "a.bvh"); }, "a.bvh:5: JOINT = a",
                       "ends inside");
}

TEST(BvhHeader, FramesMustBeAWholeNumberAboveZero)
{
    for (const std::string frames : {"0", "-3", "2.5", "nan", "many"})
        expect_input_error([&] { read_bvh(bvh(frames, "0.01"), "a.bvh"); }, "a.bvh:6: Frames = " + frames, "1 or more");
}

TEST(BvhHeader, FrameTimeMustBePositiveAndFinite)
{
    for (const std::string time : {"0", "-0.01", "nan", "inf", "soon"})
        expect_input_error([&] { read_bvh(bvh("2", time), "a.bvh"); }, "a.bvh:7: Frame Time = " + time,
                           "from 1e-6 to 1000 s");
}

// Three joints and two end sites, three frames.
const std::string plain =
    "HIERARCHY\nROOT Hips\n{\n\tOFFSET 1 2 3\n\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
    "Yrotation\n\tJOINT Knee\n\t{\n"
    "\t\tOFFSET 0 -2 0\n\t\tCHANNELS 3 Zrotation Xrotation Yrotation\n\t\tJOINT Foot\n\t\t{\n\t\t\tOFFSET 0 -2 0.5\n"
    "\t\t\tCHANNELS 3 Zrotation Xrotation Yrotation\n\t\t\tEnd Site\n\t\t\t{\n\t\t\t\tOFFSET 0 0 "
    "1\n\t\t\t}\n\t\t}\n\t}\n}\n"
    "MOTION\nFrames: 3\nFrame Time: 0.1\n1 2 3 10 -20 30 5 0 -40 0 0 7\n1 2 4 15 -25 35 6 1 -41 1 1 8\n2 2 4 20 -30 40 "
    "7 2 -42 2 2 9\n";

std::string rewritten(std::string text, const std::string& what, const std::string& by)
{
    EXPECT_NE(text.find(what), std::string::npos) << what;
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
        text.replace(at, what.size(), by);
    return text;
}

void expect_same(const Clip& clip, const Clip& expected, int frames = 3)
{
    ASSERT_EQ(clip.frames(), frames);
    EXPECT_EQ(clip.frame_time_s, expected.frame_time_s);
    for (std::size_t frame = 0; frame < std::size_t(frames); ++frame)
        for (std::size_t j = 0; j < expected.joints.size(); ++j) {
            EXPECT_EQ(clip.local[frame][j].coeffs(), expected.local[frame][j].coeffs());
            EXPECT_EQ(clip.places[frame].row(j), expected.places[frame].row(j));
        }
}

TEST(BvhDialect, SpellingsOfOneMotionAreOneClip)
{
    const Clip expected = read_bvh(plain, "a.bvh");
    std::string lower = plain;
    std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
    for (const std::string& text :
         {"\xef\xbb\xbf" + plain, "\n \n" + plain, rewritten(plain, "Frames: 3", "Frames: \t3"),
          rewritten(plain, "Time: 0.1", "Time:  .1"), rewritten(plain, "\n", "\r\n"), rewritten(plain, "\n", "\n\n"),
          rewritten(plain, "End Site", "End site"), rewritten(plain, "Frames: 3", "Frames:3"),
          rewritten(plain, "Frame Time: ", "FRAME TIME:\t"), rewritten(plain, "10 -20 30", "10-20+30"), lower,
          rewritten(plain, "10 -20 30", "1.0E1 -2.0e+1 +30.0"), rewritten(plain, "-20 30 5", "-20\n30\t\n5"),
          rewritten(plain, "JOINT Knee", "JOINT Left Knee of mine"), rewritten(plain, "0.1\n", "0,1\n")}) {
        SCOPED_TRACE(text);
        const Clip clip = read_bvh(text, "a.bvh");
        expect_same(clip, expected);
        EXPECT_TRUE(clip.remarks.empty());
    }
    EXPECT_EQ(read_bvh(rewritten(plain, "JOINT Knee", "JOINT Left Knee of mine  "), "a.bvh").joints[1],
              "Left Knee of mine");
}

TEST(BvhDialect, ARowMoreOrLessThanStatedIsTakenAsItIsAndNoted)
{
    const Clip expected = read_bvh(plain, "a.bvh");
    for (const std::string frames : {"2", "4"}) {
        const Clip clip = read_bvh(rewritten(plain, "Frames: 3", "Frames: " + frames), "a.bvh");
        expect_same(clip, expected);
        ASSERT_EQ(clip.remarks.size(), 1u);
        EXPECT_EQ(clip.remarks[0], "a.bvh:22: Frames = " + frames + ": the file has 3 rows, which are taken");
    }
    expect_input_error([&] { read_bvh(rewritten(plain, "Frames: 3", "Frames: 5"), "a.bvh"); },
                       "a.bvh:24: motion = 36 numbers", "Frames times channels: 60");
    expect_input_error([&] { read_bvh(rewritten(plain, "2 2 9\n", "2 2\n"), "a.bvh"); },
                       "a.bvh:24: motion = 35 numbers", "a row has 12 numbers");
}

TEST(BvhDialect, NumbersThatAreNoneAreRefusedByFrame)
{
    for (const std::string number :
         {"99999999999999999999999999", "-99999999999999999999999999", "1e39", "nan", "--1", "1-", "."})
        expect_input_error([&] { read_bvh(rewritten(plain, "-41", number), "a.bvh"); }, "a.bvh:25: ", "expected");
}

TEST(BvhDialect, ASecondRootChangesNoPlaceOfTheFirst)
{
    std::string text =
        rewritten(plain, "MOTION", "ROOT Prop\n{\nOFFSET 1 1 1\nCHANNELS 3 Xposition Yposition Zposition\n}\nMOTION");
    for (const std::string end : {" 7\n", " 8\n", " 9\n"}) text = rewritten(text, end, end.substr(0, 2) + " 4 5 6\n");
    const Clip clip = read_bvh(text, "a.bvh");
    expect_same(clip, read_bvh(plain, "a.bvh"));
    EXPECT_EQ(clip.joints.back(), "Prop");
    EXPECT_EQ(clip.parent.back(), -1);
    EXPECT_EQ(Vec3(clip.places[0].bottomRows(1).transpose()), Vec3(4, 5, 6));
}

TEST(BvhDialect, PositionsAreTheOffsetsWhereThoseAreZero)
{
    std::string text =
        rewritten(plain, "0 -2 0\n\t\tCHANNELS 3", "0 0 0\n\t\tCHANNELS 6 Xposition Yposition Zposition");
    text = rewritten(text, " 5 0 -40", " 0 -2 0 5 0 -40");
    text = rewritten(text, " 6 1 -41", " 0 -2 0 6 1 -41");
    text = rewritten(text, " 7 2 -42", " 0 -2 0 7 2 -42");
    const Clip clip = read_bvh(text, "a.bvh"), expected = read_bvh(plain, "a.bvh");
    expect_same(clip, expected);
    EXPECT_EQ(clip.zero_pose, expected.zero_pose);
    ASSERT_EQ(clip.remarks.size(), 1u);
    EXPECT_NE(clip.remarks[0].find("1 joints have the offset 0"), std::string::npos) << clip.remarks[0];
    const std::string without = rewritten(rewritten(plain, "0 -2 0\n", "0 0 0\n"), "0 -2 0.5\n", "0 0 0\n");
    expect_input_error([&] { read_bvh(without, "a.bvh"); }, "a.bvh: OFFSET = 0 0 0",
                       "export the clip with the offsets");
}

TEST(Clip, FindClipLooksInTheFolderAndSaysWhereItLooked)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("own.bvh", "");
    EXPECT_EQ(find_clip("own.bvh", folder.path().string()), path);
    EXPECT_EQ(find_clip(path, "elsewhere"), path);
    expect_input_error([&] { find_clip("none.bvh", folder.path().string()); },
                       "motion.clip = none.bvh: ", "assimp-testmodels");
}

// Reference: the twist of q = swing * twist is the twist.

TEST(TwistAngle, OfATwistWithASwingBeforeIt)
{
    const Vec3 axis = Vec3(1.0, -2.0, 0.5).normalized();
    const Vec3 across = axis.cross(Vec3::UnitX()).normalized();
    for (const double angle : {-3.0, -1.0, 0.0, 0.3, 1.5, 3.1}) {
        const Eigen::Quaterniond q(Eigen::AngleAxisd(1.2, across) * Eigen::AngleAxisd(angle, axis));
        // of two rotations, whose quaternions have half the angle
        const double rounding = 2.0 * test_support::motion_error(2, 1.0);
        EXPECT_NEAR(twist_angle(q, axis), angle, rounding);
        EXPECT_NEAR(twist_angle(Eigen::Quaterniond(-q.coeffs()), axis), angle, rounding) << "q and -q are one rotation";
    }
}

TEST(TwistAngle, OfASwingAloneIsZeroAndOfAHalfTurnFinite)
{
    EXPECT_NEAR(twist_angle(Eigen::Quaterniond(Eigen::AngleAxisd(2.0, Vec3::UnitY())), Vec3::UnitX()), 0.0,
                test_support::motion_error(1, 1.0));
    EXPECT_TRUE(std::isfinite(twist_angle(Eigen::Quaterniond(0.0, 0.0, 1.0, 0.0), Vec3::UnitX())))
        << "where the twist is undefined";
}

}  // namespace
