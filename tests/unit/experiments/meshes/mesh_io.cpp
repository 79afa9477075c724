// Reference: a mesh that is written is read back to the bit, and files written by hand give the numbers in them.

#include "experiments/meshes/mesh_io.hpp"
#include "pbs/system/files.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using Writing = test_support::FolderTest;
using ReadByContent = test_support::FolderTest;
using ReadTetMesh = test_support::FolderTest;
using Tobj = test_support::FolderTest;
using test_support::ScratchFolder;

// A bar whose coordinates have all digits, some of them tiny and some huge.
pbs::TetMesh awkward_bar()
{
    pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {3, 2, 2});
    for (Eigen::Index i = 0; i < bar.rest.rows(); ++i)
        bar.rest.row(i) +=
            0.01 * pbs::Vec3(std::sin(i), std::cos(3.0 * double(i)), std::sin(7.0 * double(i))).transpose();
    bar.rest(0, 0) = 1e-17 / 3.0;
    bar.rest(1, 1) = -std::numeric_limits<double>::denorm_min();
    return bar;
}

class TetFormats : public ::testing::TestWithParam<const char*> {
protected:
    const ScratchFolder folder;
    const std::string path = folder / (std::string("bar") + GetParam());
};

TEST_P(TetFormats, AreReadBackToTheBit)
{
    const pbs::TetMesh bar = awkward_bar();
    pbs::write_tet_mesh(path, bar);
    const pbs::MeshReading reading = pbs::read_tet_mesh(path);
    EXPECT_EQ(reading.mesh.rest, bar.rest);
    EXPECT_EQ(reading.mesh.tets, bar.tets);
    EXPECT_EQ(reading.flipped_tets, 0);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "a temporary file was left";
}

TEST_P(TetFormats, NormaliseOrientationOfMeshesButNotOfFrames)
{
    pbs::TetMesh bar = awkward_bar();
    const pbs::Tets upright = bar.tets;
    for (const int t : {0, 5, 17}) std::swap(bar.tets(t, 2), bar.tets(t, 3));
    pbs::write_tet_mesh(path, bar);
    const pbs::MeshReading reading = pbs::read_tet_mesh(path);
    EXPECT_EQ(reading.flipped_tets, 3);
    EXPECT_EQ(reading.mesh.tets, upright);
    EXPECT_EQ(pbs::read_tet_frame(path).tets, bar.tets);
}

INSTANTIATE_TEST_SUITE_P(MeshIo, TetFormats, ::testing::Values(".msh", ".vtu", ".mesh", ".MSH"));

TEST(TetGen, ReadsZeroAndOneBasedFilesWithComments)
{
    const ScratchFolder folder;
    const std::string points = "# comment\n4 3 0 0\n\n%0 0 0 0 # origin\n%1 1.5 0 0\n%2 0 1 0\n%3 0 0 1e0\n";
    for (const int first : {0, 1}) {
        std::string node = points;
        for (int i = 0; i < 4; ++i) node.replace(node.find("%" + std::to_string(i)), 2, std::to_string(i + first));
        folder.file("one.node", node);
        const std::string ele = folder.file("one.ele", first == 0 ? "1 4 0\n0 0 1 2 3\n" : "1 4 0\n1 1 2 3 4\n");
        const pbs::MeshReading reading = pbs::read_tet_mesh(ele);
        EXPECT_EQ(reading.mesh.rest(1, 0), 1.5);
        EXPECT_EQ(reading.mesh.tets, (pbs::Tets(1, 4) << 0, 1, 2, 3).finished());
    }
}

TEST_F(Writing, FramesMayBeInvertedAndFlat)
{
    pbs::TetMesh bar = awkward_bar();
    bar.rest.col(2) *= 0.0;
    pbs::write_tet_mesh(folder / "flat.vtu", bar);
    EXPECT_EQ(pbs::read_tet_frame(folder / "flat.vtu").rest, bar.rest);
    EXPECT_THROW(pbs::read_tet_mesh(folder / "flat.vtu"), pbs::InputError);
}

