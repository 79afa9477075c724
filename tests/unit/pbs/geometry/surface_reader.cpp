// Reference: a cube, counted by hand, in each format.

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/arm_in_formats.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace {

using test_support::ScratchFolder;

constexpr int corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
constexpr int quads[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

std::string points(const char* before, double edge)
{
    std::ostringstream text;
    for (const auto& c : corners) text << before << c[0] * edge << ' ' << c[1] * edge << ' ' << c[2] * edge << '\n';
    return text.str();
}

std::string faces(const char* before, int first)
{
    std::ostringstream text;
    for (const auto& q : quads) {
        text << before;
        for (const int v : q) text << ' ' << v + first;
        text << '\n';
    }
    return text.str();
}

std::string stl(double edge)  // each triangle has points of its own
{
    std::ostringstream text;
    text << "solid cube\n";
    for (const auto& q : quads)
        for (const auto& t : {std::array{q[0], q[1], q[2]}, std::array{q[0], q[2], q[3]}}) {
            text << "facet normal 0 0 0\nouter loop\n";
            for (const int v : t)
                text << "vertex " << corners[v][0] * edge << ' ' << corners[v][1] * edge << ' ' << corners[v][2] * edge << '\n';
            text << "endloop\nendfacet\n";
        }
    text << "endsolid cube\n";
    return text.str();
}

double volume(const pbs::SurfaceMesh& surface)
{
    double sum = 0.0;
    for (Eigen::Index f = 0; f < surface.triangles.rows(); ++f)
        sum += pbs::tet_volume(pbs::Vec3::Zero(), surface.points.row(surface.triangles(f, 0)), surface.points.row(surface.triangles(f, 1)),
                               surface.points.row(surface.triangles(f, 2)));
    return sum;
}

void expect_cube(const std::string& path, double edge)
{
    const pbs::SurfaceMesh cube = pbs::read_surface(path);
    EXPECT_EQ(cube.points.rows(), 8) << path;
    EXPECT_EQ(cube.triangles.rows(), 12) << path;
    // Outward. assimp reads numbers in single precision: the digits, the power of ten and their product are rounded, for three edges.
    EXPECT_NEAR(volume(cube), edge * edge * edge, test_support::rounding_error_in<float>(3 * 3, edge * edge * edge)) << path;
}

TEST(Surface, QuadsAreTriangulatedAndPointsJoinedInEveryFormat)
{
    const ScratchFolder folder;
    for (const double edge : {2.0, 1e-6}) {  // joining is exact: a body of a micrometre does not collapse
        expect_cube(folder.file("cube.obj", points("v ", edge) + faces("f", 1)), edge);
#ifdef PBS_WITH_CGAL
        expect_cube(folder.file("cube.off", "OFF\n8 6 0\n" + points("", edge) + faces("4", 0)), edge);
        expect_cube(folder.file("cube.ply",
                                "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
                                "element face 6\nproperty list uchar int vertex_indices\nend_header\n" +
                                    points("", edge) + faces("4", 0)),
                    edge);
        expect_cube(folder.file("cube.stl", stl(edge)), edge);
#else
        EXPECT_THROW(pbs::read_surface(folder.file("cube.stl", stl(edge))), pbs::InputError);
#endif
    }
}

TEST(Surface, PointsSplitAtTextureSeamsAreJoined)
{
    const ScratchFolder folder;
    std::ostringstream text;  // each corner of each face has a texture coordinate of its own
    text << points("v ", 1.0);
    for (int i = 0; i < 24; ++i) text << "vt " << 0.01 * i << " 0.5\n";
    int texture = 1;
    for (const auto& q : quads) {
        text << 'f';
        for (const int v : q) text << ' ' << v + 1 << '/' << texture++;
        text << '\n';
    }
    expect_cube(folder.file("seams.obj", text.str()), 1.0);
}

TEST(Surface, OneMeshOfSeveralIsReadByName)
{
    const ScratchFolder folder;
    const std::string path = folder.file("two.obj", points("v ", 1.0) + "o cube\n" + faces("f", 1) + "o lid\nf 5 6 7\n");
    EXPECT_EQ(pbs::read_surface(path).triangles.rows(), 13);
    EXPECT_EQ(pbs::read_surface(path, "cube").triangles.rows(), 12);
    EXPECT_EQ(pbs::read_surface(path, "lid").points.rows(), 3);
    try {
        pbs::read_surface(path, "box");
        FAIL();
    } catch (const pbs::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("mesh = box: expected one of the file's meshes: cube, lid"), std::string::npos)
            << error.what();
    }
}

std::string refusal(const std::string& path)
{
    std::vector<std::string> remarks;
    try {
        pbs::read_surface(path, remarks);
    } catch (const pbs::InputError& error) {
        return error.what();
    }
    return "";
}

TEST(Surface, AnEdgeInThreeTrianglesIsARemarkWithItsPlace)
{
    const ScratchFolder folder;
    const std::string path = folder.file("flap.obj", points("v ", 1.0) + "v 0.5 -1 -1\n" + faces("f", 1) + "f 1 2 9\n");
    std::vector<std::string> remarks;
    EXPECT_EQ(pbs::read_surface(path, remarks).triangles.rows(), 13);
    EXPECT_NE(
        std::find(remarks.begin(), remarks.end(),
                  path + ": edges of three or more triangles = 1: not manifold there, first from (0, 0, 0) to (1, 0, 0); the surface is "
                         "wrapped"),
        remarks.end());
    EXPECT_EQ(refusal(folder.file("cube.obj", points("v ", 1.0) + faces("f", 1))), "");
}

#ifdef PBS_WITH_CGAL
TEST(Surface, CrossingTrianglesAreToldWithTheFirstPlace)
{
    const ScratchFolder folder;
    std::vector<std::string> remarks;
    const std::string needle = "v 0.5 0.4 0.5\nv 0.5 0.6 0.5\nv 0.5 0.5 3\nf 9 10 11\n";  // a triangle through the lid, and open
    pbs::read_surface(folder.file("x.obj", points("v ", 1.0) + faces("f", 1) + needle), remarks);
    ASSERT_EQ(remarks.size(), 2u);
    EXPECT_NE(remarks[1].find("pairs of triangles that meet = 2: it intersects or touches itself, first at ("), std::string::npos)
        << remarks[1];
    remarks.clear();
    pbs::read_surface(folder.file("cube.obj", points("v ", 1.0) + faces("f", 1)), remarks);
    EXPECT_TRUE(remarks.empty());
}
#endif

// The unit tetrahedron with the given last index and the stated number of its twelve indices.
std::string gltf(const ScratchFolder& folder, unsigned short last, int told)
{
    const std::array<float, 12> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::array<unsigned short, 12> corners = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, last};
    std::string bytes(sizeof points + sizeof corners, '\0');
    std::memcpy(bytes.data(), points.data(), sizeof points);
    std::memcpy(bytes.data() + sizeof points, corners.data(), sizeof corners);
    folder.file("x.bin", bytes);
    return folder.file(
        "x.gltf",
        R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "buffers": [{"byteLength": 72,
            "uri": "x.bin"}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], "bufferViews": [{"buffer": 0,
            "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}], "accessors": [{"bufferView": 0, "componentType": 5126,
            "count": 4, "type": "VEC3"}, {"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": )" +
            std::to_string(told) + "}]}");
}

TEST(Surface, WhatAssimpWouldDropOfAGltfIsRefused)
{
    const ScratchFolder folder;
    EXPECT_EQ(refusal(gltf(folder, 3, 12)), "");
    EXPECT_EQ(refusal(gltf(folder, 4, 12)), folder / "x.gltf" + ": assimp: Some faces had out-of-range indices. Those faces were dropped.");
    EXPECT_NE(refusal(gltf(folder, 3, 11)).find("Some vertices were dropped."), std::string::npos) << refusal(gltf(folder, 3, 11));
}

TEST(Surface, OneBelowANanometreIsRefused)
{
    const ScratchFolder folder;
    const std::string words = refusal(folder.file("speck.obj", points("v ", 1e-12) + faces("f", 1)));
    EXPECT_NE(words.find("extent = 1.73205e-12: expected at least 1e-9 m"), std::string::npos) << words;
}

TEST(Surface, TrianglesThatAreAllPointsOrLinesAreRefused)
{
    const ScratchFolder folder;
    const std::string path = folder.file("a.obj", "v 0 0 0\nv 1 0 0\nv 1 0 0\nf 1 2 3\nf 1 1 1\n");
    try {
        pbs::read_surface(path);
        FAIL() << "was read";
    } catch (const pbs::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("triangles = 2: expected one whose three corners differ"), std::string::npos)
            << error.what();
    }
}

TEST(Surface, PointsAndLinesAloneAreRefused)
{
    const ScratchFolder folder;
    EXPECT_THROW(pbs::read_surface(folder.file("lines.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n")), pbs::InputError);
}

// Reference: two triangles in COLLADA and FBX, whose unit is the centimetre, by hand. assimp computes in single precision: at most 16
// roundings.

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
