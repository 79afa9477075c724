// Reference: a cube, counted by hand, in each format.

#include "experiments/meshes/mesh_io.hpp"
#include "experiments/rigs/surface_reader.hpp"
#include "tests/support/arm_in_formats.hpp"
#include "tests/support/closed_surfaces.hpp"
#include "tests/support/fbx_file.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace surface_reader_tests {
namespace {

using Surface = test_support::FolderTest;
using SurfaceFormats = test_support::FolderTest;
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
                text << "vertex " << corners[v][0] * edge << ' ' << corners[v][1] * edge << ' ' << corners[v][2] * edge
                     << '\n';
            text << "endloop\nendfacet\n";
        }
    text << "endsolid cube\n";
    return text.str();
}

void expect_cube(const std::string& path, double edge)
{
    const pbs::SurfaceMesh cube = pbs::read_surface(path);
    EXPECT_EQ(cube.points.rows(), 8) << path;
    EXPECT_EQ(cube.triangles.rows(), 12) << path;
    // Outward. A .ply and an .stl may be in single precision: the digits, the power of ten and their product are
    // rounded, for three edges.
    EXPECT_NEAR(test_support::enclosed_volume(cube.points, cube.triangles), edge * edge * edge,
                test_support::rounding_error_in<float>(3 * 3, edge * edge * edge))
        << path;
}