TEST_F(Writing, TheVectorsOfAFramesPointsAreReadBackByNameToTheBit)
{
    const pbs::TetMesh bar = awkward_bar();
    const pbs::Positions shift = 2.0 * bar.rest;
    pbs::write_vtu(folder / "a.vtu", bar.rest, bar.tets,
                   {.point_vectors = {{"u", shift}, {"v", bar.rest}}, .point_flags = {}, .cell_scalars = {}});
    EXPECT_EQ(pbs::read_point_arrays(folder / "a.vtu").size(), 2u);
    EXPECT_EQ(pbs::read_point_arrays(folder / "a.vtu", "u"), (std::map<std::string, Eigen::MatrixXd>{{"u", shift}}));
    EXPECT_TRUE(pbs::read_point_arrays(folder / "a.vtu", "w").empty());
    pbs::write_tet_mesh(folder / "a.mesh", bar);
    EXPECT_TRUE(pbs::read_point_arrays(folder / "a.mesh").empty());
}

TEST_F(Writing, IntoAMissingFolderIsRefusedAndNamesTheFile)
{
    for (const std::string name : {"/no/such/folder/a.msh", "/no/such/folder/a.vtu", "/no/such/folder/a.mesh"})
        expect_input_error([&] { pbs::write_tet_mesh(name, awkward_bar()); }, name, "");
    EXPECT_THROW(pbs::write_pvd("/no/such/folder/a.pvd", {}), pbs::InputError);
}

