// Reference: the interface. The content of a file determines its reader, whatever its name.

#include "experiments/rigs/rig_reader.hpp"
#include "tests/support/arm_in_formats.hpp"
#include "tests/support/gltf_document.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/two_joint_rig.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace {

using RigReader = test_support::FolderTest;
using namespace pbs;
using test_support::GltfDocument;
using test_support::ScratchFolder;
using test_support::two_joint_document;
TEST_F(RigReader, ReadsEachFormatByItsContent)
{
    for (const auto& [extension, text] :
         {std::pair(".gltf", two_joint_document().text()), std::pair(".dae", test_support::collada_arm()),
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

using Damages = std::vector<std::function<void(Rig&)>>;

void expect_each_refused(const Damages& damages)
{
    for (std::size_t number = 0; number < damages.size(); ++number) {
        SCOPED_TRACE(number);
        Rig rig = test_support::two_joint_rig();
        rig.file = "b.glb";
        damages[number](rig);
        expect_input_error([&] { checked(rig); }, "b.glb: ", "");
    }
}

TEST(CheckedRig, IsTheRigWithRotationsOfUnitLength)
{
    Rig rig = test_support::two_joint_rig();
    rig.nodes[0].rest.rotation.coeffs() *= 2.0;
    const Rig same = checked(rig);
    EXPECT_EQ(same.nodes[0].rest.rotation.coeffs(), rig.nodes[0].rest.rotation.normalized().coeffs());
    EXPECT_EQ(same.meshes[0].points, rig.meshes[0].points);
}

TEST(CheckedRig, TellsAnimationsWithOneNameApartAndKeepsNamesThatAreUnique)
{
    Rig rig = test_support::two_joint_rig();
    const RigAnimation bend = rig.animations[0];
    rig.animations.clear();
    for (const char* name : {"Take 001", "Walk", "Take 001", "Take 001 (2)", "Take 001", "Walk"}) {
        rig.animations.push_back(bend);
        rig.animations.back().name = name;
    }
    std::vector<std::string> names;
    for (const RigAnimation& animation : checked(rig).animations) names.push_back(animation.name);
    EXPECT_EQ(names, (std::vector<std::string>{"Take 001", "Walk", "Take 001 (3)", "Take 001 (2)", "Take 001 (4)",
                                               "Walk (2)"}));
}

TEST(CheckedRig, HasNoIndexOutOfRange)
{
    const Damages damages = {
        [](Rig& rig) { rig.nodes[0].parent = 1; },
        [](Rig& rig) { rig.nodes[1].parent = 1; },
        [](Rig& rig) { rig.meshes[0].node = 3; },
        [](Rig& rig) { rig.meshes[0].triangles(0, 0) = 4; },
        [](Rig& rig) { rig.meshes[0].triangles(0, 0) = -1; },
        [](Rig& rig) { rig.meshes[0].joints[0].node = -1; },
        [](Rig& rig) { rig.meshes[0].skin.bone[0] = 2; },
        [](Rig& rig) { rig.meshes[0].skin.first[1] = 5; },
        [](Rig& rig) { rig.meshes[0].skin.first.pop_back(); },
        [](Rig& rig) { rig.animations[0].nodes[0].node = 3; },
        [](Rig& rig) {
            rig.animations[0].nodes[0].rotation->times_s = {1.0, 0.0};
        },
        [](Rig& rig) { rig.animations[0].nodes[0].rotation->times_s.clear(); },
        [](Rig& rig) { rig.animations[0].nodes[0].rotation->values.pop_back(); },
        [](Rig& rig) { rig.animations[0].end_s = -1.0; },
        [](Rig& rig) { rig.unit_m = 0.0; },
    };
    expect_each_refused(damages);
}

TEST(CheckedRig, HasNoNumberThatIsNotFiniteOrHuge)
{
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {nan, std::numeric_limits<double>::infinity(), 2e9}) {
        const Damages damages = {
            [&](Rig& rig) { rig.meshes[0].points(2, 1) = bad; },
            [&](Rig& rig) { rig.nodes[0].rest.translation.y() = bad; },
            [&](Rig& rig) { rig.meshes[0].joints[1].inverse_bind.translation().x() = bad; },
            [&](Rig& rig) { rig.meshes[0].skin.weight[0] = bad; },
            [&](Rig& rig) { rig.animations[0].nodes[0].rotation->values[0].x() = bad; },
            [&](Rig& rig) { rig.nodes[0].fbx = FbxTransform{.rotation_pivot = Vec3(0, bad, 0)}; },
            [&](Rig& rig) { rig.animations[0].nodes[0].fbx[1][2] = FbxCurve{{.value = bad}}; },
        };
        expect_each_refused(damages);
    }
}

TEST_F(RigReader, AFileWithoutASkinIsRecognised)
{
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

TEST_F(RigReader, WhatIsNoRigIsRefusedByName)
{
    for (const char* text : {"v 0 0 0\n", "HIERARCHY\n", "[1, 2]"}) {
        const std::string path = folder.file("a.glb", text);
        EXPECT_FALSE(is_rig_file(path)) << text;
        expect_input_error([&] { read_rig(path); },
                           path + ": no rig: ", "expected glTF 2.0 (.glb, .gltf), FBX (.fbx) or COLLADA");
    }
    for (const std::string& path : {folder / "none.glb", folder.file("empty.glb", ""), folder.path().string()})
        EXPECT_FALSE(is_rig_file(path)) << path;
}

TEST_F(RigReader, TheNameOfAGltfDoesNotMatterAndRemarksReachTheCaller)
{
    for (const char* name : {"arm.glb", "arm.fbx", "arm"})
        EXPECT_EQ(read_rig(folder.file(name, "\n " + two_joint_document().text())).meshes.at(0).joints.size(), 2u)
            << name;
    GltfDocument gltf = two_joint_document();
    auto& primitives = gltf.json["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    primitives[1]["mode"] = 1;  // lines
    EXPECT_EQ(read_rig(folder.file("a.gltf", gltf.text())).remarks.size(), 1u);
}

// Reference: the definition. The weights of a point are those of its joints divided by their sum.

Weights weights_of_one_point(const std::vector<JointShare>& shares, std::vector<std::string>& notes)
{
    std::vector<std::string> remarks;
    return normalised_skin({shares}, "a.glb", "arm", remarks, notes);
}

TEST(SkinWeights, SumToOneAfterThoseOfAJointWereAddedAndZerosLeftOut)
{
    for (const auto& [shares, bones, weights, is_sum] :
         {std::tuple(std::vector<JointShare>{{2, 0.25}, {0, 0.75}}, std::vector<int>{2, 0},
                     std::vector<double>{0.25, 0.75}, true),
          {{{0, 1.0}, {1, 3.0}}, {0, 1}, {0.25, 0.75}, false},
          {{{0, 0.5}, {1, 0.5009}}, {0, 1}, {0.5 / 1.0009, 0.5009 / 1.0009}, true},  // within a thousandth of one
          {{{3, 0.25}, {1, 0.5}, {3, 0.25}}, {3, 1}, {0.5, 0.5}, true},
          {{{0, 0.0}, {1, 1.0}}, {1}, {1.0}, true}}) {
        std::vector<std::string> notes;
        const Weights made = weights_of_one_point(shares, notes);
        EXPECT_EQ(made.bone, bones);
        for (std::size_t w = 0; w < weights.size(); ++w) EXPECT_DOUBLE_EQ(made.weight.at(w), weights[w]);
        ASSERT_EQ(notes.size(), is_sum ? 0u : 1u);
        if (!is_sum) {
            EXPECT_NE(notes[0].find("1 of the 1 points of mesh arm do not sum to one"), std::string::npos) << notes[0];
        }
    }
}

TEST(SkinWeights, APointWithoutAnyFollowsTheFirstJointWithARemark)
{
    for (const std::vector<JointShare>& shares : {std::vector<JointShare>{}, {{1, 0.0}, {2, 0.0}}}) {
        std::vector<std::string> remarks, notes;
        const Weights weights = normalised_skin({{{2, 1.0}}, shares}, "a.glb", "arm", remarks, notes);
        EXPECT_EQ(weights.bone, (std::vector<int>{2, 0}));
        EXPECT_EQ(weights.weight, (std::vector<double>{1.0, 1.0}));
        ASSERT_EQ(remarks.size(), 1u);
        EXPECT_NE(remarks[0].find("1 of the 2 points of mesh arm have no weight"), std::string::npos) << remarks[0];
    }
}

TEST(SkinWeights, ARoundingBelowZeroIsZeroAndNamed)
{
    std::vector<std::string> remarks, notes;
    const std::vector<std::vector<JointShare>> points = {{{0, 1.0}, {1, -5.6e-5}}};
    EXPECT_EQ(normalised_skin(points, "a.fbx", "arm", remarks, notes).weight, std::vector<double>{1.0});
    EXPECT_TRUE(remarks.empty());
    EXPECT_EQ(notes, std::vector<std::string>{
                         "negative weights of mesh arm, down to -5.6e-05, are taken as 0, as a rounding"});
}

TEST(SkinWeights, ThatAreNegativeNotFiniteOrNoneAreRefused)
{
    std::vector<std::string> none;
    const std::vector<JointShare> zero = {{1, 0.0}};
    expect_input_error([&] { weights_of_one_point(zero, none); },
                       "a.glb: mesh arm, weights = 0: ", "expected a point with a weight");
    constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [weight, text] :
         {std::pair(-0.5, "-0.5"), std::pair(-1e-3, "-0.001"), std::pair(nan, "nan"), std::pair(infinity, "inf")}) {
        const std::vector<std::vector<JointShare>> points = {{{0, 1.0}}, {{0, 1.0}, {1, weight}}};
        expect_input_error([&] { normalised_skin(points, "a.glb", "arm", none, none); },
                           std::string("a.glb: mesh arm, weight of point 1 = ") + text + ": ",
                           "expected a finite number of 0 or more");
    }
}

}  // namespace
