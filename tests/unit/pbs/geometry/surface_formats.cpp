// Reference: two triangles in COLLADA and FBX, whose unit is the centimetre, by hand. assimp computes in single precision: at most 16
// roundings.
#include "pbs/geometry/mesh_io.hpp"

#include "tests/support/arm_in_formats.hpp"
#include "tests/support/scalar_rounding.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace {

using test_support::ScratchFolder;

// The corners of the two triangles, whatever the order of the points.
void expect_two_triangles(const std::string& path, const pbs::Vec3& shift_m, double metres_per_unit)
{
    const pbs::SurfaceMesh surface = pbs::read_surface(path);
    ASSERT_EQ(surface.points.rows(), 4) << path;
    ASSERT_EQ(surface.triangles.rows(), 2) << path;
    const pbs::Positions corners =
        (pbs::Positions(6, 3) << 1, 0, 0, 1, 2, 0, 2, 2, 0, 1, 2, 0, 1, 4, 0, 2, 2, 0).finished();  // of (0, 1, 3) and (1, 2, 3)
    for (int c = 0; c < 6; ++c) {
        const pbs::Vec3 expected = shift_m + metres_per_unit * corners.row(c).transpose();
        const pbs::Vec3 point = surface.points.row(surface.triangles(c / 3, c % 3));
        EXPECT_LE((point - expected).norm(), test_support::rounding_error_in<float>(16, 5.0 * metres_per_unit)) << path << ", corner " << c;
    }
}

TEST(SurfaceFormats, ColladaIsInMetres)
{
    const ScratchFolder folder;
    expect_two_triangles(folder.file("arm.dae", test_support::collada_arm()), {0, 0, 0}, 0.01);
}

TEST(SurfaceFormats, FbxIsInMetres)
{
    const ScratchFolder folder;
    expect_two_triangles(folder.file("arm.fbx", test_support::fbx_arm()), {0, 0, 0}, 0.01);
    std::string metres = test_support::fbx_arm();
    const std::string stated = "\"Number\", \"\",1\n}";
    metres.replace(metres.find(stated), stated.size(), "\"Number\", \"\",100\n}");
    expect_two_triangles(folder.file("metres.fbx", metres), {0, 0, 0}, 1.0);
}

TEST(SurfaceFormats, TheTransformsOfNodesAreApplied)
{
    const ScratchFolder folder;
    std::string text = test_support::fbx_arm();
    const std::string body = "\"Model::body\", \"Mesh\" {\nVersion: 232\n";
    text.replace(text.find(body), body.size(),
                 body + "Properties70: {\nP: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",0,0,300\n}\n");
    expect_two_triangles(folder.file("moved.fbx", text), {0, 0, 3}, 0.01);
}

TEST(SurfaceFormats, PackedColladaIsReadAsTheUnpackedOne)
{
    const std::string folder = "/usr/share/assimp/models/Collada/";
    if (!std::filesystem::exists(folder + "duck.zae")) GTEST_SKIP() << "assimp-testmodels is not installed";
    const pbs::SurfaceMesh packed = pbs::read_surface(folder + "duck.zae"), plain = pbs::read_surface(folder + "duck.dae");
    EXPECT_EQ(packed.points, plain.points);
    EXPECT_EQ(packed.triangles, plain.triangles);
}

TEST(SurfaceFormats, FilesThatEndEarlyAreRefusedByName)
{
    const ScratchFolder folder;
    for (const auto& [name, text] : {std::pair("a.dae", test_support::collada_arm()), std::pair("a.fbx", test_support::fbx_arm())}) {
        const std::string path = folder.file(name, text.substr(0, text.size() / 2));
        expect_input_error([&, file = path] { pbs::read_surface(file); }, path + ": ", "");
    }
}

}  // namespace