TEST_F(Surface, QuadsAreTriangulatedAndPointsJoinedInEveryFormat)
{
    for (const double edge : {2.0, 1e-6}) {  // joining is exact: a body of a micrometre does not collapse
        expect_cube(folder.file("cube.obj", points("v ", edge) + faces("f", 1)), edge);
#ifdef PBS_WITH_CGAL
        expect_cube(folder.file("cube.off", "OFF\n8 6 0\n" + points("", edge) + faces("4", 0)), edge);
        expect_cube(
            folder.file(
                "cube.ply",
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

TEST_F(Surface, AFrameKeepsThePointsOfTheFileAndAVtpIsReadToTheBit)
{
    pbs::SurfaceMesh cube = pbs::read_surface(folder.file("cube.obj", points("v ", 1.0) + faces("f", 1)));
    cube.points /= 3.0;
    pbs::write_vtp(folder / "cube.vtp", cube.points, cube.triangles);
    const pbs::SurfaceMesh vtp = pbs::read_surface_frame(folder / "cube.vtp").mesh;
    EXPECT_EQ(vtp.points, cube.points);
    EXPECT_EQ(vtp.triangles, cube.triangles);
    expect_cube(folder / "cube.vtp", 1.0 / 3.0);
    EXPECT_TRUE(pbs::is_surface_file(folder / "cube.vtp"));
    EXPECT_FALSE(pbs::is_surface_file(folder / "cube.vtu"));
#ifdef PBS_WITH_CGAL
    const pbs::SurfaceMesh corners = pbs::read_surface_frame(folder.file("cube.stl", stl(2.0))).mesh;
    EXPECT_EQ(corners.points.rows(), 36);
    EXPECT_EQ(corners.triangles.row(11), (pbs::Triangles(1, 3) << 33, 34, 35).finished());
    // the last corner of the last quad
    EXPECT_EQ(corners.points.row(35), (pbs::Positions(1, 3) << 0, 2, 2).finished());
    const pbs::SurfaceMesh own =
        pbs::read_surface_frame(
            folder.file("seam.off", "OFF\n6 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 0\n0 1 0\n-1 0 0\n3 0 1 2\n3 3 4 5\n"))
            .mesh;
    EXPECT_EQ(own.points.rows(), 6) << "seams are kept";
#endif
}

TEST_F(Surface, PointsSplitAtTextureSeamsAreJoined)
{
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

TEST_F(Surface, OneMeshOfSeveralIsReadByName)
{
    const std::string path =
        folder.file("two.obj", points("v ", 1.0) + "o cube\n" + faces("f", 1) + "o lid\nf 5 6 7\n");
    EXPECT_EQ(pbs::read_surface(path).triangles.rows(), 13);
    EXPECT_EQ(pbs::read_surface(path, "cube").triangles.rows(), 12);
    EXPECT_EQ(pbs::read_surface(path, "lid").points.rows(), 3);
    expect_input_error([&] { pbs::read_surface(path, "box"); },
                       path + ": mesh = box: ", "expected one of the file's meshes: cube, lid");
}

TEST_F(Surface, AnEdgeInThreeTrianglesIsARemarkWithItsPlace)
{
    const std::string path = folder.file("flap.obj", points("v ", 1.0) + "v 0.5 -1 -1\n" + faces("f", 1) + "f 1 2 9\n");
    std::vector<std::string> remarks;
    EXPECT_EQ(pbs::read_surface(path, remarks).triangles.rows(), 13);
    EXPECT_NE(std::find(remarks.begin(), remarks.end(),
                        path + ": edges of three or more triangles = 1: not manifold there, first from (1, 0, 0) to "
                               "(0, 0, 0); the surface is "
                               "wrapped"),
              remarks.end());
}

#ifdef PBS_WITH_CGAL
TEST_F(Surface, CrossingTrianglesAreToldWithTheFirstPlace)
{
    std::vector<std::string> remarks;
    // a triangle through the lid, and open
    const std::string needle = "v 0.5 0.4 0.5\nv 0.5 0.6 0.5\nv 0.5 0.5 3\nf 9 10 11\n";
    pbs::read_surface(folder.file("x.obj", points("v ", 1.0) + faces("f", 1) + needle), remarks);
    ASSERT_EQ(remarks.size(), 2u);
    EXPECT_NE(remarks[1].find("pairs of triangles that meet = 2: it intersects or touches itself, first at ("),
              std::string::npos)
        << remarks[1];
    remarks.clear();
    pbs::read_surface(folder.file("cube.obj", points("v ", 1.0) + faces("f", 1)), remarks);
    EXPECT_TRUE(remarks.empty());
}
#endif

// Reference: two triangles in COLLADA and FBX, whose unit is the centimetre, by hand. assimp computes in single
// precision: at most 16 roundings.

// The corners of the two triangles, whatever the order of the points.
void expect_two_triangles(const std::string& path, const pbs::Vec3& shift_m, double metres_per_unit)
{
    const pbs::SurfaceMesh surface = pbs::read_surface(path);
    ASSERT_EQ(surface.points.rows(), 4) << path;
    ASSERT_EQ(surface.triangles.rows(), 2) << path;
    const pbs::Positions corners =
        // of (0, 1, 3) and (1, 2, 3)
        (pbs::Positions(6, 3) << 1, 0, 0, 1, 2, 0, 2, 2, 0, 1, 2, 0, 1, 4, 0, 2, 2, 0).finished();
    for (int c = 0; c < 6; ++c) {
        const pbs::Vec3 expected = shift_m + metres_per_unit * corners.row(c).transpose();
        const pbs::Vec3 point = surface.points.row(surface.triangles(c / 3, c % 3));
        EXPECT_LE((point - expected).norm(), test_support::rounding_error_in<float>(16, 5.0 * metres_per_unit))
            << path << ", corner " << c;
    }
}

TEST_F(SurfaceFormats, ColladaAndFbxAreInMetresAndTheTransformsOfNodesApplied)
{
    expect_two_triangles(folder.file("arm.dae", test_support::collada_arm()), {0, 0, 0}, 0.01);
    expect_two_triangles(folder.file("arm.fbx", test_support::fbx_arm()), {0, 0, 0}, 0.01);
    std::string metres = test_support::fbx_arm();
    const std::string stated = "\"Number\", \"\",1\n}";
    metres.replace(metres.find(stated), stated.size(), "\"Number\", \"\",100\n}");
    expect_two_triangles(folder.file("metres.fbx", metres), {0, 0, 0}, 1.0);
}

// Reference: the format's formulas by hand, for a cube of 1 unit whose turns are quarter turns. Numbers have 12 digits,
// and are read in double precision: at most 64 roundings of the largest coordinate.

constexpr double far = 12345678.9012;

// expected: of each corner of the cube in turn [m].
template <typename Expected>
void expect_corners(const std::string& path, const Expected& expected)
{
    const pbs::SurfaceMesh cube = pbs::read_surface(path);
    ASSERT_EQ(cube.points.rows(), 8) << path;
    EXPECT_EQ(cube.triangles.rows(), 12) << path;
    for (const auto& corner : corners) {
        const pbs::Vec3 place = expected(pbs::Vec3(corner[0], corner[1], corner[2]));
        const double nearest = (cube.points.rowwise() - place.transpose()).rowwise().norm().minCoeff();
        EXPECT_LE(nearest, test_support::rounding_error_in<double>(64, place.norm() + 1.0))
            << path << ", " << place.transpose();
    }
}

test_support::FbxFile fbx_cube(const test_support::FbxProperties& properties,
                               const test_support::FbxProperties& of_parent)
{
    test_support::FbxFile file;
    test_support::FbxNumbers points, polygons;
    for (const auto& corner : corners)
        points.insert(points.end(), {double(corner[0]), double(corner[1]), double(corner[2])});
    for (const auto& q : quads)
        polygons.insert(polygons.end(), {double(q[0]), double(q[1]), double(q[2]), -1.0 - q[3]});
    file.mesh("cube", file.node("body", file.node("above", 0, "Null", of_parent), "Mesh", properties), points,
              polygons);
    return file;
}

TEST_F(SurfaceFormats, AnFbxHasItsGeometricTransformItsPivotAndItsPostRotation)
{
    const test_support::FbxFile file = fbx_cube({{"GeometricTranslation", {0.5, 0, 0}},
                                                 {"GeometricRotation", {0, 0, 90}},
                                                 {"GeometricScaling", {2, 1, 1}},
                                                 {"RotationActive", {1}},
                                                 {"PostRotation", {0, 0, 90}},
                                                 {"RotationPivot", {0, 3, 0}},
                                                 {"Lcl Translation", {0, 0, far}}},
                                                {{"Lcl Scaling", {1, 2, 1}}});
    const auto expected = [](const pbs::Vec3& p) {
        const pbs::Vec3 geometric(0.5 - p.y(), 2.0 * p.x(), p.z());
        // by -90 degrees about the pivot
        const pbs::Vec3 turned(geometric.y() - 3.0, 3.0 - geometric.x(), geometric.z() + far);
        return pbs::Vec3(0.01 * turned.x(), 0.01 * 2.0 * turned.y(), 0.01 * turned.z());
    };
    expect_corners(folder.file("cube.fbx", file.text()), expected);
    expect_corners(folder.file("binary.fbx", file.binary(true)), expected);
}

TEST_F(SurfaceFormats, OfInheritTypeRrsTheScaleOfTheParentMovesTheNodeAlone)
{
    const test_support::FbxFile file =
        fbx_cube({{"InheritType", {2}}, {"Lcl Translation", {1, 0, 0}}}, {{"Lcl Scaling", {3, 3, 3}}});
    expect_corners(folder.file("cube.fbx", file.text()),
                   [](const pbs::Vec3& p) -> pbs::Vec3 { return 0.01 * (p + pbs::Vec3(3, 0, 0)); });
}

// The cube as COLLADA in centimetres, at a place, in a node that moves it by another one.
std::string collada_cube(double place, double of_node)
{
    std::ostringstream text;
    text.precision(17);
    text << "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
            "version=\"1.4.1\">\n<asset><unit "
            "name=\"centimeter\" meter=\"0.01\"/><up_axis>Y_UP</up_axis></asset>\n<library_geometries><geometry "
            "id=\"cube\" name=\"box\">"
            "<mesh><source id=\"p\"><float_array id=\"pa\" count=\"24\">";
    for (const auto& corner : corners) text << corner[0] + place << ' ' << corner[1] << ' ' << corner[2] << ' ';
    text << "</float_array><technique_common><accessor source=\"#pa\" count=\"8\" stride=\"3\"><param name=\"X\" "
            "type=\"float\"/><param "
            "name=\"Y\" type=\"float\"/><param name=\"Z\" "
            "type=\"float\"/></accessor></technique_common></source><vertices id=\"v\"><input "
            "semantic=\"POSITION\" source=\"#p\"/></vertices><polylist count=\"6\"><input semantic=\"VERTEX\" "
            "source=\"#v\" "
            "offset=\"0\"/><vcount>4 4 4 4 4 4</vcount><p>";
    for (const auto& q : quads)
        for (const int v : q) text << v << ' ';
    text << "</p></polylist></mesh></geometry></library_geometries>\n<library_visual_scenes><visual_scene "
            "id=\"s\"><node "
            "id=\"body\"><translate>0 0 "
         << of_node
         << "</translate><instance_geometry "
            "url=\"#cube\"/></node></visual_scene></library_visual_scenes>\n<scene><instance_visual_scene "
            "url=\"#s\"/></scene>\n</COLLADA>\n";
    return text.str();
}

TEST_F(SurfaceFormats, ColladaFarFromTheOriginKeepsItsDigits)
{
    const std::string path = folder.file("cube.dae", collada_cube(far, 8.0));
    expect_corners(path, [](const pbs::Vec3& p) -> pbs::Vec3 { return 0.01 * (p + pbs::Vec3(far, 0, 8)); });
    EXPECT_EQ(pbs::read_surface(path, "cube").points, pbs::read_surface(path).points) << "by the id of its geometry";
    EXPECT_EQ(pbs::read_surface(path, "body").points, pbs::read_surface(path).points) << "by that of its node";
    expect_input_error([&] { pbs::read_surface(path, "lid"); },
                       path + ": mesh = lid: ", "expected one of the file's meshes: cube");
    const std::string torn = folder.file(
        "torn.dae", test_support::collada_arm().replace(test_support::collada_arm().find("<p>0"), 4, "<p>-1"));
    expect_input_error([&] { pbs::read_surface(torn); }, torn + ":6: p = -1: ", "expected indices from 0");
}

// assimp drops names of more than 1023 letters, so that the place of such a mesh is not known.
TEST_F(SurfaceFormats, ColladaFarFromTheOriginRefusesANameThatTheReaderChanges)
{
    const std::string id(1100, 'c');
    const auto with_id = [&](double place) {
        std::string text = collada_cube(place, 8.0);
        for (const std::string quoted : {"\"cube\"", "\"#cube\""})
            text.replace(text.find(quoted) + quoted.size() - 5, 4, id);
        return text;
    };
    const std::string path = folder.file("cube.dae", with_id(far));
    expect_input_error([&] { pbs::read_surface(path); },
                       path + ": mesh of node body: ", "expected the id of a geometry");
    EXPECT_EQ(pbs::read_surface(folder.file("near.dae", with_id(0.0))).points.rows(), 8);
}

TEST_F(SurfaceFormats, ColladaFarFromTheOriginMayHaveAGeometryThatNoNodeUses)
{
    std::string text = collada_cube(far, 8.0);
    const std::size_t begin = text.find("<geometry "), end = text.find("</library_geometries>");
    text.insert(
        end, std::regex_replace(text.substr(begin, end - begin), std::regex("\"(#?)(cube|pa?|v)\""), "\"$1other-$2\""));
    expect_corners(folder.file("cube.dae", text),
                   [](const pbs::Vec3& p) -> pbs::Vec3 { return 0.01 * (p + pbs::Vec3(far, 0, 8)); });
}

// What joints move is in the bind pose, wherever the node of the mesh is.
TEST_F(SurfaceFormats, ASkinnedMeshIsInItsBindPose)
{
    std::string text = test_support::fbx_arm();
    const std::string body = "\"Model::body\", \"Mesh\" {\nVersion: 232\n";
    text.replace(text.find(body), body.size(),
                 body + "Properties70: {\nP: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",0,0,300\n}\n");
    expect_two_triangles(folder.file("moved.fbx", text), {0, 0, 0}, 0.01);
    EXPECT_TRUE(pbs::read_surface_frame(folder / "moved.fbx").has_skin);
    EXPECT_FALSE(pbs::read_surface_frame(folder.file("cube.dae", collada_cube(0.0, 0.0))).has_skin);
}

TEST_F(SurfaceFormats, PackedColladaIsReadAsTheUnpackedOne)
{
    const std::string folder = "/usr/share/assimp/models/Collada/";
    if (!std::filesystem::exists(folder + "duck.zae")) GTEST_SKIP() << "assimp-testmodels is not installed";
    const pbs::SurfaceMesh packed = pbs::read_surface(folder + "duck.zae"),
                           plain = pbs::read_surface(folder + "duck.dae");
    EXPECT_EQ(packed.points, plain.points);
    EXPECT_EQ(packed.triangles, plain.triangles);
}

}  // namespace
}  // namespace surface_reader_tests
