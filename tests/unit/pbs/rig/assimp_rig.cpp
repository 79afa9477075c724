// Reference: an arm of two joints whose skinned points are computed by hand, as COLLADA and as FBX. assimp computes in single precision: at
// most 64 roundings of numbers of at most 8 of the files' units.

#include "pbs/rig/rig_formats.hpp"
#include "pbs/rig/rigged_body.hpp"
#include "tests/support/arm_in_formats.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/weight_sums.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>
#include <minizip/zip.h>
#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace {

using namespace pbs;

const double assimp_rounding_m = test_support::rounding_error_in<float>(64, 0.08);

int node_named(const Rig& rig, const std::string& name)
{
    for (std::size_t n = 0; n < rig.nodes.size(); ++n)
        if (rig.nodes[n].name == name) return static_cast<int>(n);
    return -1;
}

Rig rig_in(const std::string& name, const std::string& text)
{
    const test_support::ScratchFolder folder;
    return read_assimp_rig(folder.file(name, text));
}

// Points of the skin [m] by their places in the bind pose, since readers may change their order.
void expect_arm(const Rig& rig, double time_s, const Positions& expected_cm)
{
    ASSERT_EQ(rig.meshes.size(), 1u);
    ASSERT_EQ(rig.meshes[0].points.rows(), 4);
    const Positions bound = rig.unit_m * skinned_points(rig.meshes[0], node_transforms(rig, nullptr, 0.0));
    const RigAnimation* animation = find_animation(rig, "");
    ASSERT_TRUE(animation);
    const Positions posed = rig.unit_m * skinned_points(rig.meshes[0], node_transforms(rig, animation, time_s));
    const Positions places_cm = (Positions(4, 3) << 1, 0, 0, 1, 2, 0, 1, 4, 0, 2, 2, 0).finished();
    for (Eigen::Index p = 0; p < 4; ++p) {
        Eigen::Index found = 0;
        const double distance = (bound.rowwise() - 0.01 * places_cm.row(p)).rowwise().norm().minCoeff(&found);
        EXPECT_LE(distance, assimp_rounding_m) << "at rest, point " << p;
        EXPECT_LE((posed.row(found) - 0.01 * expected_cm.row(p)).norm(), assimp_rounding_m) << "at " << time_s << " s, point " << p;
    }
}

void expect_bent_arm(const Rig& rig)
{
    const double s = std::sqrt(0.5);
    Positions eighth(4, 3), quarter(4, 3);  // of a turn about the elbow at (1, 2, 0)
    eighth << 1, 0, 0, 1, 2, 0, 1 - 2 * s, 2 + 2 * s, 0, 0.25 * 2 + 0.75 * (1 + s), 0.25 * 2 + 0.75 * (2 + s), 0;
    quarter << 1, 0, 0, 1, 2, 0, -1, 2, 0, 0.25 * 2 + 0.75 * 1, 0.25 * 2 + 0.75 * 3, 0;
    expect_arm(rig, 0.5, eighth);
    expect_arm(rig, 1.0, quarter);
    EXPECT_EQ(rig.nodes[std::size_t(node_named(rig, "elbow"))].parent, node_named(rig, "root"));
    EXPECT_EQ(rig.meshes[0].joints.size(), 2u);
    EXPECT_EQ(rig.animations[0].start_s, 0.0);
    EXPECT_NEAR(rig.animations[0].end_s, 1.0, 1e-6);
    for (std::size_t n = 0; n < rig.nodes.size(); ++n) EXPECT_LT(rig.nodes[n].parent, int(n));
}

TEST(AssimpRig, AnArmAsColladaAndFbx)
{
    const Rig collada = rig_in("arm.dae", test_support::collada_arm());
    expect_bent_arm(collada);
    EXPECT_FALSE(collada.nodes[std::size_t(node_named(collada, "elbow"))].rest.matrix) << "an animation replaces the matrix of its node";
    EXPECT_TRUE(collada.nodes[std::size_t(node_named(collada, "root"))].rest.matrix);
    expect_bent_arm(rig_in("arm.dae", test_support::collada_arm(2)));  // the bind shape matrix moves the points first
    const Rig rig = rig_in("arm.fbx", test_support::fbx_arm());
    EXPECT_EQ(rig.unit_m, 0.01);
    expect_bent_arm(rig);
    std::string text = test_support::fbx_arm();
    const std::string stated = "\"Number\", \"\",1\n}";
    text.replace(text.find(stated), stated.size(), "\"Number\", \"\",2.54\n}");
    EXPECT_NEAR(rig_in("arm.fbx", text).unit_m, 0.0254, 1e-9);
}

