// Reference: glTF 2.0, Sec. 3.5 (scenes and nodes), on small trees.

#include "experiments/rigs/rig_formats.hpp"
#include "experiments/rigs/rigged_body.hpp"
#include "tests/support/gltf_document.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace {

using namespace pbs;
using nlohmann::json;

// A document of two joints, which a test changes and reads.
class GltfRig : public testing::Test {
protected:
    json& primitive() { return gltf.json["meshes"][0]["primitives"][0]; }
    json& animation() { return gltf.json["animations"][0]; }

    Rig read() const
    {
        const test_support::ScratchFolder folder;
        return read_gltf_rig(folder.file("a.gltf", gltf.text()));
    }

    RigMesh read_mesh() const { return read().meshes.at(0); }

    void expect_refused(const std::string& field_and_value, const std::string& rule) const
    {
        const std::string message = test_support::refusal_of([&] { read(); });
        EXPECT_NE(message.find("a.gltf: " + field_and_value), std::string::npos) << message;
        EXPECT_NE(message.find(rule), std::string::npos) << message;
    }

    Rig rig_of_nodes(const std::string& nodes, const std::string& scenes = "{}")
    {
        for (const char* member : {"scene", "scenes", "skins", "animations"}) gltf.json.erase(member);
        gltf.json["nodes"] = json::parse(nodes);
        primitive()["attributes"] = {{"POSITION", 0}};
        gltf.json.update(json::parse(scenes));
        return read();
    }

    Triangles triangles_in_mode(int mode, const std::vector<std::uint16_t>& indices)
    {
        primitive()["mode"] = mode;
        primitive()["indices"] = gltf.put("SCALAR", indices);
        return read_mesh().triangles;
    }

    // The last key's rotation where the document's rotations are these.
    template <typename Number>
    Eigen::Vector4d last_rotation(const std::vector<Number>& numbers)
    {
        animation()["samplers"][0]["output"] = gltf.put("VEC4", numbers, true);
        return read().animations.at(0).nodes.at(0).rotation->values.back();
    }

    test_support::GltfDocument gltf = test_support::two_joint_document();
};
using GltfMeshes = GltfRig;
using GltfAnimations = GltfRig;
using GltfNumbers = GltfRig;
using GltfLook = GltfRig;

TEST_F(GltfRig, HasItsNodesMeshesAndMetres)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("a.gltf", gltf.text());
    const Rig rig = read_gltf_rig(path);
    EXPECT_EQ(rig.file, path);
    EXPECT_EQ(rig.unit_m, 1.0);
    ASSERT_EQ(rig.nodes.size(), 3u);
    EXPECT_EQ(rig.nodes[1].name, "elbow");
    EXPECT_EQ(rig.nodes[1].parent, 0);
    EXPECT_EQ(rig.nodes[1].rest.translation, Vec3(0, 2, 0));
    EXPECT_EQ(rig.nodes[2].parent, -1);
    ASSERT_EQ(rig.meshes.size(), 1u);
    EXPECT_EQ(rig.meshes[0].node, 2);
    EXPECT_TRUE(rig.remarks.empty());
}

TEST_F(GltfRig, ParentsPrecedeTheirChildrenWhateverTheFilesOrder)
{
    const Rig rig =
        rig_of_nodes(R"([{"name": "tip"}, {"name": "elbow", "children": [0]}, {"name": "root", "children": [1, 3]},
                                     {"name": "body", "mesh": 0}])");
    ASSERT_EQ(rig.nodes.size(), 4u);
    for (int n = 0; n < 4; ++n) EXPECT_LT(rig.nodes[std::size_t(n)].parent, n);
    const auto parent_of = [&](const std::string& name) -> std::string {
        for (const RigNode& node : rig.nodes)
            if (node.name == name) return node.parent < 0 ? "" : rig.nodes[std::size_t(node.parent)].name;
        return "missing";
    };
    EXPECT_EQ(parent_of("root"), "");
    EXPECT_EQ(parent_of("elbow"), "root");
    EXPECT_EQ(parent_of("tip"), "elbow");
    EXPECT_EQ(rig.nodes[std::size_t(rig.meshes.at(0).node)].name, "body");
}

