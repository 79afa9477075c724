// Reference: the rig of two joints of gltf_document.hpp, whose elbow turns half round about z within a second, and
// glTF 2.0, Appendix C.
#include "experiments/clips/clip.hpp"
#include "tests/support/fbx_file.hpp"
#include "tests/support/gltf_document.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace pbs;
using test_support::GltfDocument;

// The file's quaternions are in single precision, and each has an angle of half a turn of its rotation.
const double of_angles_deg = 2.0 * test_support::rounding_error_in<float>(8, 1.0) * 180.0 / M_PI;

Clip read(const GltfDocument& gltf, const std::string& animation = "")
{
    const test_support::ScratchFolder folder;
    return read_clip(folder.file("walk.gltf", gltf.text()), animation);
}

double elbow_deg(const Clip& clip, int frame)
{
    const auto elbow = std::ranges::find(clip.joints, "elbow") - clip.joints.begin();
    const Eigen::Quaterniond& turn = clip.local.at(frame).at(elbow);
    return 2.0 * std::atan2(turn.z(), turn.w()) * 180.0 / M_PI;
}

TEST(ClipOfRig, HasTheTurnsAndPlacesOfItsNodes)
{
    const Clip clip = read(test_support::two_joint_document());
    ASSERT_EQ(clip.frames(), 121);
    EXPECT_TRUE(clip.remarks.empty());
    for (const int frame : {0, 30, 60, 90}) EXPECT_NEAR(elbow_deg(clip, frame), 1.5 * frame, of_angles_deg);
    EXPECT_EQ(Vec3(clip.places[60].row(1)), Vec3(1, 2, 0));
}

TEST(ClipOfRig, AnAnimationThatStandsStillIsNotTheMotion)
{
    GltfDocument gltf = test_support::two_joint_document();
    const int still = gltf.put<float>("VEC4", {0, 0, 0, 1, 0, 0, 0, 1});
    const nlohmann::json bend = gltf.json["animations"][0];
    gltf.json["animations"][0]["name"] = "T-Pose";
    gltf.json["animations"][0]["samplers"][0]["output"] = still;
    gltf.json["animations"].push_back(bend);
    const Clip clip = read(gltf);
    EXPECT_NEAR(elbow_deg(clip, 60), 90.0, of_angles_deg);
    ASSERT_EQ(clip.remarks.size(), 1u);
    EXPECT_NE(clip.remarks[0].find(
                  "it has 2 animations; Bend is taken, the first one that turns a joint by more than 5 degrees"),
              std::string::npos)
        << clip.remarks[0];
    const Clip still_one = read(gltf, "T-Pose");
    EXPECT_NEAR(elbow_deg(still_one, 60), 0.0, of_angles_deg);
    EXPECT_TRUE(still_one.remarks.empty()) << "it was chosen";
    EXPECT_NEAR(elbow_deg(read(gltf, "Bend"), 60), 90.0, of_angles_deg);
    expect_input_error([&] { read(gltf, "Walk"); }, "", "animation = Walk: expected one of T-Pose, Bend");
}

TEST(ClipOfRig, ABvhHasNoNames)
{
    const test_support::ScratchFolder folder;
    const std::string path =
        folder.file("a.bvh",
                    "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\n"
                    "OFFSET 0 1 0\n}\n}\nMOTION\nFrames: 1\nFrame Time: 0.1\n0 0 0\n");
    EXPECT_EQ(read_clip(path).frames(), 1);
    expect_input_error([&] { read_clip(path, "Walk"); }, path + ": animation = Walk: ", "a BVH file holds one motion");
}

TEST(ClipOfRig, ItsZeroPoseIsTheBindPoseAndNotThatOfTheNodes)
{
    GltfDocument gltf = test_support::two_joint_document();
    gltf.json["nodes"][1]["rotation"] = {0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)};
    const Clip clip = read(gltf);
    EXPECT_NEAR(elbow_deg(clip, 0), 0.0, of_angles_deg);
    EXPECT_NEAR(elbow_deg(clip, 60), 90.0, of_angles_deg);
    EXPECT_LT((clip.zero_pose.row(1) - Eigen::RowVector3d(1, 2, 0)).norm(), 1e-6);
    gltf.json.erase("skins");
    gltf.json["nodes"][2].erase("skin");
    EXPECT_NEAR(elbow_deg(read(gltf), 0), -90.0, of_angles_deg) << "without a skin the nodes' pose is the only one";
}

