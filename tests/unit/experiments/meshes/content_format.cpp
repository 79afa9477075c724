// Reference: the first bytes by which each format is defined, and one body written in each of them.

#include "experiments/meshes/content_format.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "experiments/rigs/surface_reader.hpp"
#include "tests/support/arm_in_formats.hpp"
#include "tests/support/gltf_document.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace {

using ContentFormat = test_support::FolderTest;
using test_support::ScratchFolder;

const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string off = "# a triangle\nOFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string obj = "# a triangle\n\nmtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string stl =
    "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid "
    "x\n";

// One triangle. Some programs begin the header of a binary file with the word of a text file.
std::string binary_stl()
{
    const float numbers[12] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::uint32_t triangles = 1;
    std::string bytes = "solid by some program" + std::string(80 - 21, ' ');
    bytes.append(reinterpret_cast<const char*>(&triangles), sizeof triangles);
    bytes.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
    return bytes + std::string(2, '\0');
}

TEST_F(ContentFormat, IsThatOfTheFirstBytesWhateverTheName)
{
    const auto content = [&](const std::string& text) { return pbs::content_extension(folder.file("a.step", text)); };
    EXPECT_EQ(content("glTF\x02"), ".glb");
    EXPECT_EQ(content(" \n{\"asset\": {}}"), ".gltf");
    EXPECT_EQ(content("Kaydara FBX Binary  \x1a"), ".fbx");
    EXPECT_EQ(content("; FBX 7.3.0 project file\n"), ".fbx");
    EXPECT_EQ(content("<?xml version=\"1.0\"?>\n<COLLADA>"), ".dae");
    EXPECT_EQ(content("PK\x03\x04"), ".zae");
    EXPECT_EQ(content("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\">"), ".vtp");
    EXPECT_EQ(content("# vtk DataFile Version 5.1\nf 1 2\nASCII\nDATASET POLYDATA\n"), ".vtp");
    EXPECT_EQ(content("# vtk DataFile Version 5.1\nf 1 2\nASCII\nDATASET UNSTRUCTURED_GRID\n"), "");
    EXPECT_EQ(content(ply), ".ply");
    EXPECT_EQ(content(off), ".off");
    EXPECT_EQ(content("COFF\n"), ".off");
    EXPECT_EQ(content(obj), ".obj");
    EXPECT_EQ(content(stl), ".stl");
    EXPECT_EQ(content(binary_stl()), ".stl");
    EXPECT_EQ(content("$MeshFormat\n2.2 0 8\n"), ".msh");
    EXPECT_EQ(content("$NOD\n"), ".msh");
    EXPECT_EQ(content("# by hand\nMeshVersionFormatted 2\n"), ".mesh");
}

TEST_F(ContentFormat, OfOtherContentIsThatOfTheNameWhichElseGetsItsExtension)
{
    for (const char* text :
         {"", "ISO-10303-21;", "solid rock\n", "plywood\n", "SCOFFS\n", "v\n", "# only a comment\n"}) {
        const std::string path = folder.file("A.STL", text);
        EXPECT_EQ(pbs::content_extension(path), "") << text;
        EXPECT_EQ(pbs::format_extension(path), ".stl") << text;
        EXPECT_EQ(pbs::path_by_content(path), path) << text;
    }
    EXPECT_EQ(pbs::content_extension(folder / "none.ply"), "");
    EXPECT_EQ(pbs::format_extension(folder / "none.ply"), ".ply");
    const std::string path = folder.file("a.obj", ply);
    EXPECT_EQ(pbs::path_by_content(path), path + ".ply");
}

