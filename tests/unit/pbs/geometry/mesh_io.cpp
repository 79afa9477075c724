// Reference: a mesh that is written is read back to the bit, and files written by hand give the numbers in them.
#include "pbs/geometry/mesh_io.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>

namespace {

using test_support::ScratchFolder;

// A bar whose coordinates have all digits, some of them tiny and some huge.
pbs::TetMesh awkward_bar()
{
    pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {3, 2, 2});
    for (Eigen::Index i = 0; i < bar.rest.rows(); ++i)
        bar.rest.row(i) += 0.01 * pbs::Vec3(std::sin(i), std::cos(3.0 * double(i)), std::sin(7.0 * double(i))).transpose();
    bar.rest(0, 0) = 1e-17 / 3.0;
    bar.rest(1, 1) = -std::numeric_limits<double>::denorm_min();
    return bar;
}

std::string content(const std::string& path)
{
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class TetFormats : public ::testing::TestWithParam<const char*> {};

TEST_P(TetFormats, AreReadBackToTheBit)
{
    const ScratchFolder folder;
    const std::string path = folder / (std::string("bar") + GetParam());
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
    const ScratchFolder folder;
    const std::string path = folder / (std::string("bar") + GetParam());
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

TEST(Frames, MayBeInvertedAndFlat)
{
    const ScratchFolder folder;
    pbs::TetMesh bar = awkward_bar();
    bar.rest.col(2) *= 0.0;
    pbs::write_tet_mesh(folder / "flat.vtu", bar);
    EXPECT_EQ(pbs::read_tet_frame(folder / "flat.vtu").rest, bar.rest);
    EXPECT_THROW(pbs::read_tet_mesh(folder / "flat.vtu"), pbs::InputError);
}

TEST(Writing, IntoAMissingFolderIsRefusedAndNamesTheFile)
{
    for (const char* name : {"/no/such/folder/a.msh", "/no/such/folder/a.vtu", "/no/such/folder/a.mesh"}) {
        try {
            pbs::write_tet_mesh(name, awkward_bar());
            FAIL() << name;
        } catch (const pbs::InputError& error) {
            EXPECT_EQ(std::string(error.what()).rfind(name, 0), 0u) << error.what();
        }
    }
    EXPECT_THROW(pbs::write_pvd("/no/such/folder/a.pvd", {}), pbs::InputError);
}

TEST(Writing, UnknownExtensionsAreRefused)
{
    EXPECT_THROW(pbs::write_tet_mesh("bar.stl", awkward_bar()), pbs::InputError);
}

TEST(Writing, FieldsOfTheWrongLengthAreRefusedByName)
{
    const ScratchFolder folder;
    const pbs::TetMesh bar = awkward_bar();
    pbs::FrameFields fields;
    fields.cell_scalars["volume_ratio"] = Eigen::VectorXd::Ones(3);
    try {
        pbs::write_vtu(folder / "a.vtu", bar.rest, bar.tets, fields);
        FAIL();
    } catch (const pbs::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("volume_ratio = 3"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Writing, TheSameFrameGivesTheSameBytes)
{
    const ScratchFolder folder;
    for (const char* name : {"a.vtu", "b.vtu"}) pbs::write_vtu(folder / name, awkward_bar().rest, awkward_bar().tets, {});
    EXPECT_EQ(content(folder / "a.vtu"), content(folder / "b.vtu"));
}

TEST(Writing, PvdListsFramesInOrderWithAllDigits)
{
    const ScratchFolder folder;
    pbs::write_pvd(folder / "pbs.pvd", {{0.0, "frames/pbs_000000.vtu"}, {1.0 / 3.0, "frames/pbs_000001.vtu"}});
    const std::string text = content(folder / "pbs.pvd");
    EXPECT_NE(text.find("timestep=\"0.33333333333333331\" part=\"0\" file=\"frames/pbs_000001.vtu\""), std::string::npos) << text;
    EXPECT_LT(text.find("pbs_000000"), text.find("pbs_000001"));
}

}  // namespace
