// Reference: the unit tet in formats whose names do not fit their content. Known vertices that no tet uses, and parts that touch.
#include "pbs/geometry/mesh_io.hpp"

#include "pbs/geometry/mesh_remarks.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/unit_tet.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

namespace {

using test_support::ScratchFolder;
using test_support::unit_tet;

const std::string legacy_vtk =
    "# vtk DataFile Version 3.0\ntet\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 1\nCELLS 1 5\n4 0 1 2 3\n"
    "CELL_TYPES 1\n10\n";

TEST(ReadByContent, BothFormatsOfVtkUnderEitherName)
{
    const ScratchFolder folder;
    pbs::write_tet_mesh(folder / "a.vtu", unit_tet());
    std::filesystem::copy_file(folder / "a.vtu", folder / "xml.vtk");
    for (const std::string& path : {folder / "xml.vtk", folder.file("legacy.vtu", legacy_vtk), folder.file("legacy.vtk", legacy_vtk),
                                    folder.file("legacy", legacy_vtk)})
        EXPECT_EQ(pbs::read_tet_mesh(path).mesh.rest, unit_tet().rest) << path;
}

TEST(ReadByContent, GmshAndMeditUnderAnotherNameWithARemark)
{
    const ScratchFolder folder;
    for (const auto& [extension, name] :
         {std::pair{".msh", "gmsh.vtk"}, {".msh", "gmsh.mesh"}, {".mesh", "medit.txt"}, {".mesh", "medit"}}) {
        pbs::write_tet_mesh(folder / (std::string("a") + extension), unit_tet());
        const std::string path = folder / name;
        std::filesystem::rename(folder / (std::string("a") + extension), path);
        const pbs::MeshReading reading = pbs::read_tet_mesh(path);
        EXPECT_EQ(reading.mesh.rest, unit_tet().rest) << path;
        EXPECT_EQ(reading.read_as, extension) << path;
        EXPECT_EQ(pbs::remarks_on(path, reading),
                  std::vector{path + ": format of the content = " + extension + ": read as such, whatever the file is called"});
    }
}

// Nodes that no element uses are counted in the file's own format.
TEST(ReadByContent, GmshUnderAnotherNameKeepsItsNumbers)
{
    const ScratchFolder folder;
    const std::string path = folder.file("2.txt",
                                         "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 9 9 9\n4 0 1 0\n5 0 0 1\n"
                                         "$EndNodes\n$Elements\n1\n1 4 2 0 1 1 2 4 5\n$EndElements\n");
    EXPECT_EQ(pbs::read_tet_mesh(path).unused_vertices, std::vector<int>{2});
}

TEST(ReadByContent, ADamagedGmshFileUnderAnotherNameIsRefusedByItsOwnName)
{
    const ScratchFolder folder;
    const std::string path = folder.file("a.vtk", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n");
    expect_input_error([&] { pbs::read_tet_mesh(path); }, path + ": ", "$EndNodes is missing");
}

TEST(ReadByContent, AnUnknownFormatIsRefusedByItsExtension)
{
    const ScratchFolder folder;
    const std::string path = folder.file("a.stl", "solid\n");
    expect_input_error([&] { pbs::read_tet_mesh(path); }, path + ": extension = .stl: ", "expected a tet mesh");
    expect_input_error([&] { pbs::read_tet_mesh(folder / "none.xyz"); }, (folder / "none.xyz") + ": ", "");
}

TEST(ReadTetMesh, LeavesOutUnusedVerticesWithARemark)
{
    const ScratchFolder folder;
    const std::string path = folder.file("a.tobj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nt 1 2 3 4\n");
    const pbs::MeshReading reading = pbs::read_tet_mesh(path);
    EXPECT_EQ(reading.mesh.rest, unit_tet().rest);
    EXPECT_EQ(reading.file_vertices, 5);
    EXPECT_EQ(reading.file_vertex, (std::vector<int>{1, 2, 3, 4}));
    EXPECT_EQ(reading.unused_vertices, std::vector<int>{0});
    const std::vector<std::string> remarks = pbs::remarks_on(path, reading);
    ASSERT_EQ(remarks.size(), 1u);
    EXPECT_EQ(remarks[0], path + ": unused vertices = 1 (0): left out; no tet uses them");
}

// Gmsh itself leaves such nodes out without a word.
TEST(ReadTetMesh, ListsTheUnusedNodesOfGmshAndMeditFiles)
{
    const ScratchFolder folder;
    const std::string nodes = "5\n1 0 0 0\n2 1 0 0\n3 9 9 9\n4 0 1 0\n5 0 0 1\n";
    const std::string version_2 =
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + nodes + "$EndNodes\n$Elements\n1\n1 4 2 0 1 1 2 4 5\n$EndElements\n";
    const std::string version_1 = "$NOD\n" + nodes + "$ENDNOD\n$ELM\n1\n1 4 1 1 4 1 2 4 5\n$ENDELM\n";
    const std::string medit =
        "MeshVersionFormatted 2\nDimension 3\nVertices\n5\n0 0 0 1\n1 0 0 1\n9 9 9 1\n0 1 0 1\n0 0 1 1\n"
        "Tetrahedra\n1\n1 2 4 5 1\nEnd\n";
    for (const std::string& path : {folder.file("2.msh", version_2), folder.file("1.msh", version_1), folder.file("a.mesh", medit)}) {
        const pbs::MeshReading reading = pbs::read_tet_mesh(path);
        EXPECT_EQ(reading.mesh.rest, unit_tet().rest) << path;
        EXPECT_EQ(reading.file_vertex, (std::vector<int>{0, 1, 3, 4})) << path;
        EXPECT_EQ(reading.unused_vertices, std::vector<int>{2}) << path;
    }
}

TEST(ReadTetMesh, SplitsAVertexAtWhichPartsTouchWithARemark)
{
    const ScratchFolder folder;
    const std::string path =
        folder.file("a.tobj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv -1 0 0\nv 0 -1 0\nv 0 0 -1\nt 0 1 2 3\nt 0 4 6 5\n");
    const pbs::MeshReading reading = pbs::read_tet_mesh(path);
    EXPECT_EQ(reading.mesh.rest.rows(), 8);
    EXPECT_EQ(reading.split_vertices, std::vector<int>{0});
    EXPECT_EQ(std::count(reading.file_vertex.begin(), reading.file_vertex.end(), 0), 2);
    const std::vector<std::string> remarks = pbs::remarks_on(path, reading);
    ASSERT_EQ(remarks.size(), 2u);
    EXPECT_EQ(remarks[0], path + ": vertices at which parts touch = 1 (0): split, so that each part has its own");
    EXPECT_EQ(remarks[1], path + ": parts = 2: kept; no face joins them");
}

TEST(ReadTetMesh, OfAMillimetreOrAHundredMetresNeedsNoRemarkAboutItsSize)
{
    const ScratchFolder folder;
    const auto remarks_at = [&](const std::string& edge) {
        const std::string path = folder.file("a.tobj", "v 0 0 0\nv " + edge + " 0 0\nv 0 " + edge + " 0\nv 0 0 " + edge + "\nt 0 1 2 3\n");
        return pbs::remarks_on(path, pbs::read_tet_mesh(path)).size();
    };
    for (const char* edge : {"0.001", "1", "100"}) EXPECT_EQ(remarks_at(edge), 0u) << edge;
    for (const char* edge : {"0.0009", "101"}) EXPECT_EQ(remarks_at(edge), 1u) << edge;
}

}  // namespace
