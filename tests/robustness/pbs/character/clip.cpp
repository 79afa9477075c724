// Every bad clip by name: refused with its file and a reason, never a crash or a silent repair.
#include "pbs/character/clip.hpp"

#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <random>

namespace {

using namespace pbs;

std::string bvh(const std::string& frames, const std::string& time, const std::string& motion, const std::string& child = "forearm")
{
    return "HIERARCHY\nROOT upper\n{\n OFFSET 0 0 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n JOINT " +
           child +
           "\n {\n  OFFSET 2 0 0\n  CHANNELS 3 Zrotation Yrotation Xrotation\n  End Site\n  {\n   OFFSET 1 0 0\n  }\n "
           "}\n}\nMOTION\nFrames: " +
           frames + "\nFrame Time: " + time + "\n" + motion;
}

const std::string row = "0 0 0 0 0 0 10 20 30\n";

std::string noise(int bytes)
{
    std::mt19937 generator(20140528);
    std::string text;
    for (int byte = 0; byte < bytes; ++byte) text += static_cast<char>(generator() & 255);
    return text;
}

std::string nested_joints(int deep)
{
    std::string text;
    for (int joint = 0; joint < deep; ++joint) text += "JOINT a\n{\n";
    return text;
}

struct BadClip {
    const char* name;
    std::string file, text, holds;
};

class RefusedClip : public testing::TestWithParam<BadClip> {};

TEST_P(RefusedClip, NamesFileAndReason)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file(GetParam().file, GetParam().text);
    expect_input_error([&] { read_clip(path); }, path, GetParam().holds);
}

const BadClip bad_clips[] = {
    {"empty", "a.bvh", "", "assimp"},
    {"noise", "a.bvh", noise(4096), "assimp"},
    {"noise_after_the_first_word", "a.bvh", "HIERARCHY\n" + noise(4096), "assimp"},
    {"noise_by_another_name", "a.clip", noise(4096), "assimp"},
    {"zero_frames_by_another_name", "a.clip", bvh("0", "0.01", ""), ":17: Frames = 0"},
    {"cut_in_the_hierarchy", "a.bvh", bvh("1", "0.01", row).substr(0, 100), "assimp"},
    {"cut_in_the_motion", "a.bvh", bvh("3", "0.01", row + row + "0 0 0 1\n"), "assimp"},
    {"no_motion", "a.bvh", "HIERARCHY\nROOT upper\n{\n OFFSET 0 0 0\n CHANNELS 0\n}\n", "assimp"},
    {"zero_frames", "a.bvh", bvh("0", "0.01", ""), ":17: Frames = 0"},
    {"negative_frames", "a.bvh", bvh("-2", "0.01", row), ":17: Frames = -2"},
    {"more_frames_than_bytes", "a.bvh", bvh("4000000000", "0.01", row), ":17: Frames = 4000000000"},
    {"zero_frames_behind_a_blank_line", "a.bvh", "\n" + bvh("0", "0.01", ""), ":18: Frames = 0"},
    {"frame_time_zero_behind_blanks", "a.clip", " \t\r\n" + bvh("1", "0", row), ":19: Frame Time = 0"},
    {"frame_time_zero_behind_a_byte_order_mark", "a.clip", "\xef\xbb\xbf" + bvh("1", "0", row), ":18: Frame Time = 0"},
    {"frame_time_zero", "a.bvh", bvh("1", "0", row), ":18: Frame Time = 0"},
    {"frame_time_nan", "a.bvh", bvh("1", "nan", row), ":18: Frame Time = nan"},
    {"nan_rotation", "a.bvh", bvh("2", "0.01", row + "0 0 0 0 0 0 10 nan 30\n"), "frame 1 = forearm"},
    {"infinite_rotation", "a.bvh", bvh("1", "0.01", "0 0 0 0 0 inf 10 20 30\n"), "frame 0 = upper"},
    {"nan_position", "a.bvh", bvh("1", "0.01", "0 nan 0 0 0 0 10 20 30\n"), "its position"},
    {"nan_offset", "a.bvh",
     "HIERARCHY\nROOT a\n{\n OFFSET 0 nan 0\n CHANNELS 3 Zrotation Yrotation Xrotation\n End Site\n {\n OFFSET 1 0 0\n }\n}\n"
     "MOTION\nFrames: 1\nFrame Time: 0.01\n0 0 0\n",
     "OFFSET"},
    {"one_name_twice", "a.bvh", bvh("1", "0.01", row, "upper"), "two joints"},
    {"text_among_the_numbers", "a.bvh", bvh("1", "0.01", "0 0 0 0 zero 0 10 20 30\n"), "assimp"},
    {"unknown_channel", "a.bvh", "HIERARCHY\nROOT a\n{\n OFFSET 0 0 0\n CHANNELS 1 Wrotation\n}\nMOTION\nFrames: 1\nFrame Time: 0.01\n0\n",
     "assimp"},
    {"bottomless_nesting", "a.bvh", "HIERARCHY\n" + nested_joints(200'000), "deeper than 500"},
    {"bottomless_nesting_behind_a_blank_line", "a.bvh", "\nHIERARCHY\n" + nested_joints(200'000), "deeper than 500"},
    {"surface_without_motion", "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "no motion"},
};

INSTANTIATE_TEST_SUITE_P(Clip, RefusedClip, testing::ValuesIn(bad_clips),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(Clip, MissingFileAndFolder)
{
    const test_support::ScratchFolder folder;
    const std::string none = (folder.path() / "none.bvh").string();
    expect_input_error([&] { read_clip(none); }, none, "cannot be opened");
    expect_input_error([&] { read_clip(folder.path().string()); }, folder.path().string(), "cannot be opened");
}

TEST(Clip, TruncatedAtEveryEighthByteItIsRefusedOrWhole)
{
    const test_support::ScratchFolder folder;
    const std::string whole = bvh("2", "0.01", row + row);
    for (std::size_t length = 0; length < whole.size(); length += 8) {
        const std::string path = folder.file("cut.bvh", whole.substr(0, length));
        try {
            EXPECT_EQ(read_clip(path).frames(), 2) << length;
        } catch (const InputError&) {
        }
    }
}

TEST(Clip, BlankLinesBeforeItChangeNothing)
{
    const test_support::ScratchFolder folder;
    const std::string text = bvh("3", "0.02", row + "0 0 0 0 0 0 20 40 60\n" + row);
    const Clip clip = read_clip(folder.file("a.bvh", text)), later = read_clip(folder.file("b.bvh", "\n \n" + text));
    EXPECT_EQ(later.frame_time_s, clip.frame_time_s);
    ASSERT_EQ(later.frames(), 3);
    for (int frame = 0; frame < 3; ++frame)
        for (std::size_t joint = 0; joint < clip.joints.size(); ++joint)
            EXPECT_EQ(later.local[frame][joint].coeffs(), clip.local[frame][joint].coeffs()) << frame << ' ' << joint;
}

TEST(Clip, FindClipLooksInTheFolderAndSaysWhereItLooked)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("own.bvh", "");
    EXPECT_EQ(find_clip("own.bvh", folder.path().string()), path);
    EXPECT_EQ(find_clip(path, "elsewhere"), path);
    expect_input_error([&] { find_clip("none.bvh", folder.path().string()); }, "motion.clip = none.bvh: ", "assimp-testmodels");
}

}  // namespace