TEST(ClipOfRig, StepsAreHeldUntilTheNextKey)
{
    GltfDocument gltf = test_support::two_joint_document();
    gltf.json["animations"][0]["samplers"][0]["interpolation"] = "STEP";
    const Clip clip = read(gltf);
    EXPECT_NEAR(elbow_deg(clip, 119), 0.0, of_angles_deg);
    EXPECT_NEAR(std::abs(elbow_deg(clip, 120)), 180.0, of_angles_deg);
    EXPECT_EQ(clip.holds, (std::vector<bool>{false, true, false}));
}

TEST(ClipOfRig, CubicSplinesAreEvaluatedByTheFormat)
{
    GltfDocument gltf = test_support::two_joint_document();
    const int spline =
        gltf.put<float>("VEC4", {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0});
    gltf.json["animations"][0]["samplers"][0] = {{"input", 5}, {"output", spline}, {"interpolation", "CUBICSPLINE"}};
    const Clip clip = read(gltf);
    for (const int frame : {0, 30, 60, 90}) {
        const double t = frame / 120.0, share = 3.0 * t * t - 2.0 * t * t * t;  // without tangents
        EXPECT_NEAR(elbow_deg(clip, frame), 2.0 * std::atan2(share, 1.0 - share) * 180.0 / M_PI, of_angles_deg)
            << frame;
    }
}

TEST(ClipOfRig, TheCurvesOfFbxNodesAreAMotion)
{
    for (const auto& [flags, half_deg] : {std::pair<std::int64_t, double>(4, 45.0), {2, 0.0}}) {  // linear, constant
        test_support::FbxFile file;
        const std::int64_t root = file.node("root", 0, "LimbNode", {});
        const std::int64_t elbow = file.node("elbow", root, "LimbNode", {{"Lcl Translation", {0, 2, 0}}});
        file.curves(file.layer(file.animation("Bend")), elbow, "Lcl Rotation", {0, 0, 0},
                    {{2, {{0, 1}, {0, 90}, flags}}});
        const test_support::ScratchFolder folder;
        const Clip clip = read_clip(folder.file("walk.fbx", file.text()));
        ASSERT_EQ(clip.frames(), 121);
        EXPECT_NEAR(elbow_deg(clip, 60), half_deg, of_angles_deg);
        EXPECT_EQ(clip.holds.at(std::ranges::find(clip.joints, "elbow") - clip.joints.begin()), flags == 2);
    }
}

TEST(ClipOfRig, AJointOfAnFbxFileThatMovesNoPointRestsBelowItsParent)
{
    test_support::FbxFile file;
    const std::int64_t root = file.node("root", 0, "LimbNode", {});
    const std::int64_t middle = file.node("middle", root, "LimbNode", {{"Lcl Translation", {0, 2, 0}}});
    const std::int64_t hand = file.node("hand", middle, "LimbNode", {{"Lcl Translation", {0, 1, 0}}});
    const std::int64_t mesh =
        file.mesh("skin", file.node("body", 0, "Mesh", {}), {1, 0, 0, 0, 3, 0, 0, 4, 1}, {0, 1, -3});
    const std::int64_t skin = file.skin(mesh, "");
    file.cluster(skin, root, {0}, {1}, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    file.cluster(skin, hand, {1, 2}, {1, 1}, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -3, 0, 1});
    file.curves(file.layer(file.animation("Bend")), middle, "Lcl Rotation", {0, 0, 0}, {{2, {{0, 1}, {0, 90}, 4}}});
    const test_support::ScratchFolder folder;
    const Clip clip = read_clip(folder.file("walk.fbx", file.text()));
    const auto row = std::ranges::find(clip.joints, "middle") - clip.joints.begin();
    EXPECT_EQ(Vec3(clip.zero_pose.row(row)), Vec3(0, 2, 0));
}

TEST(ClipOfRig, TwoMovingJointsOfOneNameAreRefused)
{
    GltfDocument gltf = test_support::two_joint_document();
    gltf.json["nodes"][0]["name"] = "elbow";
    EXPECT_EQ(read(gltf).joints, (std::vector<std::string>{"elbow (2)", "elbow", "body"})) << "only one of them moves";
    gltf.json["animations"][0]["channels"].push_back({{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}});
    expect_input_error([&] { read(gltf); }, "", "joint = elbow: two moving joints have this name");
}

TEST(ClipOfRig, AFileWithoutAMotionIsRefused)
{
    GltfDocument gltf = test_support::two_joint_document();
    gltf.json.erase("animations");
    expect_input_error([&] { read(gltf); }, "", "animations = 0: holds no motion");
}

}  // namespace