TEST(AssimpRig, CurvesOfFbxThatAreNotLinearAreARemark)
{
    const auto remarks_with = [](const std::string& flags) {
        std::string text = test_support::fbx_arm();
        text.insert(text.find("KeyTime:"), "KeyAttrFlags: *1 {\na: " + flags + "\n}\n");
        return rig_in("arm.fbx", text).remarks;
    };
    EXPECT_TRUE(remarks_with("24836").empty());
    for (const char* flags : {"2", "264"})
        EXPECT_EQ(remarks_with(flags), std::vector<std::string>{"1 of the 1 curves of animations are constant or cubic between their keys; "
                                                                "they are read as linear there"});
}

TEST(AssimpRig, OfABinaryFbxHasBonesWithWeights)
{
    const std::string path = "/usr/share/assimp/models/FBX/animation_with_skeleton.fbx";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "assimp-testmodels is not installed";
    const Rig rig = read_assimp_rig(path);
    ASSERT_FALSE(rig.meshes.empty());
    for (const RigMesh& mesh : rig.meshes)
        for (int p = 0; p < mesh.skin.vertices(); ++p)
            EXPECT_NEAR(test_support::sum_of_weights(mesh.skin, p), 1.0, 1e-12) << "point " << p << " of " << mesh.name;
    EXPECT_TRUE(std::any_of(rig.meshes.begin(), rig.meshes.end(), [](const RigMesh& mesh) { return mesh.joints.size() > 1; }));
}

// Reference: the rule for the weights of glTF files (finite, 0 or more), on the four weights of an arm, each of which a point uses.

using test_support::ScratchFolder;

std::string arm_with(const std::string& part, const std::string& other)
{
    std::string text = test_support::collada_arm();
    EXPECT_NE(text.find(part), std::string::npos) << part;
    return text.replace(text.find(part), part.size(), other);
}

std::string arm_with_weights(const std::string& weights)
{
    return arm_with("1 0.5 0.25 0.75", weights);
}

// The message without the path.
void expect_refused(const std::string& text, const std::string& field_and_value)
{
    const ScratchFolder folder;
    const std::string path = folder.file("arm.dae", text);
    expect_input_error([&] { pbs::check_collada_weights(path); },
                       path + ": controller skin, weight of point " + field_and_value + ": expected a finite number of 0 or more", "");
}

void expect_accepted(const std::string& text)
{
    const ScratchFolder folder;
    EXPECT_NO_THROW(pbs::check_collada_weights(folder.file("arm.dae", text)));
}

TEST(ColladaWeights, ThatAreNegativeOrNotFiniteAreRefusedWithTheirPoint)
{
    expect_refused(arm_with_weights("1 -0.5 0.25 0.75"), "1 = -0.5");
    for (const std::string weight : {"-0.75", "-1e-400", "nan", "inf", "-inf", "1e400", "half"})
        expect_refused(arm_with_weights("1 0.5 0.25 " + weight), "3 = " + weight);
}

TEST(ColladaWeights, OfZeroOrMoreAndThoseThatNoPointUsesAreAccepted)
{
    for (const char* weight : {"0.75", "+0.75", "0", "-0", "7.5E-1", "1e-400", "3", "0.75 -1"})
        expect_accepted(arm_with_weights("1 0.5 0.25 " + std::string(weight)));
    std::string text = arm_with_weights("1 0.5 0.25 -0.75");
    expect_accepted(text.replace(text.find("url=\"#skin\""), 11, "url=\"#none\""));  // the controller is not part of the scene
    // What is no XML or no archive is left to the reader.
    for (const std::string& other : {std::string("<COLLADA><library_controllers>"), arm_with("1 2 1 2</vcount>", "1 2 99 2</vcount>"),
                                     std::string("PK\x03\x04 nothing")})
        expect_accepted(other);
}