TEST_F(GltfRig, BodyPartsAreThoseOfVrmsTable)
{
    const std::string list = R"({"VRM": {"humanoid": {"humanBones": [{"bone": "spine", "node": 1}, {"node": 0}, 3]}}})",
                      object = R"({"humanoid": {"humanBones": {"spine": {"node": 1}}}})";
    for (const std::string& extensions :
         {list, "{\"VRMC_vrm\": " + object + "}", "{\"VRMC_vrm_animation\": " + object + "}"}) {
        gltf.json["extensions"] = json::parse(extensions);
        const Rig rig = read();
        EXPECT_EQ(rig.nodes[1].body_part, "spine");
        EXPECT_EQ(rig.nodes[0].body_part, "");
    }
    gltf.json["extensions"]["VRMC_vrm_animation"]["humanoid"]["humanBones"]["spine"]["node"] = 3;
    EXPECT_EQ(read().nodes[1].body_part, "");
    EXPECT_EQ(read().remarks,
              std::vector<std::string>{"humanoid/humanBones/spine names no node of the file, and is left out"});
    for (const char* odd :
         {R"({"VRM": 1})", R"({"VRM": {"humanoid": []}})", R"({"VRMC_vrm": {"humanoid": {"humanBones": "spine"}}})"}) {
        gltf.json["extensions"] = json::parse(odd);
        EXPECT_EQ(read().nodes[1].body_part, "");
    }
}

