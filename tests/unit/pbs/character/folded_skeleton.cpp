// Reference: means by hand; a star stands for left and right.
#include "pbs/character/folded_skeleton.hpp"

#include "tests/unit/pbs/character/expect_input_error.hpp"

namespace {

using namespace pbs;

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
