// Reference: glTF 2.0, Sec. 3.6.2 (accessors, sparse accessors) and the conversion of normalised integers in Sec. 3.6.2.2, by hand.
#include "pbs/rig/gltf_rig.hpp"

#include "tests/support/gltf_document.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;
using test_support::GltfDocument;
using test_support::two_joint_document;

Rig read_document(const GltfDocument& gltf)
{
    const test_support::ScratchFolder folder;
    return read_gltf_rig(folder.file("a.gltf", gltf.text()));
}

Positions points_in(const GltfDocument& gltf)
{
    return read_document(gltf).meshes.at(0).points;
}

// The last key's rotation where the document's rotations are these.
template <typename Number>
Eigen::Vector4d last_rotation(const std::vector<Number>& numbers)
{
    GltfDocument gltf = two_joint_document();
    gltf.json["animations"][0]["samplers"][0]["output"] = gltf.put("VEC4", numbers, true);
    return read_document(gltf).animations.at(0).nodes.at(0).rotation->values.back();
}

TEST(GltfNumbers, NormalisedBytesAndShorts)
{
    EXPECT_EQ(last_rotation<std::uint8_t>({0, 0, 0, 255, 0, 51, 102, 255}), Eigen::Vector4d(0.0, 0.2, 0.4, 1.0));
    EXPECT_EQ(last_rotation<std::uint16_t>({0, 0, 0, 65535, 0, 13107, 26214, 65535}), Eigen::Vector4d(0.0, 0.2, 0.4, 1.0));
    EXPECT_EQ(last_rotation<std::int8_t>({0, 0, 0, 127, 0, 127, -127, 1}), Eigen::Vector4d(0.0, 1.0, -1.0, 1.0 / 127.0));
    EXPECT_EQ(last_rotation<std::int16_t>({0, 0, 0, 32767, 0, 32767, -32767, 1}), Eigen::Vector4d(0.0, 1.0, -1.0, 1.0 / 32767.0));
}

TEST(GltfNumbers, TheLeastSignedNumberIsMinusOneToo)
{
    EXPECT_EQ(last_rotation<std::int8_t>({0, 0, 0, 127, -128, 0, 0, 127}).x(), -1.0);
    EXPECT_EQ(last_rotation<std::int16_t>({0, 0, 0, 32767, -32768, 0, 0, 32767}).x(), -1.0);
}

TEST(GltfNumbers, IntegersThatAreNotNormalisedKeepTheirValues)  // as KHR_mesh_quantization stores points
{
    GltfDocument gltf = two_joint_document();
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
        gltf.put<std::int16_t>("VEC3", {-300, 0, 7, 1, 2, 0, 1, 4, 0, 2, 2, 0});
    EXPECT_EQ(Vec3(points_in(gltf).row(0)), Vec3(-300, 0, 7));
}

TEST(GltfNumbers, OfAStridedViewAndAnOffset)
{
    GltfDocument gltf = two_joint_document();
    // Each of the four points is followed by a number that is none of its own; one number precedes them.
    gltf.put<float>("SCALAR", {99, 1, 2, 3, 99, 4, 5, 6, 99, 7, 8, 9, 99, 10, 11, 12});
    gltf.json["bufferViews"].back()["byteStride"] = 16;
    gltf.json["accessors"].back().update({{"byteOffset", 4}, {"type", "VEC3"}, {"count", 4}});
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = gltf.json["accessors"].size() - 1;
    EXPECT_EQ(points_in(gltf), (Positions(4, 3) << 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12).finished());
}

// Points 1 and 3 get other places.
GltfDocument with_sparse_points()
{
    GltfDocument gltf = two_joint_document();
    const int indices = gltf.put_bytes<std::uint8_t>({1, 3}), values = gltf.put_bytes<float>({10, 20, 30, 40, 50, 60});
    gltf.json["accessors"][0]["sparse"] = {
        {"count", 2}, {"indices", {{"bufferView", indices}, {"componentType", 5121}}}, {"values", {{"bufferView", values}}}};
    return gltf;
}

TEST(GltfNumbers, ASparseAccessorReplacesSomeElements)
{
    EXPECT_EQ(points_in(with_sparse_points()), (Positions(4, 3) << 1, 0, 0, 10, 20, 30, 1, 4, 0, 40, 50, 60).finished());
}

TEST(GltfNumbers, ASparseAccessorWithoutAViewReplacesZeros)
{
    GltfDocument gltf = with_sparse_points();
    gltf.json["accessors"][0].erase("bufferView");
    EXPECT_EQ(points_in(gltf), (Positions(4, 3) << 0, 0, 0, 10, 20, 30, 0, 0, 0, 40, 50, 60).finished());
}

TEST(GltfNumbers, AnAccessorWithoutAViewHoldsZeros)
{
    GltfDocument gltf = two_joint_document();
    gltf.json["accessors"][0].erase("bufferView");
    EXPECT_EQ(points_in(gltf), Positions(Positions::Zero(4, 3)));
}

}  // namespace
