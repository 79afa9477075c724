// Reference: the interface. The content of a file determines its reader, whatever its name.
#include "pbs/rig/rig_reader.hpp"

#include "tests/support/arm_in_formats.hpp"
#include "tests/support/gltf_document.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;
using test_support::GltfDocument;
using test_support::ScratchFolder;
using test_support::two_joint_document;

TEST(RigReader, ReadsEachFormatByItsContent)
{
    const ScratchFolder folder;
    for (const auto& [extension, text] : {std::pair(".gltf", two_joint_document().text()), std::pair(".dae", test_support::collada_arm()),
                                          std::pair(".fbx", test_support::fbx_arm())}) {
        const std::string path = folder.file("arm" + std::string(extension), text);
        EXPECT_TRUE(is_rig_file(path)) << path;
        EXPECT_TRUE(rig_has_skin(path)) << path;
        const Rig rig = read_rig(path);
        EXPECT_EQ(rig.file, path);
        EXPECT_EQ(rig.meshes.at(0).points.rows(), 4) << path;
        EXPECT_EQ(rig.animations.size(), 1u) << path;
    }
}

TEST(RigReader, TheNameOfAGltfDoesNotMatter)
{
    const ScratchFolder folder;
    for (const char* name : {"arm.glb", "arm.fbx", "arm"})
        EXPECT_EQ(read_rig(folder.file(name, "\n " + two_joint_document().text())).meshes.at(0).joints.size(), 2u) << name;
}

TEST(RigReader, AFileWithoutASkinIsRecognised)
{
    const ScratchFolder folder;
    GltfDocument gltf = two_joint_document();
    gltf.json["nodes"][2].erase("skin");
    const std::string path = folder.file("statue.gltf", gltf.text());
    EXPECT_TRUE(is_rig_file(path));
    EXPECT_FALSE(rig_has_skin(path));
    gltf.json["nodes"][2].erase("mesh");
    const std::string clip = folder.file("clip.gltf", gltf.text());
    EXPECT_FALSE(rig_has_skin(clip)) << "and may have no mesh at all";
    expect_input_error([&] { read_rig(clip); }, clip + ": meshes = 0: ", "expected a mesh with triangles");
}

TEST(RigReader, WhatIsNoRigIsRefusedByName)
{
    const ScratchFolder folder;
    for (const char* text : {"v 0 0 0\n", "HIERARCHY\n", "[1, 2]"}) {
        const std::string path = folder.file("a.glb", text);
        EXPECT_FALSE(is_rig_file(path)) << text;
        expect_input_error([&] { read_rig(path); }, path + ": no rig: ", "expected glTF 2.0 (.glb, .gltf), FBX (.fbx) or COLLADA");
    }
}

TEST(RigReader, WhatCannotBeReadIsRefusedByName)
{
    const ScratchFolder folder;
    const std::string none = folder / "none.glb", empty = folder.file("empty.glb", "");
    EXPECT_FALSE(is_rig_file(none));
    EXPECT_FALSE(is_rig_file(empty));
    EXPECT_FALSE(is_rig_file(folder.path().string()));
    expect_input_error([&] { read_rig(none); }, none + ": ", "no such file");
    expect_input_error([&] { read_rig(empty); }, empty + ": ", "the file is empty");
    expect_input_error([&] { read_rig(folder.path().string()); }, folder.path().string() + ": ", "expected a file");
}

TEST(RigReader, RemarksReachTheCaller)
{
    const ScratchFolder folder;
    GltfDocument gltf = two_joint_document();
    gltf.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}};
    EXPECT_EQ(read_rig(folder.file("a.gltf", gltf.text())).remarks.size(), 1u);
}

}  // namespace
