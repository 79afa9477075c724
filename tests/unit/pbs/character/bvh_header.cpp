// Reference: the errors that assimp 5.2 accepts and should not; each refusal by file, line and field.
#include "pbs/character/bvh_header.hpp"

#include "tests/unit/pbs/character/expect_input_error.hpp"

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

TEST(BvhHeader, FramesMustFitTheFile)
{
    expect_input_error([] { check_bvh_header(bvh("2000000000", "0.01"), "a.bvh"); }, "a.bvh:6: Frames = 2000000000", "too short");
}

TEST(BvhHeader, RowsBeyondFramesAreRefused)
{
    expect_input_error([] { check_bvh_header(bvh("1", "0.01"), "a.bvh"); }, "a.bvh:8: motion = 6 numbers", "Frames times channels: 3");
}

TEST(BvhHeader, FrameTimeMustBePositiveAndFinite)
{
    for (const std::string time : {"0", "-0.01", "nan", "inf", "soon"})
        expect_input_error([&] { check_bvh_header(bvh("2", time), "a.bvh"); }, "a.bvh:7: Frame Time = " + time, "from 1e-6 to 1000 s");
}

TEST(BvhHeader, NestingHasAnEnd)
{
    std::string text;
    for (int depth = 0; depth < 100000; ++depth) text += "JOINT a\n{\n";
    expect_input_error([&] { check_bvh_header(text, "a.bvh"); }, "a.bvh:1002: JOINT", "deeper than 500");
}

}  // namespace
