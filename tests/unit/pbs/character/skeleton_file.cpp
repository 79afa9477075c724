// Reference: the format as documented (TOML: [[joint]] with name, parent, head_m, tail_m); each refusal by file, line and field.

#include "pbs/character/skeleton_file.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

namespace {

using namespace pbs;

std::string joint(const std::string& name, const std::string& parent, const std::string& head, const std::string& tail)
{
    return "[[joint]]\nname = \"" + name + "\"\nparent = \"" + parent + "\"\nhead_m = " + head + "\ntail_m = " + tail + "\n";
}

const std::string root = joint("root", "", "[0, 0, 0]", "[0.5, 0, 0]");                  // lines 1 to 5
const std::string child = joint("child", "root", "[0.5, 0.0, 0.0]", "[1.0, 0.0, 0.0]");  // five lines

TEST(SkeletonFile, ReadsNamesParentsHeadsAndTails)
{
    const Skeleton skeleton = parse_skeleton(root + child, "two.toml");
    ASSERT_EQ(skeleton.bones.size(), 2u);
    EXPECT_EQ(skeleton.bones[0].name, "root");
    EXPECT_EQ(skeleton.bones[0].parent, -1);
    EXPECT_EQ(skeleton.bones[0].tail, Vec3(0.5, 0.0, 0.0));
    EXPECT_EQ(skeleton.bones[1].parent, 0);
    EXPECT_EQ(skeleton.bones[1].head, Vec3(0.5, 0.0, 0.0));
    EXPECT_EQ(skeleton.bones[1].tail, Vec3(1.0, 0.0, 0.0));
}

TEST(SkeletonFile, ParentsComeBeforeTheirChildrenWhateverTheFilesOrder)
{
    const std::string grandchild = joint("grandchild", "child", "[1, 0, 0]", "[1, 1, 0]");
    const Skeleton skeleton = parse_skeleton(grandchild + child + root, "turned.toml");
    ASSERT_EQ(skeleton.bones.size(), 3u);
    for (int bone = 0; bone < 3; ++bone) EXPECT_LT(skeleton.bones[bone].parent, bone);
    EXPECT_EQ(skeleton.bones[2].name, "grandchild");
    EXPECT_EQ(skeleton.bones[2].parent, 1);
}

TEST(SkeletonFile, ReadsAFileAndNamesTheMissingOne)
{
    const test_support::ScratchFolder folder;
    EXPECT_EQ(read_skeleton(folder.file("arm.skeleton.toml", root + child)).bones.size(), 2u);
    expect_input_error([&] { read_skeleton((folder.path() / "none.toml").string()); }, (folder.path() / "none.toml").string(),
                       "cannot be opened");
}

struct BadSkeleton {
    const char* name;
    std::string text, begins, holds;
};

class RefusedSkeleton : public testing::TestWithParam<BadSkeleton> {};

TEST_P(RefusedSkeleton, NamesFileLineFieldAndRule)
{
    expect_input_error([] { parse_skeleton(GetParam().text, "bad.toml"); }, GetParam().begins, GetParam().holds);
}

const BadSkeleton bad_skeletons[] = {
    {"empty", "", "bad.toml: joint", "at least one [[joint]]"},
    {"no_toml", "{", "bad.toml:1", ""},
    {"cut_short", root + "[[joint]]\nname = \"chi", "bad.toml:7", ""},
    {"unknown_key", root + "tial_m = [1, 0, 0]\n", "bad.toml:6: tial_m: ", "nearest known one is tail_m"},
    {"unknown_table", "[bone]\nname = \"a\"\n", "bad.toml:1: bone: ", "nearest known one is joint"},
    {"joint_is_no_array", "[joint]\nname = \"a\"\n", "bad.toml:1: joint: ", "[[joint]]"},
    {"missing_tail", root + "[[joint]]\nname = \"a\"\nparent = \"root\"\nhead_m = [0, 0, 0]\n", "bad.toml:6: tail_m: ", "missing"},
    {"missing_parent", "[[joint]]\nname = \"a\"\nhead_m = [0, 0, 0]\ntail_m = [1, 0, 0]\n", "bad.toml:1: parent: ", "missing"},
    {"name_is_a_number", "[[joint]]\nname = 7\nparent = \"\"\nhead_m = [0, 0, 0]\ntail_m = [1, 0, 0]\n",
     "bad.toml:2: name = 7: ", "expected a string"},
    {"empty_name", joint("", "", "[0, 0, 0]", "[1, 0, 0]"), "bad.toml:1: name", "expected a name"},
    {"two_coordinates", joint("a", "", "[0, 0]", "[1, 0, 0]"), "bad.toml:4: head_m = [ 0, 0 ]: ", "three finite numbers"},
    {"coordinate_is_text", joint("a", "", "[0, 0, \"0\"]", "[1, 0, 0]"), "bad.toml:4: head_m", "three finite numbers"},
    {"nan", joint("a", "", "[0, 0, 0]", "[nan, 0, 0]"), "bad.toml:5: tail_m = [ nan, 0, 0 ]: ", "three finite numbers"},
    {"infinite", joint("a", "", "[0, 0, 0]", "[-inf, 0, 0]"), "bad.toml:5: tail_m", "three finite numbers"},
    {"duplicate_name", root + joint("root", "root", "[0, 0, 0]", "[1, 0, 0]"), "bad.toml:6: name = root: ", "already used in line 1"},
    {"unknown_parent", root + joint("a", "rooot", "[0, 0, 0]", "[1, 0, 0]"), "bad.toml:6: a.parent = rooot: ", "nearest is 'root'"},
    {"own_parent", root + joint("a", "a", "[0, 0, 0]", "[1, 0, 0]"), "bad.toml:6: a.parent = a: ", "cycle"},
    {"cycle", root + joint("a", "b", "[0, 0, 0]", "[1, 0, 0]") + joint("b", "a", "[1, 0, 0]", "[2, 0, 0]"),
     "bad.toml:6: a.parent = b: ", "cycle"},
    {"no_root", joint("a", "b", "[0, 0, 0]", "[1, 0, 0]") + joint("b", "a", "[1, 0, 0]", "[2, 0, 0]"), "bad.toml: joint: ", "no root"},
    {"bone_without_length", root + joint("a", "root", "[1, 2, 3]", "[1, 2, 3]"), "bad.toml:6: a.tail_m = [1 2 3]: ", "needs a length"},
    {"nearly_no_length", root + joint("a", "root", "[1, 0, 0]", "[1.0000000000001, 0, 0]"), "bad.toml:6: a.tail_m", "needs a length"},
};

INSTANTIATE_TEST_SUITE_P(SkeletonFile, RefusedSkeleton, testing::ValuesIn(bad_skeletons),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

// Reference: means by hand; a star stands for left and right.

Vec3 point(const std::string& name)
{
    const double side = name.ends_with(".L") ? 1.0 : name.ends_with(".R") ? -1.0 : 0.0;
    if (name.starts_with("hip")) return {side, 1.0, 0.0};
    if (name.starts_with("knee")) return {side, 0.5, 0.0};
    if (name == "top") return {0.0, 2.0, 0.0};
    throw InputError("rig", 0, "joints", name, "missing");
}

TEST(FoldedSkeleton, EndsAreMeansAndPairsComeLeftThenRight)
{
    const Skeleton skeleton =
        fold_skeleton({{"thigh.*", "body", {"hip.*"}, {"knee.*"}}, {"body", "", {"hip.L", "hip.R"}, {"top"}}}, "rig", point);
    ASSERT_EQ(skeleton.bones.size(), 3u);
    EXPECT_EQ(skeleton.bones[0].name, "body");
    EXPECT_EQ(skeleton.bones[0].head, Vec3(0.0, 1.0, 0.0));
    EXPECT_EQ(skeleton.bones[1].name, "thigh.L");
    EXPECT_EQ(skeleton.bones[1].tail, Vec3(1.0, 0.5, 0.0));
    EXPECT_EQ(skeleton.bones[2].name, "thigh.R");
    EXPECT_EQ(skeleton.bones[2].head, Vec3(-1.0, 1.0, 0.0));
    EXPECT_EQ(skeleton.bones[2].parent, 0);
}

TEST(FoldedSkeleton, RefusesBonesWithoutLengthAndUnknownPoints)
{
    expect_input_error([] { fold_skeleton({{"body", "", {"top"}, {"top"}}}, "rig", point); }, "rig", "length");
    expect_input_error([] { fold_skeleton({{"body", "", {"top"}, {"toe"}}}, "rig", point); }, "rig: joints = toe", "missing");
}

}  // namespace
