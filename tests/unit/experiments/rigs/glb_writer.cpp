// Reference: the container of glTF 2.0, Sec. 4.4, parsed here, and morph targets, which are differences from the mesh's
// points.
#include "experiments/rigs/glb_writer.hpp"

#include "experiments/rigs/rig_formats.hpp"
#include "experiments/rigs/rigged_body.hpp"
#include "experiments/rigs/tiny_gltf.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/system/files.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <sstream>

namespace {

using GlbWriter = test_support::FolderTest;
using namespace pbs;
using nlohmann::json;

const Triangles one_triangle = (Triangles(1, 3) << 0, 1, 2).finished();
const Positions first_frame = (Positions(3, 3) << 0, 0, 0, 1, 0, 0, 0, 1, 0).finished();

template <typename Number>
Number number_in(const std::string& bytes, std::size_t offset)
{
    Number number{};
    std::memcpy(&number, bytes.data() + offset, sizeof number);
    return number;
}

struct WrittenGlb {
    json document;
    std::string bytes;  // of its buffer

    std::vector<float> floats(int accessor) const
    {
        const json& info = document["accessors"][std::size_t(accessor)];
        const std::size_t offset =
            document["bufferViews"][info["bufferView"].get<std::size_t>()].value("byteOffset", 0);
        std::vector<float> numbers(info["count"].get<std::size_t>() * (info["type"] == "VEC3"   ? 3
                                                                       : info["type"] == "VEC2" ? 2
                                                                                                : 1));
        for (std::size_t n = 0; n < numbers.size(); ++n) numbers[n] = number_in<float>(bytes, offset + 4 * n);
        return numbers;
    }
};

std::string file_of(const std::string& path, const std::vector<double>& times_s, const std::vector<Positions>& frames)
{
    pbs::GlbWriter writer(path, "hero", one_triangle);
    for (std::size_t f = 0; f < frames.size(); ++f) writer.add_frame(times_s[f], frames[f]);
    writer.write();
    return read_text_file(path);
}

WrittenGlb parts_of(const std::string& file)
{
    EXPECT_EQ(file.substr(0, 4), "glTF");
    EXPECT_EQ(number_in<std::uint32_t>(file, 4), 2u);
    EXPECT_EQ(number_in<std::uint32_t>(file, 8), file.size());
    const std::size_t length = number_in<std::uint32_t>(file, 12);
    EXPECT_EQ(length % 4, 0u);
    EXPECT_EQ(file.substr(16, 4), "JSON");
    EXPECT_EQ(file.substr(20 + length + 4, 4), std::string("BIN\0", 4));
    return {json::parse(file.substr(20, length)), file.substr(28 + length)};
}

WrittenGlb written_glb(const std::vector<double>& times_s, const std::vector<Positions>& frames)
{
    const test_support::ScratchFolder folder;
    return parts_of(file_of(folder / "a.glb", times_s, frames));
}

// Two triangles at right angles that share an edge but no points. In the second frame the first one has turned onto its
// back.
const Triangles two_triangles = (Triangles(2, 3) << 0, 1, 2, 3, 4, 5).finished();
const Positions roof = (Positions(6, 3) << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1).finished();

WrittenGlb written_roof(const RigLook& look, const RigMaterials& materials = {})
{
    const test_support::ScratchFolder folder;
    pbs::GlbWriter writer(folder / "a.glb", "roof", two_triangles, look, materials);
    Positions turned = roof;
    turned.row(1) *= -1.0;
    writer.add_frame(0.0, roof);
    writer.add_frame(1.0, turned);
    writer.write();
    return parts_of(read_text_file(folder / "a.glb"));
}

std::vector<float> repeated(const std::vector<std::array<float, 3>>& rows)
{
    std::vector<float> numbers;
    for (const auto& row : rows) numbers.insert(numbers.end(), row.begin(), row.end());
    return numbers;
}

TEST_F(GlbWriter, TheFirstFrameIsTheMeshWithItsBoundingBox)
{
    const WrittenGlb glb = written_glb({0.0}, {first_frame.array() + 0.5});
    const json& primitive = glb.document["meshes"][0]["primitives"][0];
    const json& points = glb.document["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
    EXPECT_EQ(points["min"].get<std::vector<double>>(), (std::vector<double>{0.5, 0.5, 0.5}));
    EXPECT_EQ(points["max"].get<std::vector<double>>(), (std::vector<double>{1.5, 1.5, 0.5}));
    EXPECT_EQ(glb.floats(primitive["attributes"]["POSITION"]),
              (std::vector<float>{.5, .5, .5, 1.5, .5, .5, .5, 1.5, .5}));
    EXPECT_EQ(glb.document["nodes"][0]["name"], "hero");
    EXPECT_FALSE(glb.document.contains("animations")) << "a single frame does not move";
}

TEST_F(GlbWriter, EveryOtherFrameIsAMorphTargetWithWeightOneAtItsTime)
{
    const Positions second = first_frame.array() + 2.0;
    const Positions third = -first_frame;
    const WrittenGlb glb = written_glb({0.0, 0.5, 2.0}, {first_frame, second, third});
    const json& targets = glb.document["meshes"][0]["primitives"][0]["targets"];
    ASSERT_EQ(targets.size(), 2u);
    EXPECT_EQ(glb.floats(targets[0]["POSITION"]), std::vector<float>(9, 2.0F));
    EXPECT_EQ(glb.floats(targets[1]["POSITION"]), (std::vector<float>{0, 0, 0, -2, 0, 0, 0, -2, 0}));
    const json& animation = glb.document["animations"][0];
    EXPECT_EQ(animation["channels"][0]["target"]["path"], "weights");
    EXPECT_EQ(glb.floats(animation["samplers"][0]["input"]), (std::vector<float>{0.0, 0.5, 2.0}));
    EXPECT_EQ(glb.floats(animation["samplers"][0]["output"]), (std::vector<float>{0, 0, 1, 0, 0, 1}));
}

TEST_F(GlbWriter, ItsMeshIsReadAgain)
{
    file_of(folder / "a.glb", {0.0}, {first_frame});
    const Rig rig = read_gltf_rig(folder / "a.glb");
    EXPECT_EQ(rig.meshes.at(0).points, first_frame);
    EXPECT_EQ(rig.meshes.at(0).triangles, one_triangle);
}

// Five bones in a chain, all of which move the last point, so that a second set of weights is needed. The reader knows
// the skin, and the targets are compared as numbers. Tolerance: the file has single precision, and a point of 5 m goes
// through five joints below each other.
TEST_F(GlbWriter, ASkinMovesItsPointsByLinearBlendingAndItsTargetsHaveTheirWeights)
{
    GlbSkin skin;
    std::vector<Eigen::Quaterniond> turns;
    for (int b = 0; b < 5; ++b) {
        skin.skeleton.bones.push_back({"bone " + std::to_string(b), b - 1, {b + 0.5, 0.0, 0.25}, {b + 1.5, 0.0, 0.25}});
        turns.emplace_back(Eigen::AngleAxisd(0.3 + 0.1 * b, Vec3(1, b, 2).normalized()));
    }
    skin.weights.first = {0};
    for (const std::vector<double>& row :
         {std::vector{1.0}, std::vector{0.25, 0.75}, std::vector{0.1, 0.2, 0.3, 0.15, 0.25}}) {
        for (std::size_t b = 0; b < row.size(); ++b) skin.weights.add(static_cast<int>(b), row[b]);
        skin.weights.end_vertex();
    }
    skin.times_s = {0.0, 0.5};
    skin.poses = {Pose(5, Eigen::Isometry3d::Identity()), pose_from_joints(skin.skeleton, turns, {0.1, 0.2, 0.3})};
    skin.target_weights = (Eigen::MatrixXd(2, 2) << 0.0, 0.25, -0.5, 1.0).finished();
    pbs::GlbWriter writer(folder / "a.glb", "hero", one_triangle);
    writer.add_frame(0.0, first_frame);
    for (const double height : {0.5, 2.0}) writer.add_frame(0.0, first_frame.array() + height);
    writer.write(&skin);

    const Rig rig = read_gltf_rig(folder / "a.glb");
    ASSERT_EQ(rig.meshes.size(), 1u);
    for (std::size_t key = 0; key < 2; ++key) {
        Positions expected;
        linear_blend_skinning(first_frame, skin.weights, skin.poses[key], expected);
        const Positions moved =
            skinned_points(rig.meshes[0], node_transforms(rig, &rig.animations.at(0), skin.times_s[key]));
        EXPECT_LT((moved - expected).cwiseAbs().maxCoeff(), 5.0 * 5.0 * 16.0 * 0x1p-24) << key;
    }
    const WrittenGlb glb = parts_of(read_text_file(folder / "a.glb"));
    const json& animation = glb.document["animations"][0];
    EXPECT_EQ(animation["channels"][0]["target"]["path"], "weights");
    EXPECT_EQ(glb.floats(animation["samplers"][0]["output"]), (std::vector<float>{0.0F, 0.25F, -0.5F, 1.0F}));
    const json& targets = glb.document["meshes"][0]["primitives"][0]["targets"];
    EXPECT_EQ(glb.floats(targets[1]["POSITION"]), std::vector<float>(9, 2.0F));
}

TEST_F(GlbWriter, NormalsAreThoseOfTheFrameAndKeepTheArtistsHardEdges)
{
    RigLook look;
    look.put(0, 0, (Eigen::MatrixXf(6, 3) << 0, 0, 1, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 0, 0).finished());
    const WrittenGlb hard = written_roof(look);
    const json& primitive = hard.document["meshes"][0]["primitives"][0];
    EXPECT_EQ(hard.floats(primitive["attributes"]["NORMAL"]),
              repeated({{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}}));
    EXPECT_EQ(hard.floats(primitive["targets"][0]["NORMAL"]),
              repeated({{0, 0, -2}, {0, 0, -2}, {0, 0, -2}, {}, {}, {}}));
    look.numbers.setConstant(0.6F);
    const WrittenGlb smooth = written_roof(look);
    const std::vector<float> normals =
        smooth.floats(smooth.document["meshes"][0]["primitives"][0]["attributes"]["NORMAL"]);
    for (const std::size_t shared : {0, 2, 3, 4}) EXPECT_FLOAT_EQ(normals[3 * shared], std::sqrt(0.5F)) << shared;
    EXPECT_EQ(normals[3], 0.0F) << "not on the edge";
}

TEST_F(GlbWriter, TextureCoordinatesMaterialsAndImagesAreCarried)
{
    RigLook look;
    look.put(0, 3, (Eigen::MatrixXf(6, 2) << 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11).finished());
    look.material = {1, 0};
    const RigMaterials materials{
        R"({"materials": [{"name": "a"}, {"name": "b"}], "images": [{"mimeType": "image/png"}]})", {"\x89PNG5"}};
    const WrittenGlb glb = written_roof(look, materials);
    const json& primitives = glb.document["meshes"][0]["primitives"];
    ASSERT_EQ(primitives.size(), 2u);
    EXPECT_EQ(primitives[0]["material"], 0);
    EXPECT_EQ(primitives[1]["material"], 1);
    EXPECT_EQ(number_in<std::uint32_t>(glb.bytes, 0), 3u)
        << "the second triangle comes first, for it has the first material";
    EXPECT_EQ(primitives[0]["attributes"], primitives[1]["attributes"]);
    EXPECT_FALSE(primitives[0]["attributes"].contains("NORMAL"));
    EXPECT_EQ(glb.floats(primitives[0]["attributes"]["TEXCOORD_0"]),
              (std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
    const json& view = glb.document["bufferViews"][glb.document["images"][0]["bufferView"].get<std::size_t>()];
    EXPECT_EQ(glb.bytes.substr(view["byteOffset"], view["byteLength"]), "\x89PNG5");
    EXPECT_EQ(glb.floats(primitives[0]["attributes"]["POSITION"])[3], 1.0F)
        << "what follows the image begins at a multiple of four";
    EXPECT_EQ(glb.bytes.size(), glb.document["buffers"][0]["byteLength"]);
}

// Reference: tinygltf's own writer, which holds the whole buffer in memory, of the model that tinygltf reads.
TEST_F(GlbWriter, ItsBytesAreThoseOfTinygltf)
{
    for (const std::size_t count : {1, 2, 5}) {
        const test_support::ScratchFolder folder;
        std::vector<double> times_s;
        std::vector<Positions> frames;
        for (std::size_t f = 0; f < count; ++f) {
            times_s.push_back(0.1 * double(f));
            frames.push_back(first_frame.array() * std::cos(double(f)) + double(f) / 3.0);
        }
        const std::string file = file_of(folder / "a.glb", times_s, frames);
        tinygltf::Model model;
        std::string error, warning;
        ASSERT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, folder / "a.glb")) << error;
        EXPECT_EQ(warning, "");
        std::ostringstream again;
        ASSERT_TRUE(tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, again, false, true));
        EXPECT_EQ(file, again.str()) << count << " frames";
    }
}

TEST_F(GlbWriter, WritesTheFramesSoFarAndLeavesNoOtherFile)
{
    {
        pbs::GlbWriter writer(folder / "a.glb", "hero", one_triangle);
        writer.add_frame(0.0, first_frame);
        writer.write();
        const std::string one = read_text_file(folder / "a.glb");
        EXPECT_EQ(one, file_of(folder / "b.glb", {0.0}, {first_frame}));
        writer.add_frame(0.5, first_frame.array() + 1.0);
        writer.write();
        EXPECT_EQ(read_text_file(folder / "a.glb"),
                  file_of(folder / "b.glb", {0.0, 0.5}, {first_frame, first_frame.array() + 1.0}));
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), std::filesystem::directory_iterator()),
              2);
}

TEST_F(GlbWriter, ItsSizeIsKnownAfterTheFirstFrame)
{
    for (const std::size_t count : {1, 2, 40}) {
        pbs::GlbWriter writer(folder / "a.glb", "hero", one_triangle);
        writer.add_frame(0.0, first_frame);
        const double expected = writer.bytes(static_cast<int>(count));
        for (std::size_t f = 1; f < count; ++f) writer.add_frame(static_cast<double>(f), first_frame);
        writer.write();
        EXPECT_EQ(expected + (count == 1 ? -4.0 : 0.0), parts_of(read_text_file(folder / "a.glb")).bytes.size())
            << "a file of one frame has no animation";
    }
}

TEST_F(GlbWriter, AFolderThatDoesNotExistIsRefusedByName)
{
    expect_input_error([] { pbs::GlbWriter("/no/such/folder/a.glb", "hero", one_triangle); }, "/no/such/folder/a.glb",
                       "");
}

}  // namespace
