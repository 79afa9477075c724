// Reference: the tetrahedron of 1/6 m^3 with a corner at 0 and one on each axis, in the forms in which programs write
// .stl, .ply and .off.
#include "pbs/geometry/tet_mesh.hpp"

#include "experiments/rigs/surface_reader.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>

namespace {

using Polygons = test_support::FolderTest;

const std::string four_points = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n",
                  corners_of_faces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";

std::string ply_text(const std::string& format, const std::string& index, const std::string& data)
{
    return "ply\nformat " + format +
           " 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n" +
           "property list uchar " + index + " vertex_indices\nend_header\n" + data;
}

std::string stl_facet(const char* a, const char* b, const char* c)
{
    return "facet normal 0 0 0\nouter loop\nvertex " + std::string(a) + "\nvertex " + b + "\nvertex " + c +
           "\nendloop\nendfacet\n";
}

void expect_tetrahedron(const std::string& path)
{
    const pbs::SurfaceMesh mesh = pbs::read_surface(path);
    EXPECT_EQ(mesh.points.rows(), 4) << path;
    EXPECT_EQ(mesh.triangles.rows(), 4) << path;
    EXPECT_DOUBLE_EQ(pbs::fan_volume(mesh.points, mesh.triangles), 1.0 / 6.0) << path;
}

TEST_F(Polygons, OfStlMayBeInUpperCaseAndBehindTabsAndAByteOrderMark)
{
    const char *o = "0 0 0", *x = "1 0 0", *y = "0 1 0", *z = "0 0 1";
    const std::string facets = stl_facet(o, y, x) + stl_facet(o, x, z) + stl_facet(x, y, z) + stl_facet(o, z, y);
    const std::string whole = "solid a\n" + facets + "endsolid a\n";
    std::string upper = whole, tabs = whole;
    std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return std::toupper(c); });
    std::ranges::replace(tabs, ' ', '\t');
    for (const std::string& text : {whole, upper, tabs, "\xEF\xBB\xBF" + whole, "solid\n" + facets + "endsolid\n"})
        expect_tetrahedron(folder.file("a.stl", text));
    expect_tetrahedron(folder.file("tabs", tabs));  // known by its content
}

TEST_F(Polygons, OfPlyMayHaveShortIndicesAsTextAndAreRefusedByNameAsBytes)
{
    for (const char* index : {"char", "uchar", "short", "ushort", "int", "uint", "uint16", "int32"})
        expect_tetrahedron(folder.file("a.ply", ply_text("ascii", index, four_points + corners_of_faces)));
    const std::string path = folder.file("a.ply", ply_text("binary_little_endian", "ushort", std::string(200, '\0')));
    expect_input_error([&] { pbs::read_surface(path); }, path + ":8: type of vertex_indices = ushort: ", "or as text");
}

TEST_F(Polygons, OfOffMayLackTheNumberOfEdges)
{
    for (const char* counts : {"OFF\n4 4 0\n", "OFF\n4 4\n", "OFF 4 4\n",
                               "# by a program\nOFF\n\n4 4 # points, faces\r\n", "\xEF\xBB\xBFOFF\n4 4\n"})
        expect_tetrahedron(folder.file("a.off", counts + four_points + corners_of_faces));
}

}  // namespace
