// Reference: the interface. Whatever the error in a file, the answer is an InputError that names it, within a second, and nothing is
// printed.
#include "pbs/geometry/mesh_io.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>

namespace {

using test_support::ScratchFolder;

void expect_refused(
    const std::string& path, const std::string& words = "",
    const std::function<void(const std::string&)>& read = [](const std::string& p) { pbs::read_tet_mesh(p); })
{
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const auto begin = std::chrono::steady_clock::now();
    std::string what = "accepted";
    try {
        read(path);
    } catch (const pbs::InputError& error) {
        what = error.what();
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    EXPECT_EQ(testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr(), "") << path;
    EXPECT_EQ(what.rfind(path.substr(0, path.find_last_of('.')), 0), 0u) << path << ": " << what;
    EXPECT_NE(what.find(words), std::string::npos) << path << ": " << what;
    EXPECT_LT(seconds, 5.0) << path;  // takes a second on an idle machine
}

void expect_surface_refused(const std::string& path)
{
    expect_refused(path, "", [](const std::string& p) { pbs::read_surface(p); });
}

void expect_surface_read([[maybe_unused]] const std::string& path)
{
#ifdef PBS_WITH_CGAL  // CGAL reads .ply, .off and .stl
    EXPECT_NO_THROW(pbs::read_surface(path)) << path;
#endif
}

std::string content(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string replaced(std::string text, const std::string& what, const std::string& by)
{
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

std::string noise(std::size_t size)
{
    std::mt19937 random(7);
    std::string bytes(size, ' ');
    for (char& c : bytes) c = static_cast<char>(random());
    return bytes;
}

// One tet in three text formats, each with a place for a defect.
const std::string msh =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
    "$Elements\n1\n1 4 2 0 1 1 2 3 4\n$EndElements\n";
const std::string medit =
    "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 1\n1 0 0 1\n0 1 0 1\n0 0 1 1\nTetrahedra\n1\n1 2 3 4 1\nEnd\n";
const std::string vtk =
    "# vtk DataFile Version 3.0\ntet\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
    "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n";

class TetFormat : public ::testing::TestWithParam<const char*> {};

TEST_P(TetFormat, EmptyMissingNoiseFolderAndTruncated)
{
    const ScratchFolder folder;
    const std::string extension = GetParam();
    expect_refused(folder / ("missing" + extension), "no such file");
    expect_refused(folder.file("empty" + extension, ""), "empty");
    expect_refused(folder.file("noise" + extension, noise(2000)));
    expect_refused(folder.file("words" + extension, "these are words, not a mesh\n"));
    std::filesystem::create_directory(folder.path() / ("folder" + extension));
    expect_refused(folder / ("folder" + extension), "expected a file");

    const std::string whole = folder / ("whole" + extension);
    pbs::write_tet_mesh(whole, test_support::structured_bar({-1, -1, -1}, {1, 1, 1}, {3, 3, 3}));
    const std::string text = content(whole);
    for (const double part : {0.1, 0.3, 0.5, 0.7, 0.9})
        expect_refused(folder.file("truncated" + extension, text.substr(0, static_cast<std::size_t>(part * double(text.size())))));
}

INSTANTIATE_TEST_SUITE_P(Damaged, TetFormat, ::testing::Values(".msh", ".vtu", ".mesh"));

TEST(DamagedMesh, TheSoundOnesAreRead)  // shows that each refusal below is due to its defect
{
    const ScratchFolder folder;
    EXPECT_NO_THROW(pbs::read_tet_mesh(folder.file("a.msh", msh)));
    EXPECT_NO_THROW(pbs::read_tet_mesh(folder.file("a.mesh", medit)));
    EXPECT_NO_THROW(pbs::read_tet_mesh(folder.file("a.vtk", vtk)));
}

TEST(DamagedMesh, CoordinatesThatAreNotNumbers)
{
    const ScratchFolder folder;
    for (const char* bad : {"nan", "inf", "1e999", "abc"}) {
        expect_refused(folder.file("a.msh", replaced(msh, "2 1 0 0", std::string("2 ") + bad + " 0 0")));
        expect_refused(folder.file("a.mesh", replaced(medit, "1 0 0 1", std::string(bad) + " 0 0 1")));
        expect_refused(folder.file("a.vtk", replaced(vtk, "\n1 0 0", std::string("\n") + bad + " 0 0")));
    }
}

TEST(DamagedMesh, IndicesOutOfRange)
{
    const ScratchFolder folder;
    for (const char* bad : {"9", "-1", "99999999999"}) {
        expect_refused(folder.file("a.msh", replaced(msh, "1 2 3 4\n$End", std::string("1 2 3 ") + bad + "\n$End")));
        expect_refused(folder.file("a.mesh", replaced(medit, "1 2 3 4 1", std::string("1 2 3 ") + bad + " 1")));
        expect_refused(folder.file("a.vtk", replaced(vtk, "0 1 2 3", std::string("0 1 2 ") + bad)));
    }
}

TEST(DamagedMesh, CountsThatTheFileDoesNotHold)
{
    const ScratchFolder folder;
    for (const char* bad : {"5", "-4", "4000000000"}) {
        expect_refused(folder.file("a.msh", replaced(msh, "$Nodes\n4", std::string("$Nodes\n") + bad)));
        expect_refused(folder.file("a.mesh", replaced(medit, "Vertices\n4", std::string("Vertices\n") + bad)));
        expect_refused(folder.file("a.vtk", replaced(vtk, "POINTS 4", std::string("POINTS ") + bad)));
    }
}

TEST(DamagedMesh, FlatTetAndSurfaceAlone)
{
    const ScratchFolder folder;
    expect_refused(folder.file("a.msh", replaced(msh, "4 0 0 1", "4 1 1 0")), "expected a volume");
    expect_refused(folder.file("a.msh", replaced(msh, "1 4 2 0 1 1 2 3 4", "1 2 2 0 1 1 2 3")), "expected at least one tetrahedron");
    expect_refused(
        folder.file("a.vtk", replaced(replaced(replaced(vtk, "CELLS 1 5", "CELLS 1 4"), "4 0 1 2 3", "3 0 1 2"), "1\n10", "1\n5")),
        "expected at least one tetrahedron");
}

TEST(DamagedMesh, OtherVolumeCellsAreRefusedByName)
{
    const ScratchFolder folder;
    expect_refused(
        folder.file("a.vtk", replaced(replaced(replaced(vtk, "CELLS 1 5", "CELLS 1 6"), "4 0 1 2 3", "5 0 1 2 3 0"), "1\n10", "1\n14")),
        "vtkPyramid");
    expect_refused(folder.file("a.msh", replaced(msh, "1 4 2 0 1 1 2 3 4", "1 7 2 0 1 1 2 3 4 1")), "Pyramid");
}

TEST(DamagedMesh, AScriptNamedAsAMeshIsNotRun)
{
    const ScratchFolder folder;
    const std::string trace = folder / "trace";
    expect_refused(folder.file("a.msh", "SystemCall \"touch " + trace + "\";\n"), "$MeshFormat");
    expect_refused(folder.file("a.mesh", "SystemCall \"touch " + trace + "\";\n"), "MeshVersionFormatted");
    EXPECT_FALSE(std::filesystem::exists(trace));
}

TEST(DamagedMesh, UnknownExtensions)
{
    const ScratchFolder folder;
    expect_refused(folder.file("a.xyz", "0 0 0\n"), "extension = .xyz: expected a tet mesh");
    expect_refused(folder.file("xyz", "0 0 0\n"), "expected a tet mesh");
}

TEST(DamagedMesh, TetGenErrorsNameFileLineFieldAndValue)
{
    const ScratchFolder folder;
    const std::string node = "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n", ele = "1 4 0\n0 0 1 2 3\n";
    const auto read = [&](const std::string& n, const std::string& e, const std::string& words) {
        folder.file("a.node", n);
        expect_refused(folder.file("a.ele", e), words);
    };
    read(node, "1 4 0\n0 0 1 2 4\n", "a.ele:2: tet vertex = 4: expected a whole number from 0 to 3");
    read(node, "1 4 0\n", "a.ele:1: tet: truncated");
    read(node, "1 10 0\n0 0 1 2 3 4 5 6 7 8 9\n", "a.ele:1: nodes per tet");
    read(node, "9999999999 4 0\n", "a.ele:1: #tets");
    read(replaced(node, "1 1 0 0", "1 1 x 0"), ele, "a.node:3: point");
    read(replaced(node, "1 1 0 0", "1 nan 0 0"), ele, "vertex 1 = (nan, 0, 0): expected finite");
    read(replaced(node, "4 3 0 0", "4 2 0 0"), ele, "a.node:1: dimension = 2");
    read(replaced(node, "1 1 0 0", "7 1 0 0"), ele, "a.node:3: point = 7");
    std::filesystem::remove(folder.path() / "a.node");
    expect_refused(folder / "a.ele", "a.node: no such file");
    ASSERT_EQ(mkfifo((folder / "a.node").c_str(), 0600), 0);
    expect_refused(folder / "a.ele", "a.node: expected a file");
}

TEST(DamagedSurface, EmptyMissingNoiseAndTruncated)
{
    const ScratchFolder folder;
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    const std::string off = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    expect_surface_read(folder.file("a.ply", ply));
    expect_surface_read(folder.file("a.off", off));
    for (const char* extension : {".obj", ".ply", ".off", ".stl", ".gltf", ".glb", ".dae", ".zae"}) {
        expect_surface_refused(folder / (std::string("missing") + extension));
        expect_surface_refused(folder.file(std::string("empty") + extension, ""));
        expect_surface_refused(folder.file(std::string("noise") + extension, noise(500)));
    }
    for (const std::size_t cut : {5u, 20u, 60u}) {
        expect_surface_refused(folder.file("cut.ply", ply.substr(0, ply.size() - cut)));
        expect_surface_refused(folder.file("cut.off", off.substr(0, std::max<std::size_t>(off.size() - cut, 9))));
    }
    const std::string stl =
        "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
    expect_surface_read(folder.file("a.stl", stl));
    for (const std::size_t cut : {30u, 50u}) expect_surface_refused(folder.file("cut.stl", stl.substr(0, stl.size() - cut)));
    expect_surface_refused(folder.file("a.ply", replaced(ply, "3 1 2 3", "3 1 2 9")));
    expect_surface_refused(folder.file("a.off", replaced(off, "1 0 0", "nan 0 0")));
    expect_surface_read(folder.file("a.txt", off));  // by its content
    expect_surface_refused(folder.file("b.txt", "4 vertices and 4 triangles\n"));
}

}  // namespace