// The surfaces of the body under its own name and under each of the others.
void expect_read_under_any_name(const std::string& own_extension, const std::string& text)
{
    const ScratchFolder folder;
    const pbs::SurfaceMesh expected = pbs::read_surface(folder.file("own" + own_extension, text));
    for (const char* extension :
         {".obj", ".ply", ".off", ".stl", ".gltf", ".glb", ".dae", ".zae", ".fbx", ".step", ".vtk", ""}) {
        const std::string path = folder.file(std::string("arm") + extension, text);
        std::vector<std::string> remarks;
        const pbs::SurfaceMesh surface = pbs::read_surface(path, remarks);
        EXPECT_EQ(surface.points, expected.points) << path;
        EXPECT_EQ(surface.triangles, expected.triangles) << path;
        const std::string remark =
            path + ": format of the content = " + own_extension + ": read as such, whatever the file is called";
        EXPECT_EQ(std::count(remarks.begin(), remarks.end(), remark), extension == own_extension ? 0 : 1) << path;
    }
}

TEST_F(ContentFormat, ChoosesTheReaderOfASurface)
{
    expect_read_under_any_name(".obj", obj);
    expect_read_under_any_name(".dae", test_support::collada_arm());
    expect_read_under_any_name(".fbx", test_support::fbx_arm());
#ifdef PBS_WITH_CGAL
    expect_read_under_any_name(".ply", ply);
    expect_read_under_any_name(".off", off);
    expect_read_under_any_name(".stl", stl);
    expect_read_under_any_name(".stl", binary_stl());
#endif
}

// The numbers of this .gltf file are in another file in its folder.
TEST_F(ContentFormat, AGltfUnderAnotherNameFindsItsNumbers)
{
    const std::string own = test_support::write_rigged_gltf(folder, "arm.gltf", {});
    const pbs::SurfaceMesh expected = pbs::read_surface(own);
    std::filesystem::rename(own, folder / "arm.fbx");
    EXPECT_EQ(pbs::read_surface(folder / "arm.fbx").points, expected.points);
}

// Reference: the interface. A file may refer to regular files in and below its own folder.

class OwnFolderTest : public testing::Test {
protected:
    void SetUp() override
    {
        std::filesystem::create_directories(scratch.path() / "own" / "deeper");
        std::filesystem::create_directories(scratch.path() / "own2");
        for (const char* name :
             {"own/a.gltf", "own/beside.bin", "own/deeper/below.bin", "own2/similar.bin", "above.bin"})
            scratch.file(name, "x");
    }
    bool may_open(const std::string& file) const
    {
        return pbs::may_be_opened_for(scratch / "own/a.gltf", scratch / file);
    }

    const test_support::ScratchFolder scratch;
};

TEST_F(OwnFolderTest, AllowsTheFileItselfAndRegularFilesBesideAndBelow)
{
    std::filesystem::create_symlink(scratch / "above.bin", scratch / "own/out.bin");
    std::filesystem::create_symlink(scratch / "own/deeper/below.bin", scratch / "own/in.bin");
    ASSERT_EQ(mkfifo((scratch / "own/pipe").c_str(), 0600), 0);
    for (const char* file : {"own/a.gltf", "own/beside.bin", "own/deeper/below.bin", "own/deeper/../beside.bin",
                             "own/./beside.bin", "own/in.bin"})
        EXPECT_TRUE(may_open(file)) << file;
    for (const char* file :
         {"above.bin", "own/../above.bin", "own2/similar.bin", "own/none.bin", "own/deeper", "own/out.bin", "own/pipe"})
        EXPECT_FALSE(may_open(file)) << file;
    for (const char* file : {"/etc/passwd", ""})
        EXPECT_FALSE(pbs::may_be_opened_for(scratch / "own/a.gltf", file)) << file;
}

TEST_F(OwnFolderTest, AllowsWhatLiesBesideTheFileOrBesideALinkToIt)
{
    std::filesystem::create_symlink(scratch / "own/a.gltf", scratch / "own2/link.gltf");
    EXPECT_TRUE(pbs::may_be_opened_for(scratch / "own2/link.gltf", scratch / "own/beside.bin"));
    EXPECT_TRUE(pbs::may_be_opened_for(scratch / "own2/link.gltf", scratch / "own2/similar.bin"));
    EXPECT_FALSE(pbs::may_be_opened_for(scratch / "own2/link.gltf", scratch / "above.bin"));
}

}  // namespace
