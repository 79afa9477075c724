// Reference: a tetrahedron with corners at 0 and one at each axis, of 1/6 m^3 at scale 1, in the forms in which
// programs write .obj.
#include "experiments/meshes/mesh_io.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include "experiments/rigs/surface_reader.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace surface_obj_tests {
namespace {

using Obj = test_support::FolderTest;

const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n", faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

double volume_of(const pbs::SurfaceMesh& mesh)
{
    return pbs::fan_volume(mesh.points, mesh.triangles);
}

TEST_F(Obj, IsReadInEveryFormThatProgramsWrite)
{
    std::string utf16 = "\xFF\xFE", indented, of_windows = "\xEF\xBB\xBF";
    for (const char c : points + faces) {
        utf16 += c + std::string(1, '\0');
        indented += c == '\n' ? "\n \t" : std::string(1, c);
        of_windows += c == '\n' ? "\r\n" : std::string(1, c);
    }
    for (const std::string& text : std::vector<std::string>{
             points + faces, utf16, "  " + indented, of_windows,
             "# a folder\\of\\windows\\\n" + points + "usemtl skin\\pale\\\n" + faces,
             "v 0 0 0 # origin\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2 # below\nf 1 2 4#\nf 2 3 4\nf 1 4 3\n",
             "v 0 \\\n0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 \\\r\n3 \\\n2\nf 1 2 4\nf 2 3 4\nf 1 4 3",
             points + "f -4 -2 -3\nf -4 -3 -1\nf 2/1/1 3/2/1 4//1\nf 1/7 4/8 3/9\n",
             "v 0 0 0 1.0\nv 1.0D+00 0 0 0.5 0.5 0.5\nv 0 1e0 0\nv 0 0 +1.\nl 1 2\np 1\n" + faces}) {
        const pbs::SurfaceMesh mesh = pbs::read_surface(folder.file("a.obj", text));
        EXPECT_EQ(mesh.points.rows(), 4) << text;
        EXPECT_EQ(mesh.triangles.rows(), 4) << text;
        EXPECT_DOUBLE_EQ(volume_of(mesh), 1.0 / 6.0) << text;
    }
}

// In single precision, coordinates with seven digits before the point are multiples of 0.5 m.
TEST_F(Obj, KeepsItsVolumeFarFromTheOrigin)
{
    const pbs::SurfaceMesh mesh = pbs::read_surface(folder.file(
        "a.obj",
        "v 4649776.25 500000.5 0\nv 4649776.5 500000.5 0\nv 4649776.25 500000.75 0\nv 4649776.25 500000.5 0.25\n" +
            faces));
    EXPECT_DOUBLE_EQ(volume_of(mesh), 0.25 * 0.25 * 0.25 / 6.0);  // differences of such coordinates are exact
}

TEST_F(Obj, IsRefusedWithFileLineFieldValueAndRule)
{
    for (const auto& [text, begins, holds] :
         {std::tuple{"v 0 0 0\nv 1.#QNAN 0 0\n" + faces, ":2: vertex 2 = 1.#QNAN: ", "expected three numbers"},
          {"v 0 0 0\nv 1,5 0 0\n" + faces, ":2: vertex 2 = 1,5: ", "expected three numbers"},
          {"v 0 0 0\nv 1 0\n" + faces, ":2: vertex 2: ", "expected three numbers"},
          {"v 0 0 0\nv nan 0 0\n" + faces, ":2: vertex 2 = nan: ", "expected finite coordinates within 1e9 m"},
          {points + "f 1 2 5\n", ":5: face = 5: ", "expected the number of a vertex from 1 to 4"},
          {points + "f 1 2 -5\n",
           ":5: face = -5: ", "expected the number of a vertex, from 1 or, backwards, from -1 to -4"},
          {points + "f 1 2 0\n", ":5: face = 0: ", "expected the number of a vertex"},
          {points + "f 1 2 x\n", ":5: face = x: ", "expected the number of a vertex"}}) {
        const std::string path = folder.file("a.obj", text);
        expect_input_error([&] { pbs::read_surface(path); }, path + begins, holds);
    }
}

#ifdef PBS_WITH_CGAL
TEST_F(Obj, AClosedCavityIsNamedWithItsVolume)
{
    const std::string inner = "v 0.1 0.1 0.1\nv 0.3 0.1 0.1\nv 0.1 0.3 0.1\nv 0.1 0.1 0.3\n";
    const auto remarks_on = [&](const std::string& text) {
        std::vector<std::string> remarks;
        pbs::read_surface(folder.file("a.obj", text), remarks);
        return remarks;
    };
    const std::vector<std::string> remarks =
        remarks_on(points + inner + faces + "f 5 6 7\nf 5 8 6\nf 6 8 7\nf 5 7 8\n");
    ASSERT_EQ(remarks.size(), 1u);
    // 0.2^3 / 6
    EXPECT_NE(remarks[0].find("closed cavities = 1: 0.00133333 m^3 in all, filled by tets"), std::string::npos)
        << remarks[0];
    EXPECT_TRUE(remarks_on(points + inner + faces + "f 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n").empty())
        << "a body inside faces outwards";
    const std::string beside = "v 2.1 0.1 0.1\nv 2.3 0.1 0.1\nv 2.1 0.3 0.1\nv 2.1 0.1 0.3\n";
    EXPECT_TRUE(remarks_on(points + beside + faces + "f 5 6 7\nf 5 8 6\nf 6 8 7\nf 5 7 8\n").empty())
        << "beside the other body";
}
#endif

}  // namespace
}  // namespace surface_obj_tests
