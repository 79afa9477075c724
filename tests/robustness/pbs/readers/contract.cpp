// Reference: the interface. Whatever the error in a file, the answer of each reader is an InputError that names the file, in seconds; it
// prints nothing and leaves nothing behind.
#include "tests/support/file_readers.hpp"

#include "pbs/character/clip.hpp"
#include "pbs/character/skeleton_file.hpp"
#include "pbs/character/skinning_weights.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/mesh_io.hpp"
#include "pbs/rig/rig_reader.hpp"
#include "tests/support/arm_in_formats.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/gltf_document.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/structured_bar.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <locale>
#include <random>
#include <regex>

namespace readers {
namespace {

using test_support::ScratchFolder;

std::string counts(Eigen::Index points, Eigen::Index cells)
{
    return std::to_string(points) + " points, " + std::to_string(cells) + " cells";
}

std::string read_tets(const std::string& path)
{
    const pbs::TetMesh mesh = pbs::read_tet_mesh(path).mesh;
    return counts(mesh.rest.rows(), mesh.tets.rows());
}

std::string read_surface(const std::string& path)
{
    const pbs::SurfaceMesh surface = pbs::read_surface(path);
    return counts(surface.points.rows(), surface.triangles.rows());
}

std::string read_rig(const std::string& path)
{
    const pbs::RigMesh mesh = pbs::read_rig(path).meshes.at(0);
    return counts(mesh.points.rows(), mesh.triangles.rows());
}

std::string read_clip(const std::string& path)
{
    return std::to_string(pbs::read_clip(path).frames()) + " frames";
}

std::string read_skeleton(const std::string& path)
{
    return std::to_string(pbs::parse_skeleton(pbs::read_text_file(path, pbs::most_settings_bytes), path).bones.size()) + " bones";
}

std::string read_weights(const std::string& path)
{
    const pbs::Skeleton skeleton{{{"upper", -1, {-1, 0, 0}, {0, 0, 0}}, {"forearm", 0, {0, 0, 0}, {1, 0, 0}}}};
    return std::to_string(pbs::parse_weights(pbs::read_text_file(path), path, skeleton, 2).vertices()) + " vertices";
}

// A bar as this program writes it.
std::string written(const std::string& extension)
{
    const ScratchFolder folder;
    pbs::write_tet_mesh(folder / ("bar" + extension), test_support::structured_bar({-1, -1, -1}, {1, 1, 1}, {3, 3, 3}));
    return pbs::read_text_file(folder / ("bar" + extension));
}

const std::string points = "0 0 0\n{x=1} 0 0\n0 1 0\n0 0 1\n", faces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 {corner=2}\n";
const std::string msh =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{count=4}\n1 0 0 0\n2 {x=1} 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
    "$Elements\n1\n1 4 2 0 1 1 2 3 {corner=4}\n$EndElements\n";
const std::string medit =
    "MeshVersionFormatted 2\nDimension 3\nVertices\n{count=4}\n0 0 0 1\n{x=1} 0 0 1\n0 1 0 1\n0 0 1 1\nTetrahedra\n1\n1 2 3 {corner=4} "
    "1\nEnd\n";
const std::string vtk = "# vtk DataFile Version 3.0\ntet\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {count=4} double\n" + points +
                        "CELLS 1 5\n4 0 1 2 {corner=3}\nCELL_TYPES 1\n10\n";
const std::string node = "{count=4} 3 0 0\n0 0 0 0\n1 {x=1} 0 0\n2 0 1 0\n3 0 0 1\n", ele = "1 4 0\n0 0 1 2 {corner=3}\n";
const std::string tobj = "v 0 0 0\nv {x=1} 0 0\nv 0 1 0\nv 0 0 1\nt 0 1 2 {corner=3}\n";
const std::string obj = "v 0 0 0\nv {x=1} 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
    "property list uchar int vertex_indices\nend_header\n" +
    points + faces;
const std::string off = "OFF\n4 4 0\n" + points + faces;
const std::string stl =
    "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex {x=1} 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
const std::string bvh =
    "HIERARCHY\nROOT upper\n{\n OFFSET 0 0 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n JOINT forearm\n"
    " {\n  OFFSET 2 0 0\n  CHANNELS 3 Zrotation Yrotation Xrotation\n  End Site\n  {\n   OFFSET 1 0 0\n  }\n }\n}\n"
    "MOTION\nFrames: 2\nFrame Time: 0.01\n0 0 0 0 0 0 10 20 30\n0 0 0 0 0 0 10 20 30\n";
const std::string skeleton =
    "[[joint]]\nname = \"root\"\nparent = \"\"\nhead_m = [0, 0, 0]\ntail_m = [0.5, 0, 0]\n"
    "[[joint]]\nname = \"child\"\nparent = \"root\"\nhead_m = [0.5, 0, 0]\ntail_m = [1, 0, 0]\n";

std::string noise(std::size_t bytes)
{
    std::mt19937 random(7);
    std::string text(bytes, ' ');
    for (char& c : text) c = static_cast<char>(random());
    return text;
}

long entries_of(const std::filesystem::path& folder)
{
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
}

}  // namespace

const std::vector<Reader>& all_readers()
{
    static const std::vector<Reader> readers = {
        {"gmsh", "a.msh", msh, read_tets},
        {"medit", "a.mesh", medit, read_tets},
        {"vtk", "a.vtk", vtk, read_tets},
        {"written_msh", "a.msh", written(".msh"), read_tets},
        {"written_mesh", "a.mesh", written(".mesh"), read_tets},
        {"written_vtu", "a.vtu", written(".vtu"), read_tets},
        {"tetgen_tets", "a.ele", ele, read_tets, "a.node", node},
        {"tetgen_points", "a.node", node, read_tets, "a.ele", ele},
        {.name = "tobj", .file = "a.tobj", .text = tobj, .read = read_tets, .has_an_end = false},
        {.name = "obj", .file = "a.obj", .text = obj, .read = read_surface, .has_an_end = false},
#ifdef PBS_WITH_CGAL
        {"ply", "a.ply", ply, read_surface},
        {"off", "a.off", off, read_surface},
        {"stl", "a.stl", stl, read_surface},
#endif
        {"gltf_surface", "a.gltf", test_support::two_joint_document().text(), read_surface},
        {"collada_surface", "a.dae", test_support::collada_arm(), read_surface},
        {"fbx_surface", "a.fbx", test_support::fbx_arm(), read_surface},
        {"gltf", "a.gltf", test_support::two_joint_document().text(), read_rig},
        {"collada", "a.dae", test_support::collada_arm(), read_rig},
        {"fbx", "a.fbx", test_support::fbx_arm(), read_rig},
        {"bvh", "a.bvh", bvh, read_clip},
        {.name = "skeleton", .file = "a.toml", .text = skeleton, .read = read_skeleton, .has_an_end = false},
        {"weights", "a.csv", "vertex,joint,weight\n0,upper,1\n1,upper,0.25\n1,forearm,0.75\n", read_weights},
    };
    return readers;
}

const Reader& reader_named(const std::string& name)
{
    return *std::ranges::find(all_readers(), name, &Reader::name);
}

std::string sound(const std::string& text)
{
    return with_number(text, "none", "");
}

std::string with_number(const std::string& text, const std::string& place, const std::string& number)
{
    static const std::regex any(R"(\{(x|corner|count)=(\d)\})");
    const std::string changed = std::regex_replace(text, std::regex("\\{" + place + R"(=\d\})"), number);
    return std::regex_replace(changed, any, "$2");
}

std::string replaced(std::string text, const std::string& what, const std::string& by)
{
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

std::string answer_of(const Reader& reader, const std::string& path)
{
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    const long entries = entries_of(folder);
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const auto begin = std::chrono::steady_clock::now();
    std::string read;
    const std::string refusal = test_support::refusal_of([&] { read = reader.read(path); });
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5)) << path;
    EXPECT_EQ(testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr(), "") << path;
    EXPECT_EQ(entries_of(folder), entries) << path;
    if (refusal == "accepted") return "read: " + read;
    EXPECT_TRUE(refusal.starts_with(path.substr(0, path.find_last_of('.')))) << path << ": " << refusal;
    return refusal;
}

