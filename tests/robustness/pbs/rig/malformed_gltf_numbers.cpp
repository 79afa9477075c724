// Reference: the contract of InputError. Buffers, accessors and animations of glTF that reach beyond what they refer to are refused.
#include "pbs/rig/gltf_rig.hpp"

#include "tests/support/gltf_document.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace {

using nlohmann::json;
using test_support::GltfDocument;
using test_support::two_joint_document;

void expect_gltf_refused(const std::function<void(GltfDocument&)>& damage, const std::string& begins, const std::string& holds)
{
    GltfDocument gltf = two_joint_document();
    damage(gltf);
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("a.gltf", gltf.text());
    expect_input_error([&] { pbs::read_gltf_rig(path); }, path + ": " + begins, holds);
}

const std::string of_points = "meshes/0/primitives/0/attributes/POSITION";
const std::string beyond = "its elements reach beyond the bytes of their buffer";

TEST(MalformedAccessors, ThatReachBeyondTheirViewAreRefused)
{
    expect_gltf_refused([](auto& gltf) { gltf.json["accessors"][0]["count"] = 5; }, of_points + " = 5: ", beyond);
    expect_gltf_refused([](auto& gltf) { gltf.json["accessors"][0]["byteOffset"] = 4; }, of_points + " = 4: ", beyond);
    expect_gltf_refused([](auto& gltf) { gltf.json["bufferViews"][0]["byteStride"] = 16; }, of_points + " = 4: ", beyond);
    expect_gltf_refused([](auto& gltf) { gltf.json["bufferViews"][0]["byteStride"] = 8; }, of_points + " = 4: ", beyond);
    expect_gltf_refused([](auto& gltf) { gltf.json["accessors"][0]["count"] = 4'000'000'000; },
                        of_points + " = 4000000000: ", "at most 100,000,000");
}

TEST(MalformedAccessors, ViewsThatReachBeyondTheirBufferAreRefused)
{
    for (const auto& [member, value] : {std::pair("byteOffset", 1'000'000), std::pair("byteLength", 1'000'000)})
        expect_gltf_refused([&, name = member, number = value](auto& gltf) { gltf.json["bufferViews"][0][name] = number; },
                            of_points + " = 4: ", beyond);
}

TEST(MalformedAccessors, ViewsAndBuffersThatDoNotExistAreRefused)
{
    expect_gltf_refused([](auto& gltf) { gltf.json["accessors"][0]["bufferView"] = 70; },
                        of_points + " = 70: ", "a buffer view of the file");
    expect_gltf_refused([](auto& gltf) { gltf.json["bufferViews"][0]["buffer"] = 1; }, of_points + " = 1: ", "a buffer of the file");
}

TEST(MalformedAccessors, AnUnknownComponentTypeIsRefused)
{
    expect_gltf_refused([](auto& gltf) { gltf.json["accessors"][0]["componentType"] = 5124; }, "", "");
}

TEST(MalformedAccessors, SparseIndicesOutOfRangeAreRefused)
{
    const auto sparse = [](GltfDocument& gltf, std::uint8_t index, int count) {
        const int indices = gltf.put_bytes<std::uint8_t>({index}), values = gltf.put_bytes<float>({1, 2, 3});
        gltf.json["accessors"][0]["sparse"] = {
            {"count", count}, {"indices", {{"bufferView", indices}, {"componentType", 5121}}}, {"values", {{"bufferView", values}}}};
    };
    expect_gltf_refused([&](auto& gltf) { sparse(gltf, 4, 1); }, of_points + " = 4", "an index of the accessor's elements");
    expect_gltf_refused([&](auto& gltf) { sparse(gltf, 0, 2); }, of_points + " = 2: ", beyond);
    expect_gltf_refused([&](auto& gltf) { sparse(gltf, 0, -1); }, of_points + " = -1: ", "0 or more");
}

TEST(MalformedBuffers, ThatAreShorterThanTheyStateOrMissingAreRefused)
{
    const test_support::ScratchFolder folder;
    GltfDocument gltf = two_joint_document();
    json document = json::parse(gltf.text());
    document["buffers"][0]["byteLength"] = gltf.bytes.size() + 1;
    const std::string shorter = folder.file("shorter.gltf", document.dump());
    expect_input_error([&] { pbs::read_gltf_rig(shorter); }, shorter + ": no glTF that tinygltf can read: ", "");
    document["buffers"][0] = {{"byteLength", gltf.bytes.size()}, {"uri", "none.bin"}};
    const std::string missing = folder.file("missing.gltf", document.dump());
    expect_input_error([&] { pbs::read_gltf_rig(missing); }, missing + ": no glTF that tinygltf can read: ", "none.bin");
}

TEST(MalformedBuffers, OutsideTheFoldersOfTheFileAreNotRead)
{
    const test_support::ScratchFolder folder;
    std::filesystem::create_directory(folder.path() / "own");
    GltfDocument gltf = two_joint_document();
    folder.file("away.bin", gltf.bytes);
    folder.file("own/beside.bin", gltf.bytes);
    json document = json::parse(gltf.text());
    document["buffers"][0]["uri"] = "beside.bin";
    EXPECT_EQ(pbs::read_gltf_rig(folder.file("own/a.gltf", document.dump())).meshes.size(), 1u);
    document["buffers"][0]["uri"] = "../away.bin";
    const std::string path = folder.file("own/b.gltf", document.dump());
    expect_input_error([&] { pbs::read_gltf_rig(path); }, path + ": ", "away.bin");
}

TEST(MalformedAnimations, AreRefusedByFieldAndRule)
{
    const std::string field = "animations/0/";
    const auto sampler = [](GltfDocument& gltf) -> json& { return gltf.json["animations"][0]["samplers"][0]; };
    const auto channel = [](GltfDocument& gltf) -> json& { return gltf.json["animations"][0]["channels"][0]; };
    expect_gltf_refused([&](auto& gltf) { channel(gltf)["target"]["node"] = 3; },
                        field + "channels/0/target/node = 3: ", "node of the file");
    expect_gltf_refused([&](auto& gltf) { channel(gltf)["sampler"] = 1; }, field + "channels/0/sampler = 1: ", "sampler of the animation");
    expect_gltf_refused([&](auto& gltf) { channel(gltf)["target"]["path"] = "colour"; },
                        field + "channels/0/target/path = colour: ", "expected translation, rotation, scale or weights");
    expect_gltf_refused([&](auto& gltf) { sampler(gltf)["interpolation"] = "BEZIER"; },
                        field + "samplers/0/interpolation = BEZIER: ", "expected LINEAR, STEP or CUBICSPLINE");
    expect_gltf_refused([&](auto& gltf) { sampler(gltf)["interpolation"] = "CUBICSPLINE"; },
                        field + "samplers/0/output = 2: ", "expected 6 for 2 keys");
    expect_gltf_refused([&](auto& gltf) { sampler(gltf)["output"] = 0; }, field + "samplers/0/output = 0: ", "4 numbers per element");
    expect_gltf_refused(
        [&](auto& gltf) {
            sampler(gltf)["input"] = gltf.template put<float>("SCALAR", {1, 0});
        },
        field + "samplers/0/input: ", "times that do not go back");
    expect_gltf_refused(
        [&](auto& gltf) {
            sampler(gltf)["input"] = gltf.template put<float>("SCALAR", {0, std::numeric_limits<float>::quiet_NaN()});
        },
        field + "samplers/0/input = 7: ", "expected finite numbers");
    expect_gltf_refused([](auto& gltf) { gltf.json["accessors"][5]["count"] = gltf.json["accessors"][6]["count"] = 0; },
                        field + "samplers/0/input: ", "at least one key");
}

}  // namespace