TEST_F(Writing, UnknownExtensionsAndFieldsOfTheWrongLengthAreRefusedByName)
{
    EXPECT_THROW(pbs::write_tet_mesh("bar.stl", awkward_bar()), pbs::InputError);
    const pbs::TetMesh bar = awkward_bar();
    pbs::FrameFields fields;
    fields.cell_scalars["volume_ratio"] = Eigen::VectorXd::Ones(3);
    expect_input_error([&] { pbs::write_vtu(folder / "a.vtu", bar.rest, bar.tets, fields); }, folder / "a.vtu",
                       "volume_ratio = 3");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST_F(Writing, TheSameFrameGivesTheSameBytesAndPvdListsFramesInOrderWithAllDigits)
{
    for (const char* name : {"a.vtu", "b.vtu"})
        pbs::write_vtu(folder / name, awkward_bar().rest, awkward_bar().tets, {});
    EXPECT_EQ(pbs::read_text_file(folder / "a.vtu"), pbs::read_text_file(folder / "b.vtu"));
    pbs::write_pvd(folder / "pbs.pvd", {{0.0, "frames/pbs_000000.vtu"}, {1.0 / 3.0, "frames/pbs_000001.vtu"}});
    const std::string text = pbs::read_text_file(folder / "pbs.pvd");
    EXPECT_NE(text.find("timestep=\"0.33333333333333331\" part=\"0\" file=\"frames/pbs_000001.vtu\""),
              std::string::npos)
        << text;
    EXPECT_LT(text.find("pbs_000000"), text.find("pbs_000001"));
}

// Reference: the unit tet in formats whose names do not fit their content. Known vertices that no tet uses, and parts
// that touch.

using test_support::unit_tet;

const std::string legacy_vtk =
    "# vtk DataFile Version 3.0\ntet\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0 1 0 0 0 1 0 0 0 "
    "1\nCELLS 1 5\n4 0 1 2 3\n"
    "CELL_TYPES 1\n10\n";
TEST_F(ReadByContent, BothFormatsOfVtkUnderEitherName)
{
    pbs::write_tet_mesh(folder / "a.vtu", unit_tet());
    std::filesystem::copy_file(folder / "a.vtu", folder / "xml.vtk");
    for (const std::string& path : {folder / "xml.vtk", folder.file("legacy.vtu", legacy_vtk),
                                    folder.file("legacy.vtk", legacy_vtk), folder.file("legacy", legacy_vtk)})
        EXPECT_EQ(pbs::read_tet_mesh(path).mesh.rest, unit_tet().rest) << path;
}

TEST_F(ReadByContent, GmshAndMeditUnderAnotherNameWithARemark)
{
    for (const auto& [extension, name] :
         {std::pair{".msh", "gmsh.vtk"}, {".msh", "gmsh.mesh"}, {".mesh", "medit.txt"}, {".mesh", "medit"}}) {
        pbs::write_tet_mesh(folder / (std::string("a") + extension), unit_tet());
        const std::string path = folder / name;
        std::filesystem::rename(folder / (std::string("a") + extension), path);
        const pbs::MeshReading reading = pbs::read_tet_mesh(path);
        EXPECT_EQ(reading.mesh.rest, unit_tet().rest) << path;
        EXPECT_EQ(reading.read_as, extension) << path;
        EXPECT_EQ(pbs::remarks_on(path, reading), std::vector{path + ": format of the content = " + extension +
                                                              ": read as such, whatever the file is called"});
    }
}

TEST_F(ReadTetMesh, LeavesOutUnusedVerticesWithARemark)
{
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
TEST_F(ReadTetMesh, ListsTheUnusedNodesOfGmshAndMeditFiles)
{
    const std::string nodes = "5\n1 0 0 0\n2 1 0 0\n3 9 9 9\n4 0 1 0\n5 0 0 1\n";
    const std::string version_2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + nodes +
                                  "$EndNodes\n$Elements\n1\n1 4 2 0 1 1 2 4 5\n$EndElements\n";
    const std::string version_1 = "$NOD\n" + nodes + "$ENDNOD\n$ELM\n1\n1 4 1 1 4 1 2 4 5\n$ENDELM\n";
    const std::string medit =
        "MeshVersionFormatted 2\nDimension 3\nVertices\n5\n0 0 0 1\n1 0 0 1\n9 9 9 1\n0 1 0 1\n0 0 1 1\n"
        "Tetrahedra\n1\n1 2 4 5 1\nEnd\n";
    for (const std::string& path : {folder.file("2.msh", version_2), folder.file("2.txt", version_2),
                                    folder.file("1.msh", version_1), folder.file("a.mesh", medit)}) {
        const pbs::MeshReading reading = pbs::read_tet_mesh(path);
        EXPECT_EQ(reading.mesh.rest, unit_tet().rest) << path;
        EXPECT_EQ(reading.file_vertex, (std::vector<int>{0, 1, 3, 4})) << path;
        EXPECT_EQ(reading.unused_vertices, std::vector<int>{2}) << path;
    }
}

TEST_F(ReadTetMesh, SplitsAVertexAtWhichPartsTouchWithARemark)
{
    const std::string path = folder.file(
        "a.tobj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv -1 0 0\nv 0 -1 0\nv 0 0 -1\nt 0 1 2 3\nt 0 4 6 5\n");
    const pbs::MeshReading reading = pbs::read_tet_mesh(path);
    EXPECT_EQ(reading.mesh.rest.rows(), 8);
    EXPECT_EQ(reading.split_vertices, std::vector<int>{0});
    EXPECT_EQ(std::count(reading.file_vertex.begin(), reading.file_vertex.end(), 0), 2);
    const std::vector<std::string> remarks = pbs::remarks_on(path, reading);
    ASSERT_EQ(remarks.size(), 2u);
    EXPECT_EQ(remarks[0], path + ": vertices at which parts touch = 1 (0): split, so that each part has its own");
    EXPECT_EQ(remarks[1], path + ": parts = 2: kept; no face joins them");
}

TEST_F(ReadTetMesh, OfAMillimetreOrAHundredMetresNeedsNoRemarkAboutItsSize)
{
    const auto remarks_at = [&](const std::string& edge) {
        const std::string path =
            folder.file("a.tobj", "v 0 0 0\nv " + edge + " 0 0\nv 0 " + edge + " 0\nv 0 0 " + edge + "\nt 0 1 2 3\n");
        return pbs::remarks_on(path, pbs::read_tet_mesh(path)).size();
    };
    for (const char* edge : {"0.001", "1", "100"}) EXPECT_EQ(remarks_at(edge), 0u) << edge;
    for (const char* edge : {"0.0009", "101"}) EXPECT_EQ(remarks_at(edge), 1u) << edge;
}

// Reference: HOBAK's format by hand: lines "v x y z" and "t a b c d", vertices counted from 0.

TEST_F(Tobj, HasVerticesAndTetsAndMayHaveCommentsTrianglesWindowsLineEndsAndExponents)
{
    const pbs::MeshReading reading =
        pbs::read_tet_mesh(folder.file("a.tobj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nt 0 1 2 3\n"));
    EXPECT_EQ(reading.mesh.rest, test_support::unit_tet().rest);
    EXPECT_EQ(reading.mesh.tets, test_support::unit_tet().tets);
    const std::string text = "# a tet\r\nv 0 0 0\r\nv 1e0 0 0\r\n\r\nv 0 1 0\r\nt 0 1 2 3\r\nf 1 2 3\r\nv 0 0 1\r\n";
    EXPECT_EQ(pbs::read_tet_mesh(folder.file("a.TOBJ", text)).mesh.rest, test_support::unit_tet().rest);
}

}  // namespace
