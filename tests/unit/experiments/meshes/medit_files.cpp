// Reference: the unit tet, in the forms in which programs write MEDIT's format.
#include "experiments/meshes/mesh_io.hpp"

#include "tests/support/scratch_folder.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using Medit = test_support::FolderTest;
using test_support::unit_tet;

const std::string medit_head = "MeshVersionFormatted 2\nDimension 3\n",
                  medit_vertices = "Vertices\n4\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\n",
                  medit_tets = "Tetrahedra\n1\n1 2 3 4 7\n", medit_end = "End\n";

std::string changed_in(std::string text, const std::string& what, const std::string& by)
{
    return text.replace(text.find(what), what.size(), by);
}

TEST_F(Medit, IsReadInEveryFormThatProgramsWrite)
{
    const std::string whole = medit_head + medit_vertices + medit_tets + medit_end;
    std::string indented, of_windows = "\xEF\xBB\xBF";
    for (const char c : whole) indented += c == '\n' ? "\n\t  " : std::string(1, c);
    for (const char c : whole) of_windows += c == '\n' ? "\r\n" : std::string(1, c);
    for (const std::string& text :
         {whole, "MeshVersionFormatted\n3\nDimension\n3\n" + medit_vertices + medit_tets,
          changed_in(whole, "Vertices\n4", "Vertices 4"), changed_in(whole, "Tetrahedra\n1", "Tetrahedra 1"), indented,
          of_windows, "# by a program\n\n" + whole,
          medit_head + "Identifier\n\"Vertices, and End\"\nGeometry\n\"a.mesh\"\n" + medit_vertices + medit_tets +
              medit_end,
          medit_head + "RequiredVertices\n2\n1\n2\nRequiredTetrahedra\n1\n1\n" + medit_vertices + medit_tets +
              medit_end,
          medit_head + "Hexahedra\n0\n" + medit_tets + medit_vertices + "Normals\n1\n0 0 1\nNormalAtVertices 1\n1 1\n" +
              medit_end,
          changed_in(whole, "1 0 0 1", "1.0D+00 0 0 1 # a comment")}) {
        const pbs::MeshReading reading = pbs::read_tet_mesh(folder.file("a.mesh", text));
        EXPECT_EQ(reading.mesh.rest, unit_tet().rest) << text;
        EXPECT_EQ(reading.mesh.tets, unit_tet().tets) << text;
    }
}

TEST_F(Medit, IsRefusedWithFileLineFieldValueAndRule)
{
    for (const auto& [text, begins, holds] :
         {std::tuple{medit_head + changed_in(medit_vertices, "4\n", "3\n") + medit_tets,
                     ":8: Vertices = 3: ", "more numbers follow the last of them"},
          {medit_head + changed_in(medit_vertices, "4\n", "5\n") + medit_tets,
           ":9: vertex = Tetrahedra: ", "expected a number"},
          {medit_head + medit_vertices + "Tetrahedra\n2\n1 2 3 4 7\n",
           ":12: tet vertex: ", "truncated: the file ends here"},
          {medit_head + medit_vertices + changed_in(medit_tets, "4 7", "5 7"),
           ": tet 1 vertex = 5: ", "expected a whole number from 1 to 4"},
          {medit_head + medit_vertices + changed_in(medit_tets, "4 7", "0 7"),
           ":11: tet vertex = 0: ", "expected a whole number from 1 to"},
          {medit_head + changed_in(medit_vertices, "1 0 0 1", "1 east 0 1") + medit_tets,
           ":6: vertex = east: ", "expected a number"},
          {medit_head + medit_tets, ": ", "the section Vertices is missing"},
          {medit_head + medit_vertices, ": ", "the section Tetrahedra is missing"},
          {medit_head + medit_vertices + medit_tets + "Prisms\n1\n1 2 3 4 1 2 7\n",
           ":13: elements = Prisms: ", "expected four-node tetrahedra"},
          {"MeshVersionFormatted 2\nDimension 2\n" + medit_vertices + medit_tets, ":2: Dimension = 2: ", "expected 3"},
          {medit_vertices + medit_tets, ":1: ", "beginning with MeshVersionFormatted"}}) {
        const std::string path = folder.file("a.mesh", text);
        expect_input_error([&] { pbs::read_tet_mesh(path); }, path + begins, holds);
    }
}

}  // namespace