namespace {

class ReaderContract : public testing::TestWithParam<Reader> {
protected:
    ReaderContract()
    {
        if (!GetParam().beside.empty()) folder.file(GetParam().beside, sound(GetParam().text_beside));
    }
    std::string answer_to(const std::string& content) const { return answer_of(GetParam(), folder.file(GetParam().file, content)); }
    void expect_refused(const std::string& content) const
    {
        const std::string answer = answer_to(content);
        EXPECT_FALSE(answer.starts_with("read: ")) << answer;
    }

    const ScratchFolder folder;
    const std::string whole = sound(GetParam().text);
};

class ReaderOfWholeFiles : public ReaderContract {};  // a part of any other file is another file
class ReaderOfNumbers : public ReaderContract {};     // the bad numbers of the others are in bad_files.cpp

template <typename IsWanted>
std::vector<Reader> readers_that(IsWanted is_wanted)
{
    std::vector<Reader> readers = all_readers();
    std::erase_if(readers, [&](const Reader& reader) { return !is_wanted(reader); });
    return readers;
}

std::string name_in_suite(const testing::TestParamInfo<Reader>& info)
{
    return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Readers, ReaderContract, testing::ValuesIn(all_readers()), name_in_suite);
INSTANTIATE_TEST_SUITE_P(Readers, ReaderOfWholeFiles, testing::ValuesIn(readers_that(std::mem_fn(&Reader::has_an_end))), name_in_suite);
INSTANTIATE_TEST_SUITE_P(Readers, ReaderOfNumbers,
                         testing::ValuesIn(readers_that([](const Reader& of) { return of.text.find("{x=") != std::string::npos; })),
                         name_in_suite);

TEST_P(ReaderContract, ReadsTheSoundFile)  // shows that each refusal below is due to its defect
{
    EXPECT_TRUE(answer_to(whole).starts_with("read: ")) << answer_to(whole);
}

TEST_P(ReaderContract, RefusesWhatIsNoFile)
{
    const std::string path = folder / GetParam().file;
    EXPECT_FALSE(answer_of(GetParam(), path).starts_with("read: ")) << "missing";
    std::filesystem::create_directory(path);
    EXPECT_NE(answer_of(GetParam(), path).find("expected a file"), std::string::npos) << "a folder";
    std::filesystem::remove(path);
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    EXPECT_NE(answer_of(GetParam(), path).find("expected a file"), std::string::npos) << "a pipe, which would be waited for without end";
}

TEST_P(ReaderContract, RefusesNothingNoiseAndWords)
{
    for (const std::string& content : {std::string(), noise(500), noise(4096), std::string("these are words and no numbers\n")})
        expect_refused(content);
}

TEST_P(ReaderOfWholeFiles, RefusesAFileThatEndsEarlyOrReadsItWhole)
{
    const auto cut = [&](double share) { return whole.substr(0, std::size_t(share * double(whole.size()))); };
    const std::string answer = answer_to(whole);
    for (const double share : {0.1, 0.3, 0.5}) expect_refused(cut(share));
    for (const double share : {0.6, 0.7, 0.8, 0.9, 0.96, 0.98})
        if (const std::string of_part = answer_to(cut(share)); of_part.starts_with("read: ")) {
            EXPECT_EQ(of_part, answer) << share;
        }
}

TEST_P(ReaderContract, ReadsADamagedByteOrRefusesItByName)
{
    for (std::size_t at = 7; at < whole.size(); at += std::max<std::size_t>(whole.size() / 24, 1)) {
        std::string content = whole;
        content[at] = '\x7f';
        answer_to(content);
    }
}

TEST_P(ReaderOfNumbers, RefusesNumbersThatCannotBe)
{
    for (const auto& [place, numbers] : {std::pair<std::string, std::vector<std::string>>{"x", {"nan", "inf", "1e999", "abc"}},
                                         {"corner", {"9", "-1", "99999999999"}},
                                         {"count", {"5", "-4", "4000000000"}}})
        for (const std::string& number : numbers)
            if (GetParam().text.find("{" + place + "=") != std::string::npos) expect_refused(with_number(GetParam().text, place, number));
}

// Reading and writing files does not depend on the locale of the program that uses the library. Reference: the bytes that are written
// with the classic locale.

// 1.234,5 as in German
struct Commas : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

// More than 999 points and tets, so that a thousands separator would be visible.
pbs::TetMesh long_chain()
{
    constexpr int layers = 1200;
    pbs::TetMesh mesh{pbs::Positions(layers + 3, 3), pbs::Tets(layers, 4)};
    for (int v = 0; v < layers + 3; ++v) mesh.rest.row(v) << std::cos(2.0 * v), std::sin(2.0 * v), 0.3 * v;
    for (int t = 0; t < layers; ++t) mesh.tets.row(t) << t, t + 1, t + 2, t + 3;
    return mesh;
}

class DecimalComma : public test_support::FolderTest {
protected:
    ~DecimalComma() override { std::locale::global(before_); }

private:
    std::locale before_ = std::locale();
};

TEST_F(DecimalComma, WritesTheSameBytesAndReadsTheSamePoints)
{
    const pbs::TetMesh mesh = long_chain();
    for (const std::string ending : {".msh", ".mesh", ".vtu"}) {
        std::locale::global(std::locale::classic());
        pbs::write_tet_mesh(folder / ("classic" + ending), mesh);
        std::locale::global(std::locale(std::locale::classic(), new Commas));
        pbs::write_tet_mesh(folder / ("commas" + ending), mesh);
        EXPECT_EQ(pbs::read_text_file(folder / ("commas" + ending)), pbs::read_text_file(folder / ("classic" + ending))) << ending;
        EXPECT_EQ(pbs::read_tet_frame(folder / ("classic" + ending)).rest, mesh.rest) << ending;
    }
    pbs::write_pvd(folder / "commas.pvd", {{1234.5, "a.vtu"}});
    EXPECT_NE(pbs::read_text_file(folder / "commas.pvd").find("timestep=\"1234.5\""), std::string::npos);
}

}  // namespace
}  // namespace readers