TEST_F(GltfRig, TransformsAreReadAsPartsOrAsMatrix)
{
    const Rig rig = rig_of_nodes(R"([{"translation": [1, 2, 3], "rotation": [0, 0, 3, 4], "scale": [1, -2, 3]},
                                     {"matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]}])");
    EXPECT_EQ(rig.nodes[0].rest.translation, Vec3(1, 2, 3));
    EXPECT_EQ(rig.nodes[0].rest.rotation.coeffs(), Eigen::Vector4d(0, 0, 0.6, 0.8)) << "of unit length";
    EXPECT_EQ(rig.nodes[0].rest.scale, Vec3(1, -2, 3));
    EXPECT_FALSE(rig.nodes[0].rest.matrix);
    ASSERT_TRUE(rig.nodes[1].rest.matrix);
    EXPECT_EQ(*rig.nodes[1].rest.matrix * Vec3(1, 0, 0), Vec3(5, 7, 7)) << "stored by columns";
}

TEST_F(GltfRig, ShowsTheMeshesOfTheDefaultScene)
{
    const std::string nodes = R"([{"name": "a", "mesh": 0}, {"name": "b", "children": [2]}, {"name": "c", "mesh": 0}])";
    const auto shown = [&](const std::string& scenes) {
        std::string names;
        const Rig rig = rig_of_nodes(nodes, scenes);
        for (const RigMesh& mesh : rig.meshes) names += rig.nodes[std::size_t(mesh.node)].name;
        EXPECT_EQ(rig.nodes.size(), 3u) << "nodes of other scenes stay";  // and one mesh may belong to several
        return names;
    };
    const std::string scenes = R"("scenes": [{"nodes": [0]}, {"nodes": [1]}])";
    EXPECT_EQ(shown("{\"scene\": 0, " + scenes + "}"), "a");
    EXPECT_EQ(shown("{\"scene\": 1, " + scenes + "}"), "c");
    EXPECT_EQ(shown("{" + scenes + "}"), "a") << "the first scene where none is default";
    EXPECT_EQ(shown("{}"), "ac") << "all nodes where there is no scene";
}

TEST_F(GltfRig, ExtensionsThatDoNotMoveVerticesAreAllowed)
{
    gltf.json["extensions"] = json::parse(R"({"KHR_lights_punctual": {"lights": [{"type": "point"}]}})");
    for (const char* extension :
         {"KHR_materials_unlit", "KHR_texture_transform", "KHR_mesh_quantization", "KHR_lights_punctual"}) {
        gltf.json["extensionsRequired"] = {extension};
        gltf.json["nodes"][0]["extensions"] = {{extension, {{"light", 0}}}};
        EXPECT_NO_THROW(read()) << extension;
    }
    gltf.json["extensionsRequired"] = {"ACME_texture"};
    gltf.json["nodes"][0].erase("extensions");
    gltf.json["textures"] = {{{"extensions", {{"ACME_texture", {{"source", 0}}}}}}};
    EXPECT_NO_THROW(read());
    for (json* owner :
         {&gltf.json["nodes"][1], &primitive(), &animation()["channels"][0]["target"], &gltf.json["bufferViews"][2]}) {
        (*owner)["extensions"] = {{"ACME_texture", json::object()}};
        expect_refused("extensionsRequired = ACME_texture: not supported", "export the model without it");
        owner->erase("extensions");
    }
}

TEST_F(GltfRig, BuffersMayBeNamedAsTheirFiles)
{
    for (const auto& [file, uri] :
         {std::pair("arm 10%.bin", "arm 10%.bin"), std::pair("arm 10%.bin", "arm%2010%25.bin"),
          std::pair("50%more+.bin", "50%more+.bin"), std::pair("100%", "100%")}) {
        const test_support::ScratchFolder folder;
        folder.file(file, gltf.bytes);
        gltf.json["buffers"] = {{{"byteLength", gltf.bytes.size()}, {"uri", uri}}};
        EXPECT_EQ(read_gltf_rig(folder.file("a.gltf", gltf.json.dump())).meshes.at(0).points.rows(), 4) << uri;
    }
}

// Reference: glTF 2.0, Sec. 3.7.2 (primitives) and 3.7.3 (skins), on four points.

TEST_F(GltfMeshes, ListsStripsAndFansOfTrianglesOrTheVerticesInTheirOrder)
{
    EXPECT_EQ(triangles_in_mode(4, {0, 1, 2, 2, 1, 3}), (Triangles(2, 3) << 0, 1, 2, 2, 1, 3).finished());
    EXPECT_EQ(triangles_in_mode(5, {0, 1, 2, 3}), (Triangles(2, 3) << 0, 1, 2, 1, 3, 2).finished());
    EXPECT_EQ(triangles_in_mode(6, {0, 1, 2, 3}), (Triangles(2, 3) << 0, 1, 2, 0, 2, 3).finished());
    primitive()["mode"] = 4;
    primitive().erase("indices");
    EXPECT_EQ(read_mesh().triangles, (Triangles(1, 3) << 0, 1, 2).finished()) << "the fourth vertex begins no triangle";
}

TEST_F(GltfMeshes, SeveralPrimitivesAreOneMesh)
{
    gltf.json["meshes"][0]["primitives"].push_back(primitive());
    gltf.json["meshes"][0]["primitives"][1]["attributes"]["WEIGHTS_0"] = gltf.put_copy(3);
    const RigMesh mesh = read_mesh();
    EXPECT_EQ(mesh.points.rows(), 8);
    EXPECT_EQ(mesh.triangles, (Triangles(4, 3) << 0, 1, 3, 1, 2, 3, 4, 5, 7, 5, 6, 7).finished());
    EXPECT_EQ(mesh.skin.first, (std::vector<int>{0, 1, 3, 4, 6, 7, 9, 10, 12}));
}

// Forty primitives of an exporter that shares the numbers of all of them.
TEST_F(GltfMeshes, PrimitivesWithTheSameAttributesShareTheirPoints)
{
    const RigMesh one = read_mesh();
    primitive()["material"] = 0;
    for (int material = 1; material < 40; ++material) {
        json other = primitive();
        other["material"] = material;
        other["indices"] = gltf.put<std::uint16_t>("SCALAR", {3, 1, 0});
        gltf.json["meshes"][0]["primitives"].push_back(other);
    }
    const RigMesh mesh = read_mesh();
    EXPECT_EQ(mesh.points, one.points);
    EXPECT_EQ(mesh.skin.first, one.skin.first);
    EXPECT_EQ(mesh.triangles.rows(), 2 + 39);
    EXPECT_EQ(Eigen::RowVector3i(mesh.triangles.row(40)), Eigen::RowVector3i(3, 1, 0));
    EXPECT_EQ(mesh.look.material.back(), 39);
}

TEST_F(GltfMeshes, AWeightThatIsNoNumberIsRefusedByTheNumberOfItsPoints)
{
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    primitive()["attributes"]["WEIGHTS_0"] =
        gltf.put<float>("VEC4", {1, 0, 0, 0, nan, 0.5F, 0, 0, 1, 0, 0, 0, 0.25F, 0.75F, 0, 0});
    expect_refused("mesh arm, weights = 1 of 4 points: ", "expected at most 1 %");
    primitive()["attributes"]["POSITION"] = gltf.put<float>("VEC3", {1, 0, 0, 1, 2, 0, 1, nan, 0, nan, 2, 0});
    expect_refused("meshes/0/primitives/0/attributes/POSITION = 2 of 4 elements: ",
                   "expected finite numbers, first in element 2");
}

TEST_F(GltfMeshes, InverseBindMatricesByRowsAreRefused)
{
    gltf.json["skins"][0]["inverseBindMatrices"] = gltf.put<float>(
        "MAT4", {1, 0, 0, -1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, -1, 0, 1, 0, -2, 0, 0, 1, 0, 0, 0, 0, 1});
    expect_refused("skins/0/inverseBindMatrices = matrix 0: is stored by rows", "transpose");
    gltf.json["skins"][0]["inverseBindMatrices"] = gltf.put<float>(
        "MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 0.5F, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 0, 1});
    expect_refused("skins/0/inverseBindMatrices = matrix 1: expected the last row 0, 0, 0, 1", "");
}

TEST_F(GltfMeshes, PointsLinesAndMorphTargetsAreLeftOutWithARemark)
{
    json lines = primitive();
    lines["mode"] = 1;
    gltf.json["meshes"][0]["primitives"].push_back(lines);
    const Rig rig = read();
    EXPECT_EQ(rig.meshes.at(0).points.rows(), 4);
    EXPECT_EQ(rig.remarks, std::vector<std::string>{"mesh arm: points and lines are left out"});
    primitive()["mode"] = 0;
    EXPECT_TRUE(read().meshes.empty()) << "a mesh without triangles is none";
    gltf = test_support::two_joint_document();
}

// Theory: glTF 2.0, Sec. 3.7.2.2: points + sum_t w_t displacement_t, with the weights of the animation, else of the
// node, else of the mesh.
TEST_F(GltfMeshes, AreMovedByTheirMorphTargetsBeforeTheirSkin)
{
    const Positions plain = read_mesh().points;
    std::vector<float> up;
    for (Eigen::Index p = 0; p < plain.rows(); ++p) up.insert(up.end(), {0.0F, static_cast<float>(p), 1.0F});
    const int target = gltf.put("VEC3", up);
    primitive()["targets"] = {{{"POSITION", 0}}, {{"POSITION", target}}};
    const auto expect_weights = [&](const Positions& points, double first, double second) {
        const Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>> second_target(up.data(),
                                                                                                       plain.rows(), 3);
        EXPECT_LE((points - (1.0 + first) * plain - second * second_target.cast<double>()).cwiseAbs().maxCoeff(), 1e-6);
    };
    gltf.json["meshes"][0]["weights"] = {0.25, 0.5};
    expect_weights(read_mesh().points, 0.25, 0.5);
    json& node = *std::ranges::find_if(gltf.json["nodes"], [](const json& other) { return other.contains("mesh"); });
    node["weights"] = {0.0, 2.0};
    expect_weights(read_mesh().points, 0.0, 2.0);

    animation()["samplers"] = {{{"input", gltf.put("SCALAR", std::vector<float>{0, 1})},
                                {"output", gltf.put("SCALAR", std::vector<float>{0, 2, 1, 4})}}};
    const auto number = std::distance(gltf.json["nodes"].begin(), std::ranges::find(gltf.json["nodes"], node));
    animation()["channels"] = {{{"sampler", 0}, {"target", {{"node", number}, {"path", "weights"}}}}};
    const Rig rig = read();
    expect_weights(rig.meshes.at(0).points, 0.0, 2.0);
    expect_weights(morphed_points(rig.meshes.at(0), &rig.animations.at(0), 0.25), 0.25, 2.5);
    EXPECT_TRUE(rig.remarks.empty());
    node["weights"] = {1.0, 1.0, 1.0};
    expect_refused("meshes/0/weights = 3", "expected one for each of the 2 morph targets");
}

TEST_F(GltfMeshes, HaveTheSkinOfTheirNode)
{
    const RigMesh mesh = read_mesh();
    EXPECT_EQ(mesh.name, "arm");
    ASSERT_EQ(mesh.joints.size(), 2u);
    EXPECT_EQ(mesh.joints[1].node, 1);
    EXPECT_EQ(mesh.joints[1].inverse_bind * Vec3(1, 2, 0), Vec3(0, 0, 0));
    EXPECT_EQ(mesh.skin.first, (std::vector<int>{0, 1, 3, 4, 6}));
    EXPECT_EQ(mesh.skin.bone, (std::vector<int>{0, 0, 1, 1, 0, 1}));
    EXPECT_EQ(mesh.skin.weight, (std::vector<double>{1.0, 0.5, 0.5, 1.0, 0.25, 0.75}));
    gltf.json["skins"][0].erase("inverseBindMatrices");
    for (const SkinJoint& joint : read_mesh().joints)
        EXPECT_EQ(joint.inverse_bind.matrix(), Eigen::Matrix4d(Eigen::Matrix4d::Identity()));
}

TEST_F(GltfMeshes, ASecondSetOfJointsAddsItsWeights)
{
    const int joints = gltf.put<std::uint8_t>("VEC4", {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    const int weights = gltf.put<float>("VEC4", {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    primitive()["attributes"].update({{"JOINTS_1", joints}, {"WEIGHTS_1", weights}});
    const Rig rig = read();
    EXPECT_EQ(rig.meshes.at(0).skin.bone, (std::vector<int>{0, 1, 0, 1, 1, 0, 1}));
    EXPECT_EQ(rig.meshes.at(0).skin.weight, (std::vector<double>{0.5, 0.5, 0.5, 0.5, 1.0, 0.25, 0.75}));
    EXPECT_EQ(rig.notes.size(), 1u) << "1 + 1 is not one";
}

TEST_F(GltfMeshes, NormalisedBytesAsWeightsAndAnyJointOfAWeightOfZero)
{
    primitive()["attributes"]["WEIGHTS_0"] =
        gltf.put<std::uint8_t>("VEC4", {255, 0, 0, 0, 51, 204, 0, 0, 255, 0, 0, 0, 102, 153, 0, 0}, true);
    const Weights skin = read_mesh().skin;
    ASSERT_EQ(skin.weight.size(), 6u);
    EXPECT_DOUBLE_EQ(skin.weight[1], 0.2);
    EXPECT_DOUBLE_EQ(skin.weight[4], 0.4);
    // glTF 2.0, Sec. 3.7.3.3: unused joints should be zero, and often are not
    gltf = test_support::two_joint_document();
    primitive()["attributes"]["JOINTS_0"] =
        gltf.put<std::uint8_t>("VEC4", {0, 99, 0, 0, 0, 1, 99, 0, 1, 0, 0, 99, 0, 1, 0, 0});
    EXPECT_EQ(read_mesh().skin.bone, (std::vector<int>{0, 0, 1, 1, 0, 1}));
}

// Reference: glTF 2.0, Sec. 3.11, on an animation of two keys.

TEST_F(GltfAnimations, HaveTheKeysOfTheirSamplers)
{
    const Rig rig = read();
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

TEST_F(GltfAnimations, MayEndBeforeTheTimeZero)
{
    animation()["samplers"][0]["input"] = gltf.put<float>("SCALAR", {-2.0F, -1.0F});
    const RigAnimation moved = read().animations.at(0);
    EXPECT_EQ(moved.start_s, -2.0);
    EXPECT_EQ(moved.end_s, -1.0);
}

TEST_F(GltfAnimations, ACubicSplineHasThreeValuesPerKey)
{
    const int output = gltf.put<float>("VEC3", {1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0, 5, 0, 0, 6, 0, 0});
    animation()["samplers"][0].update({{"interpolation", "CUBICSPLINE"}, {"output", output}});
    animation()["channels"][0]["target"]["path"] = "translation";
    const Rig rig = read();
    const KeyTrack& track = rig.animations.at(0).nodes.at(0).translation.value();
    EXPECT_EQ(track.interpolation, Interpolation::cubic_spline);
    ASSERT_EQ(track.values.size(), 6u);
    EXPECT_EQ(track.values[4], Eigen::Vector4d(5, 0, 0, 0));
}

TEST_F(GltfAnimations, AStepAndALinearTrackOfOneNodeAreReadTogether)
{
    const int times = gltf.put<float>("SCALAR", {0.5F, 2.0F}), scales = gltf.put<float>("VEC3", {1, 1, 1, 2, 2, 2});
    animation()["samplers"].push_back({{"input", times}, {"output", scales}, {"interpolation", "STEP"}});
    animation()["channels"].push_back({{"sampler", 1}, {"target", {{"node", 1}, {"path", "scale"}}}});
    const RigAnimation animation = read().animations.at(0);
    ASSERT_EQ(animation.nodes.size(), 1u);
    EXPECT_TRUE(animation.nodes[0].rotation && animation.nodes[0].scale && !animation.nodes[0].translation);
    EXPECT_EQ(animation.nodes[0].scale->interpolation, Interpolation::step);
    EXPECT_EQ(animation.start_s, 0.0);
    EXPECT_EQ(animation.end_s, 2.0);
}

TEST_F(GltfAnimations, WhatMovesNoNodeIsLeftOut)
{
    const json turn = animation()["channels"][0], no_node = {{"sampler", 0}, {"target", {{"path", "rotation"}}}},
               without_targets = {{"sampler", 0}, {"target", {{"node", 2}, {"path", "weights"}}}};
    for (const json& nothing : {json::array({no_node}), json::array()}) {
        animation()["channels"] = nothing;
        EXPECT_TRUE(read().animations.empty()) << nothing;
    }
    for (const json& other : {no_node, without_targets}) {
        animation()["channels"] = {turn, other};
        const Rig rig = read();
        EXPECT_EQ(rig.animations.at(0).nodes.size(), 1u) << other;
        const bool is_named = other == without_targets;
        EXPECT_EQ(
            rig.remarks,
            is_named
                ? std::vector<std::string>{"animation Bend: its weights of node body are left out, for no mesh with "
                                           "morph targets is shown there"}
                : std::vector<std::string>{});
    }
    gltf.json.erase("animations");
    EXPECT_TRUE(read().animations.empty());
}

TEST_F(GltfAnimations, WithoutANameAreNumberedAndAMeshIsCalledAsItsNode)
{
    gltf.json["meshes"][0].erase("name");
    EXPECT_EQ(read_mesh().name, "body");
    gltf.json["animations"].push_back(animation());
    gltf.json["animations"][1].erase("name");
    EXPECT_EQ(read().animations.at(1).name, "animation 1");
}

// Reference: glTF 2.0, Sec. 3.6.2 (accessors, sparse accessors) and the conversion of normalised integers in
// Sec. 3.6.2.2, by hand.

TEST_F(GltfNumbers, NormalisedBytesAndShorts)  // the least signed number is minus one, too
{
    EXPECT_EQ(last_rotation<std::uint8_t>({0, 0, 0, 255, 0, 51, 102, 255}), Eigen::Vector4d(0.0, 0.2, 0.4, 1.0));
    EXPECT_EQ(last_rotation<std::uint16_t>({0, 0, 0, 65535, 0, 13107, 26214, 65535}),
              Eigen::Vector4d(0.0, 0.2, 0.4, 1.0));
    EXPECT_EQ(last_rotation<std::int8_t>({0, 0, 0, 127, 0, 127, -127, 1}),
              Eigen::Vector4d(0.0, 1.0, -1.0, 1.0 / 127.0));
    EXPECT_EQ(last_rotation<std::int16_t>({0, 0, 0, 32767, 0, 32767, -32767, 1}),
              Eigen::Vector4d(0.0, 1.0, -1.0, 1.0 / 32767.0));
    EXPECT_EQ(last_rotation<std::int8_t>({0, 0, 0, 127, -128, 0, 0, 127}).x(), -1.0);
    EXPECT_EQ(last_rotation<std::int16_t>({0, 0, 0, 32767, -32768, 0, 0, 32767}).x(), -1.0);
}

TEST_F(GltfNumbers, IntegersThatAreNotNormalisedKeepTheirValues)  // as KHR_mesh_quantization stores points
{
    primitive()["attributes"]["POSITION"] = gltf.put<std::int16_t>("VEC3", {-300, 0, 7, 1, 2, 0, 1, 4, 0, 2, 2, 0});
    EXPECT_EQ(Vec3(read_mesh().points.row(0)), Vec3(-300, 0, 7));
}

// Normals and two sets of texture coordinates; the second primitive has no normals and another material.
TEST_F(GltfLook, IsThatOfEachPrimitive)
{
    json second = primitive();
    primitive()["attributes"]["NORMAL"] = gltf.put<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0, 1});
    const int uv = gltf.put<float>("SCALAR", {0, 1, 2, 3, 4, 5, 6, 7});
    gltf.json["accessors"][uv].update({{"type", "VEC2"}, {"count", 4}});
    second["attributes"].update({{"TEXCOORD_0", uv}, {"TEXCOORD_1", uv}});
    second["material"] = 1;
    gltf.json["meshes"][0]["primitives"].push_back(second);
    const RigLook look = read_mesh().look;
    ASSERT_EQ(look.numbers.rows(), 8);
    ASSERT_EQ(look.numbers.cols(), 7);
    EXPECT_EQ(look.numbers.row(2), (Eigen::RowVectorXf(7) << 0, 1, 0, 0, 0, 0, 0).finished());
    EXPECT_EQ(look.numbers.row(5), (Eigen::RowVectorXf(7) << 0, 0, 0, 2, 3, 2, 3).finished());
    EXPECT_EQ(look.material, (std::vector<int>{-1, -1, 1, 1}));
}

TEST_F(GltfLook, DamagedNumbersAreLeftOutWithARemark)
{
    primitive()["attributes"]["NORMAL"] = 5;  // two numbers, which are times
    const Rig rig = read();
    EXPECT_EQ(rig.meshes.at(0).look.numbers.size(), 0);
    ASSERT_EQ(rig.remarks.size(), 1u);
    EXPECT_NE(rig.remarks[0].find("mesh arm: NORMAL is left out: "), std::string::npos) << rig.remarks[0];
}

TEST_F(GltfLook, MaterialsHaveTheImagesOfTheFileAndOfItsFolderAndWhiteForTheRest)
{
    const std::string png = "\x89PNG1", jpeg = "\xff\xd8\xffz", other = "\x89PNG3";
    const test_support::ScratchFolder folder;
    folder.file("my skin.jpg", jpeg);
    const int view = gltf.put_bytes(std::vector<char>(png.begin(), png.end()));
    gltf.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}},
                           {{"uri", "my%20skin.jpg"}},
                           {{"uri", "data:image/png;base64," + test_support::base64(other)}},
                           {{"uri", "lost.png"}},
                           {{"uri", "../outside.png"}}};
    for (int image = 0; image < 5; ++image) gltf.json["textures"].push_back({{"source", image}});
    gltf.json["materials"] = {{{"name", "skin"}, {"normalTexture", {{"index", 1}}}, {"emissiveFactor", {1, 0, 0}}},
                              {{"name", "cloth"}, {"normalTexture", {{"index", 3}}}}};
    const RigMaterials materials = read_gltf_materials(folder.file("a.gltf", gltf.text()));
    ASSERT_EQ(materials.images.size(), 5u);
    EXPECT_EQ(materials.images[0], png);
    EXPECT_EQ(materials.images[1], jpeg);
    EXPECT_EQ(materials.images[2], other);
    EXPECT_EQ(materials.images[3].substr(0, 4), png.substr(0, 4));
    ASSERT_EQ(materials.remarks.size(), 2u);
    EXPECT_NE(materials.remarks[0].find("lost.png: expected PNG or JPEG in the file or below its folder"),
              std::string::npos);
    const json document = json::parse(materials.document);
    EXPECT_EQ(document["images"][1], (json{{"mimeType", "image/jpeg"}}));
    EXPECT_EQ(document["textures"], gltf.json["textures"]);
    EXPECT_EQ(document["materials"][0], gltf.json["materials"][0]);
    EXPECT_EQ(document["materials"][1], (json{{"name", "cloth"}})) << "white is no direction";
}

TEST_F(GltfNumbers, OfAStridedViewAndAnOffset)
{
    // Each of the four points is followed by a number that is none of its own; one number precedes them.
    gltf.put<float>("SCALAR", {99, 1, 2, 3, 99, 4, 5, 6, 99, 7, 8, 9, 99, 10, 11, 12});
    gltf.json["bufferViews"].back()["byteStride"] = 16;
    gltf.json["accessors"].back().update({{"byteOffset", 4}, {"type", "VEC3"}, {"count", 4}});
    primitive()["attributes"]["POSITION"] = gltf.json["accessors"].size() - 1;
    EXPECT_EQ(read_mesh().points, (Positions(4, 3) << 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12).finished());
}

// Points 1 and 3 get other places.
TEST_F(GltfNumbers, ASparseAccessorReplacesSomeElementsOfItsViewOrOfZeros)
{
    const int indices = gltf.put_bytes<std::uint8_t>({1, 3}), values = gltf.put_bytes<float>({10, 20, 30, 40, 50, 60});
    json& points = gltf.json["accessors"][0];
    points["sparse"] = {{"count", 2},
                        {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                        {"values", {{"bufferView", values}}}};
    EXPECT_EQ(read_mesh().points, (Positions(4, 3) << 1, 0, 0, 10, 20, 30, 1, 4, 0, 40, 50, 60).finished());
    points.erase("bufferView");
    EXPECT_EQ(read_mesh().points, (Positions(4, 3) << 0, 0, 0, 10, 20, 30, 0, 0, 0, 40, 50, 60).finished());
    points.erase("sparse");
    EXPECT_EQ(read_mesh().points, Positions(Positions::Zero(4, 3)));
}

}  // namespace
