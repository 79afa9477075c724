// Reference: the format as documented (TOML: [[joint]] with name, parent, head_m, tail_m); each refusal by file, line
// and field.

#include "experiments/characters/skeleton_file.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

namespace {

using namespace pbs;

std::string joint(const std::string& name, const std::string& parent, const std::string& head, const std::string& tail)
{
    return "[[joint]]\nname = \"" + name + "\"\nparent = \"" + parent + "\"\nhead_m = " + head + "\ntail_m = " + tail +
           "\n";
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
    const Skeleton skeleton = fold_skeleton(
        {{"thigh.*", "body", {"hip.*"}, {"knee.*"}}, {"body", "", {"hip.L", "hip.R"}, {"top"}}}, "rig", point);
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
    expect_input_error(
        [] {
            fold_skeleton({{"body", "", {"top"}, {"toe"}}}, "rig", point);
        },
        "rig: joints = toe", "missing");
}

}  // namespace
