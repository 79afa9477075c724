// Reference: the errors that assimp 5.2 accepts and should not; each refusal by file, line and field.

#include "pbs/character/clip.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

std::string bvh(const std::string& frames, const std::string& time)
{
    return "HIERARCHY\nROOT a { CHANNELS 3 Xrotation Yrotation Zrotation\n}\n\nMOTION\nFrames: " + frames + "\nFrame Time: " + time +
           "\n0 0 0\n0 0 0\n";  // Frames is in line 6
}

TEST(BvhHeader, AWholeOnePasses)
{
    EXPECT_NO_THROW(check_bvh_header(bvh("2", "0.0083333"), "a.bvh"));
    EXPECT_NO_THROW(check_bvh_header(bvh("\t2", " .01"), "a.bvh"));
}

TEST(BvhHeader, ABvhIsKnownByItsExtensionOrItsFirstWord)
{
    for (const std::string before : {"", "\n", " \t\r\n\v\f\n", "\xef\xbb\xbf", "\xef\xbb\xbf\n"})
        EXPECT_TRUE(is_bvh(before + bvh("2", "0.01"), "a.clip")) << before;
    EXPECT_TRUE(is_bvh("noise", "folder/a.BVH"));
    for (const std::string text : {"", " \n", "\xef\xbb\xbf", "solid HIERARCHY", "HIERARCH"})
        EXPECT_FALSE(is_bvh(text, "a.bvh.clip")) << text;
}

TEST(BvhHeader, WhatIsNotThereIsLeftToTheReader)
{
    EXPECT_NO_THROW(check_bvh_header("", "a.bvh"));
    EXPECT_NO_THROW(check_bvh_header("HIERARCHY\nMOTION\n", "a.bvh"));
}

TEST(BvhHeader, FramesMustBeAWholeNumberAboveZero)
{
    for (const std::string frames : {"0", "-3", "2.5", "nan", "many"})
        expect_input_error([&] { check_bvh_header(bvh(frames, "0.01"), "a.bvh"); }, "a.bvh:6: Frames = " + frames, "1 or more");
}

TEST(BvhHeader, FrameTimeMustBePositiveAndFinite)
{
    for (const std::string time : {"0", "-0.01", "nan", "inf", "soon"})
        expect_input_error([&] { check_bvh_header(bvh("2", time), "a.bvh"); }, "a.bvh:7: Frame Time = " + time, "from 1e-6 to 1000 s");
}

TEST(Clip, BlankLinesBeforeItChangeNothing)
{
    const test_support::ScratchFolder folder;
    const std::string text = bvh("3", "0.02") + "10 20 30\n";
    const Clip clip = read_clip(folder.file("a.bvh", text)), later = read_clip(folder.file("b.bvh", "\n \n" + text));
    EXPECT_EQ(later.frame_time_s, clip.frame_time_s);
    ASSERT_EQ(later.frames(), 3);
    for (int frame = 0; frame < 3; ++frame) EXPECT_EQ(later.local[frame][0].coeffs(), clip.local[frame][0].coeffs()) << frame;
}

TEST(Clip, FindClipLooksInTheFolderAndSaysWhereItLooked)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("own.bvh", "");
    EXPECT_EQ(find_clip("own.bvh", folder.path().string()), path);
    EXPECT_EQ(find_clip(path, "elsewhere"), path);
    expect_input_error([&] { find_clip("none.bvh", folder.path().string()); }, "motion.clip = none.bvh: ", "assimp-testmodels");
}

// Reference: the twist of q = swing * twist is the twist.

TEST(TwistAngle, OfATwistWithASwingBeforeIt)
{
    const Vec3 axis = Vec3(1.0, -2.0, 0.5).normalized();
    const Vec3 across = axis.cross(Vec3::UnitX()).normalized();
    for (const double angle : {-3.0, -1.0, 0.0, 0.3, 1.5, 3.1}) {
        const Eigen::Quaterniond q(Eigen::AngleAxisd(1.2, across) * Eigen::AngleAxisd(angle, axis));
        const double rounding = 2.0 * test_support::motion_error(2, 1.0);  // of two rotations, whose quaternions have half the angle
        EXPECT_NEAR(twist_angle(q, axis), angle, rounding);
        EXPECT_NEAR(twist_angle(Eigen::Quaterniond(-q.coeffs()), axis), angle, rounding) << "q and -q are one rotation";
    }
}

TEST(TwistAngle, OfASwingAloneIsZeroAndOfAHalfTurnFinite)
{
    EXPECT_NEAR(twist_angle(Eigen::Quaterniond(Eigen::AngleAxisd(2.0, Vec3::UnitY())), Vec3::UnitX()), 0.0,
                test_support::motion_error(1, 1.0));
    EXPECT_TRUE(std::isfinite(twist_angle(Eigen::Quaterniond(0.0, 0.0, 1.0, 0.0), Vec3::UnitX()))) << "where the twist is undefined";
}

}  // namespace
