// Reference: glTF 2.0, Sec. 3.7.2 (primitives) and 3.7.3 (skins), on four points.
#include "pbs/rig/gltf_rig.hpp"

#include "tests/support/gltf_document.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;
using nlohmann::json;
using test_support::GltfDocument;
using test_support::two_joint_document;

Rig rig_from(const GltfDocument& gltf)
{
    const test_support::ScratchFolder folder;
    return read_gltf_rig(folder.file("a.gltf", gltf.text()));
}

json& primitive_of(GltfDocument& gltf)
{
    return gltf.json["meshes"][0]["primitives"][0];
}

Triangles triangles_in_mode(int mode, const std::vector<std::uint16_t>& indices)
{
    GltfDocument gltf = two_joint_document();
    primitive_of(gltf)["mode"] = mode;
    primitive_of(gltf)["indices"] = gltf.put("SCALAR", indices);
    return rig_from(gltf).meshes.at(0).triangles;
}

TEST(GltfMeshes, ListsStripsAndFansOfTriangles)
{
    EXPECT_EQ(triangles_in_mode(4, {0, 1, 2, 2, 1, 3}), (Triangles(2, 3) << 0, 1, 2, 2, 1, 3).finished());
    EXPECT_EQ(triangles_in_mode(5, {0, 1, 2, 3}), (Triangles(2, 3) << 0, 1, 2, 1, 3, 2).finished());
    EXPECT_EQ(triangles_in_mode(6, {0, 1, 2, 3}), (Triangles(2, 3) << 0, 1, 2, 0, 2, 3).finished());
}

TEST(GltfMeshes, WithoutIndicesTrianglesAreThoseOfTheVerticesInTheirOrder)
{
    GltfDocument gltf = two_joint_document();
    primitive_of(gltf).erase("indices");
    EXPECT_EQ(rig_from(gltf).meshes.at(0).triangles, (Triangles(1, 3) << 0, 1, 2).finished()) << "the fourth vertex begins no triangle";
}

TEST(GltfMeshes, SeveralPrimitivesAreOneMesh)
{
    GltfDocument gltf = two_joint_document();
    gltf.json["meshes"][0]["primitives"].push_back(primitive_of(gltf));
    const RigMesh mesh = rig_from(gltf).meshes.at(0);
    EXPECT_EQ(mesh.points.rows(), 8);
    EXPECT_EQ(mesh.triangles, (Triangles(4, 3) << 0, 1, 3, 1, 2, 3, 4, 5, 7, 5, 6, 7).finished());
    EXPECT_EQ(mesh.skin.first, (std::vector<int>{0, 1, 3, 4, 6, 7, 9, 10, 12}));
}

TEST(GltfMeshes, PointsAndLinesAreLeftOutWithARemark)
{
    GltfDocument gltf = two_joint_document();
    json lines = primitive_of(gltf);
    lines["mode"] = 1;
    gltf.json["meshes"][0]["primitives"].push_back(lines);
    const Rig rig = rig_from(gltf);
    EXPECT_EQ(rig.meshes.at(0).points.rows(), 4);
    EXPECT_EQ(rig.remarks, std::vector<std::string>{"mesh arm: points and lines are left out"});
    primitive_of(gltf)["mode"] = 0;
    EXPECT_TRUE(rig_from(gltf).meshes.empty()) << "a mesh without triangles is none";
}

TEST(GltfMeshes, MorphTargetsAreLeftOutWithARemark)
{
    GltfDocument gltf = two_joint_document();
    primitive_of(gltf)["targets"] = {{{"POSITION", 0}}, {{"POSITION", 0}}};
    const Rig rig = rig_from(gltf);
    EXPECT_EQ(rig.meshes.at(0).points.row(0), Eigen::RowVector3d(1, 0, 0));
    EXPECT_EQ(rig.remarks, std::vector<std::string>{"mesh arm: 2 morph targets are left out"});
}

TEST(GltfMeshes, HaveTheSkinOfTheirNode)
{
    const RigMesh mesh = rig_from(two_joint_document()).meshes.at(0);
    EXPECT_EQ(mesh.name, "arm");
    ASSERT_EQ(mesh.joints.size(), 2u);
    EXPECT_EQ(mesh.joints[1].node, 1);
    EXPECT_EQ(mesh.joints[1].inverse_bind * Vec3(1, 2, 0), Vec3(0, 0, 0));
    EXPECT_EQ(mesh.skin.first, (std::vector<int>{0, 1, 3, 4, 6}));
    EXPECT_EQ(mesh.skin.bone, (std::vector<int>{0, 0, 1, 1, 0, 1}));
    EXPECT_EQ(mesh.skin.weight, (std::vector<double>{1.0, 0.5, 0.5, 1.0, 0.25, 0.75}));
}

TEST(GltfMeshes, WithoutInverseBindMatricesTheyAreIdentities)
{
    GltfDocument gltf = two_joint_document();
    gltf.json["skins"][0].erase("inverseBindMatrices");
    for (const SkinJoint& joint : rig_from(gltf).meshes.at(0).joints)
        EXPECT_EQ(joint.inverse_bind.matrix(), Eigen::Matrix4d(Eigen::Matrix4d::Identity()));
}

TEST(GltfMeshes, ASecondSetOfJointsAddsItsWeights)
{
    GltfDocument gltf = two_joint_document();
    const int joints = gltf.put<std::uint8_t>("VEC4", {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    const int weights = gltf.put<float>("VEC4", {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    primitive_of(gltf)["attributes"].update({{"JOINTS_1", joints}, {"WEIGHTS_1", weights}});
    const Rig rig = rig_from(gltf);
    EXPECT_EQ(rig.meshes.at(0).skin.bone, (std::vector<int>{0, 1, 0, 1, 1, 0, 1}));
    EXPECT_EQ(rig.meshes.at(0).skin.weight, (std::vector<double>{0.5, 0.5, 0.5, 0.5, 1.0, 0.25, 0.75}));
    EXPECT_EQ(rig.remarks.size(), 1u) << "1 + 1 is not one";
}

TEST(GltfMeshes, NormalisedBytesAsWeights)
{
    GltfDocument gltf = two_joint_document();
    primitive_of(gltf)["attributes"]["WEIGHTS_0"] =
        gltf.put<std::uint8_t>("VEC4", {255, 0, 0, 0, 51, 204, 0, 0, 255, 0, 0, 0, 102, 153, 0, 0}, true);
    const Weights skin = rig_from(gltf).meshes.at(0).skin;
    ASSERT_EQ(skin.weight.size(), 6u);
    EXPECT_DOUBLE_EQ(skin.weight[1], 0.2);
    EXPECT_DOUBLE_EQ(skin.weight[4], 0.4);
}

TEST(GltfMeshes, TheJointOfAWeightOfZeroMayBeAnything)  // glTF 2.0, Sec. 3.7.3.3: unused joints should be zero, and often are not
{
    GltfDocument gltf = two_joint_document();
    primitive_of(gltf)["attributes"]["JOINTS_0"] = gltf.put<std::uint8_t>("VEC4", {0, 99, 0, 0, 0, 1, 99, 0, 1, 0, 0, 99, 0, 1, 0, 0});
    EXPECT_EQ(rig_from(gltf).meshes.at(0).skin.bone, (std::vector<int>{0, 0, 1, 1, 0, 1}));
}

TEST(GltfMeshes, AMeshWithoutANameIsCalledAsItsNode)
{
    GltfDocument gltf = two_joint_document();
    gltf.json["meshes"][0].erase("name");
    EXPECT_EQ(rig_from(gltf).meshes.at(0).name, "body");
}

}  // namespace