TEST(ColladaWeights, TheirPlaceFollowsTheAccessor)
{
    const std::string accessor = "<accessor source='#weights-array' count='4' stride='1'>";
    const std::string pairs = "<accessor source='#weights-array' count='4' stride='2'>";
    std::string text = arm_with(accessor, pairs);
    const std::string weights = "1 0.5 0.25 0.75";
    text.replace(text.find(weights), weights.size(), "1 -9 0.5 -9 0.25 -9 0.75 -9");
    expect_accepted(text);
    text.replace(text.find("0.25 -9"), 7, "-0.2 -9");
    expect_refused(text, "3 = -0.2");
}

TEST(ColladaWeights, OfAnArchiveAreChecked)
{
    const ScratchFolder folder;
    const std::string path = folder / "arm.zae", text = arm_with_weights("1 0.5 0.25 -0.75");
    zipFile archive = zipOpen(path.c_str(), APPEND_STATUS_CREATE);
    ASSERT_TRUE(archive);
    zipOpenNewFileInZip(archive, "arm.dae", nullptr, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, Z_DEFAULT_COMPRESSION);
    zipWriteInFileInZip(archive, text.data(), static_cast<unsigned>(text.size()));
    zipCloseFileInZip(archive);
    zipClose(archive, nullptr);
    expect_input_error([&] { pbs::check_collada_weights(path); }, path + ": controller skin, weight of point 3 = -0.75: ", "");
}

// Reference: the flags of keys as the format stores them: 2 constant, 4 linear, 8 cubic; Blender's linear keys have the flags 24836.

std::string text_of(const std::string& flags)
{
    return "AnimationCurve: 11 {\nKeyAttrFlags: *1 {\n\ta: " + flags + "\n}\nKeyAttrDataFloat: *4 {\na: 0,0,8,0\n}\n}\n";
}

std::string word(std::uint32_t number)
{
    return std::string(reinterpret_cast<const char*>(&number), sizeof number);
}

std::string binary_of(const std::vector<std::int32_t>& flags, bool is_packed)
{
    std::string data(reinterpret_cast<const char*>(flags.data()), sizeof(std::int32_t) * flags.size());
    if (is_packed) {
        std::string packed(compressBound(data.size()), '\0');
        uLongf size = packed.size();
        compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(data.data()), data.size());
        data = packed.substr(0, size);
    }
    return "\x0cKeyAttrFlagsi" + word(std::uint32_t(flags.size())) + word(is_packed) + word(std::uint32_t(data.size())) + data;
}

void expect_count(const std::string& bytes, int curves, int not_linear)
{
    const pbs::FbxCurves count = pbs::count_fbx_curves(bytes);
    EXPECT_EQ(count.curves, curves);
    EXPECT_EQ(count.not_linear, not_linear);
}

TEST(FbxCurves, OfATextOrBinaryFileAreCounted)
{
    expect_count(text_of("24836") + text_of("4") + text_of("2") + text_of("4,264,4"), 4, 2);
    for (const bool is_packed : {false, true})
        expect_count("Kaydara FBX Binary" + binary_of({24836}, is_packed) + binary_of({4, 8}, is_packed) + binary_of({2}, is_packed), 3, 2);
}

TEST(FbxCurves, ThatAreDamagedAreNotCounted)
{
    for (const char* bytes : {"", "KeyAttrFlags", "KeyAttrFlags: *1 { a: 4"}) expect_count(bytes, 0, 0);
    const std::string whole = binary_of({4, 8}, true);
    for (std::size_t length = 0; length < whole.size(); ++length) expect_count(whole.substr(0, length), 0, 0);
    expect_count("KeyAttrFlagsi" + word(0xffffffffu) + word(0) + word(4) + word(4), 0, 0);
    expect_count("KeyAttrFlagsi" + word(2) + word(0) + word(4) + word(4), 0, 0);
}

}  // namespace
