// Reference: glTF 2.0, Sec. 3.11, on an animation of two keys.
#include "pbs/rig/gltf_rig.hpp"

#include "tests/support/gltf_document.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;
using test_support::GltfDocument;
using test_support::two_joint_document;

Rig animated(const GltfDocument& gltf)
{
    const test_support::ScratchFolder folder;
    return read_gltf_rig(folder.file("a.gltf", gltf.text()));
}

TEST(GltfAnimations, HaveTheKeysOfTheirSamplers)
{
    const Rig rig = animated(two_joint_document());
    ASSERT_EQ(rig.animations.size(), 1u);
    EXPECT_EQ(rig.animations[0].name, "Bend");
    EXPECT_EQ(rig.animations[0].start_s, 0.0);
    EXPECT_EQ(rig.animations[0].end_s, 1.0);
    ASSERT_EQ(rig.animations[0].nodes.size(), 1u);
    const NodeTracks& tracks = rig.animations[0].nodes[0];
    EXPECT_EQ(rig.nodes[std::size_t(tracks.node)].name, "elbow");
    EXPECT_FALSE(tracks.translation || tracks.scale);
    ASSERT_TRUE(tracks.rotation);
    EXPECT_EQ(tracks.rotation->interpolation, Interpolation::linear);
    EXPECT_EQ(tracks.rotation->times_s, (std::vector<double>{0.0, 1.0}));
    EXPECT_EQ(tracks.rotation->values, (std::vector<Eigen::Vector4d>{{0, 0, 0, 1}, {0, 0, 1, 0}}));
}

TEST(GltfAnimations, ACubicSplineHasThreeValuesPerKey)
{
    GltfDocument gltf = two_joint_document();
    const int output = gltf.put<float>("VEC3", {1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0, 5, 0, 0, 6, 0, 0});
    gltf.json["animations"][0]["samplers"][0].update({{"interpolation", "CUBICSPLINE"}, {"output", output}});
    gltf.json["animations"][0]["channels"][0]["target"]["path"] = "translation";
    const Rig rig = animated(gltf);
    const KeyTrack& track = rig.animations.at(0).nodes.at(0).translation.value();
    EXPECT_EQ(track.interpolation, Interpolation::cubic_spline);
    ASSERT_EQ(track.values.size(), 6u);
    EXPECT_EQ(track.values[4], Eigen::Vector4d(5, 0, 0, 0));
}

TEST(GltfAnimations, AStepAndALinearTrackOfOneNodeAreReadTogether)
{
    GltfDocument gltf = two_joint_document();
    const int times = gltf.put<float>("SCALAR", {0.5F, 2.0F}), scales = gltf.put<float>("VEC3", {1, 1, 1, 2, 2, 2});
    gltf.json["animations"][0]["samplers"].push_back({{"input", times}, {"output", scales}, {"interpolation", "STEP"}});
    gltf.json["animations"][0]["channels"].push_back({{"sampler", 1}, {"target", {{"node", 1}, {"path", "scale"}}}});
    const RigAnimation animation = animated(gltf).animations.at(0);
    ASSERT_EQ(animation.nodes.size(), 1u);
    EXPECT_TRUE(animation.nodes[0].rotation && animation.nodes[0].scale && !animation.nodes[0].translation);
    EXPECT_EQ(animation.nodes[0].scale->interpolation, Interpolation::step);
    EXPECT_EQ(animation.start_s, 0.0);
    EXPECT_EQ(animation.end_s, 2.0);
}

TEST(GltfAnimations, WithoutANameAreNumbered)
{
    GltfDocument gltf = two_joint_document();
    gltf.json["animations"].push_back(gltf.json["animations"][0]);
    gltf.json["animations"][1].erase("name");
    EXPECT_EQ(animated(gltf).animations.at(1).name, "animation 1");
}

TEST(GltfAnimations, AChannelWithoutANodeIsIgnored)
{
    GltfDocument gltf = two_joint_document();
    gltf.json["animations"][0]["channels"].push_back({{"sampler", 0}, {"target", {{"path", "rotation"}}}});
    EXPECT_EQ(animated(gltf).animations.at(0).nodes.size(), 1u);
    gltf.json["animations"][0]["channels"].erase(0);
    EXPECT_TRUE(animated(gltf).animations.empty()) << "it moves no node";
}

TEST(GltfAnimations, WithoutChannelsAreLeftOut)
{
    GltfDocument gltf = two_joint_document();
    gltf.json["animations"][0]["channels"] = nlohmann::json::array();
    EXPECT_TRUE(animated(gltf).animations.empty());
}

TEST(GltfAnimations, OfMorphTargetsAreLeftOutWithARemark)
{
    GltfDocument gltf = two_joint_document();
    gltf.json["animations"][0]["channels"].push_back({{"sampler", 0}, {"target", {{"node", 2}, {"path", "weights"}}}});
    const Rig rig = animated(gltf);
    EXPECT_EQ(rig.animations.at(0).nodes.size(), 1u);
    EXPECT_EQ(rig.remarks, std::vector<std::string>{"animation Bend: the changes of morph targets are left out"});
}

TEST(GltfAnimations, AFileMayHaveNone)
{
    GltfDocument gltf = two_joint_document();
    gltf.json.erase("animations");
    EXPECT_TRUE(animated(gltf).animations.empty());
}

}  // namespace
