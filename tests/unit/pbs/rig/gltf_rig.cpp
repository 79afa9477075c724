// Reference: glTF 2.0, Sec. 3.5 (scenes and nodes), on small trees.
#include "pbs/rig/gltf_rig.hpp"

#include "tests/support/gltf_document.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;
using nlohmann::json;
using test_support::GltfDocument;
using test_support::two_joint_document;

Rig rig_of_nodes(const std::string& nodes, const std::string& scenes = "")
{
    GltfDocument gltf = two_joint_document();
    for (const char* member : {"scene", "scenes", "skins", "animations"}) gltf.json.erase(member);
    gltf.json["nodes"] = json::parse(nodes);
    gltf.json["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", 0}};
    if (!scenes.empty()) gltf.json.update(json::parse(scenes));
    const test_support::ScratchFolder folder;
    return read_gltf_rig(folder.file("a.gltf", gltf.text()));
}

TEST(GltfRig, HasItsNodesMeshesAndMetres)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("a.gltf", two_joint_document().text());
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

TEST(GltfRig, ParentsPrecedeTheirChildrenWhateverTheFilesOrder)
{
    const Rig rig = rig_of_nodes(R"([{"name": "tip"}, {"name": "elbow", "children": [0]}, {"name": "root", "children": [1, 3]},
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

TEST(GltfRig, TransformsAreReadAsPartsOrAsMatrix)
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

TEST(GltfRig, ShowsTheMeshesOfTheDefaultScene)
{
    const std::string nodes = R"([{"name": "a", "mesh": 0}, {"name": "b", "children": [2]}, {"name": "c", "mesh": 0}])";
    const auto shown = [&](const std::string& scenes) {
        std::string names;
        const Rig rig = rig_of_nodes(nodes, scenes);
        for (const RigMesh& mesh : rig.meshes) names += rig.nodes[std::size_t(mesh.node)].name;
        EXPECT_EQ(rig.nodes.size(), 3u) << "nodes of other scenes stay";
        return names;
    };
    const std::string scenes = R"("scenes": [{"nodes": [0]}, {"nodes": [1]}])";
    EXPECT_EQ(shown("{\"scene\": 0, " + scenes + "}"), "a");
    EXPECT_EQ(shown("{\"scene\": 1, " + scenes + "}"), "c");
    EXPECT_EQ(shown("{" + scenes + "}"), "a") << "the first scene where none is default";
    EXPECT_EQ(shown(""), "ac") << "all nodes where there is no scene";
}

TEST(GltfRig, OneMeshMayBelongToSeveralNodes)
{
    const Rig rig = rig_of_nodes(R"([{"name": "left", "mesh": 0}, {"name": "right", "mesh": 0}])");
    ASSERT_EQ(rig.meshes.size(), 2u);
    EXPECT_NE(rig.meshes[0].node, rig.meshes[1].node);
}

TEST(GltfRig, ExtensionsThatDoNotMoveVerticesAreAllowed)
{
    for (const char* extension : {"KHR_materials_unlit", "KHR_texture_transform", "KHR_mesh_quantization"}) {
        GltfDocument gltf = two_joint_document();
        gltf.json["extensionsRequired"] = {extension};
        const test_support::ScratchFolder folder;
        EXPECT_NO_THROW(read_gltf_rig(folder.file("a.gltf", gltf.text()))) << extension;
    }
}

}  // namespace
