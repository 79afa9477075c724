// Reference: the interface. Whatever the error in a file, the answer of each reader is an InputError that names the
// file, in seconds; it prints nothing and leaves nothing behind.
#include "tests/support/file_readers.hpp"

#include "experiments/characters/skeleton_file.hpp"
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/clips/clip.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "experiments/rigs/rigged_body.hpp"
#include "experiments/rigs/surface_reader.hpp"
#include "pbs/system/files.hpp"
#include "tests/support/arm_in_formats.hpp"
#include "tests/support/gltf_document.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scratch_folder.hpp"
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
#include <set>
#include <tuple>

namespace readers {
namespace {

using test_support::ScratchFolder;

// A sum that another number or another order changes.
template <typename Numbers>
std::string sum_of(const Numbers& numbers)
{
    double sum = 0.0;
    for (Eigen::Index i = 0; i < numbers.size(); ++i) sum += std::sqrt(2.0 + double(i)) * double(numbers.reshaped()(i));
    return ", sum " + pbs::number_text(sum, 12);
}

template <typename Cells>
std::string content_of(const pbs::Positions& points, const Cells& cells)
{
    return std::to_string(points.rows()) + " points, " + std::to_string(cells.rows()) + " cells" + sum_of(points) +
           sum_of(cells);
}

std::string read_tets(const std::string& path)
{
    const pbs::TetMesh mesh = pbs::read_tet_mesh(path).mesh;
    return content_of(mesh.rest, mesh.tets);
}

std::string read_frame(const std::string& path)
{
    const pbs::TetMesh mesh = pbs::read_tet_frame(path);
    return content_of(mesh.rest, mesh.tets);
}

std::string read_surface(const std::string& path)
{
    const pbs::SurfaceMesh surface = pbs::read_surface(path);
    return content_of(surface.points, surface.triangles);
}

std::string read_rig(const std::string& path)
{
    const pbs::Rig rig = pbs::read_rig(path);
    const auto& [points, triangles, skin] =
        std::tie(rig.meshes.at(0).points, rig.meshes.at(0).triangles, rig.meshes.at(0).skin);
    const std::vector<Eigen::Affine3d> nodes = pbs::node_transforms(rig, pbs::find_animation(rig, ""), 0.5);
    return content_of(points, triangles) +
           sum_of(Eigen::Map<const Eigen::VectorXd>(skin.weight.data(), Eigen::Index(skin.weight.size()))) +
           sum_of(pbs::skinned_points(rig.meshes.at(0), nodes));
}

std::string read_clip(const std::string& path)
{
    const pbs::Clip clip = pbs::read_clip(path);
    std::string content =
        std::to_string(clip.frames()) + " frames of " + pbs::number_text(clip.frame_time_s, 12) + " s";
    for (const auto& frame : clip.local)
        for (const Eigen::Quaterniond& turn : frame) content += sum_of(turn.coeffs());
    for (const pbs::Positions& places : clip.places) content += sum_of(places);
    return content + sum_of(clip.zero_pose);
}

std::string read_skeleton(const std::string& path)
{
    std::string content;
    for (const pbs::Bone& bone : pbs::parse_skeleton(pbs::read_text_file(path, pbs::most_settings_bytes), path).bones)
        content += bone.name + sum_of(bone.head) + sum_of(bone.tail) + "; ";
    return content;
}

std::string read_weights(const std::string& path)
{
    const pbs::Skeleton skeleton{{{"upper", -1, {-1, 0, 0}, {0, 0, 0}}, {"forearm", 0, {0, 0, 0}, {1, 0, 0}}}};
    const pbs::Weights weights = pbs::parse_weights(pbs::read_text_file(path), path, skeleton, 2);
    return std::to_string(weights.vertices()) + " vertices" +
           sum_of(Eigen::Map<const Eigen::VectorXd>(weights.weight.data(), Eigen::Index(weights.weight.size())));
}

// A bar as this program writes it.
std::string written(const std::string& extension)
{
    const ScratchFolder folder;
    pbs::write_tet_mesh(folder / ("bar" + extension), test_support::structured_bar({-1, -1, -1}, {1, 1, 1}, {3, 3, 3}));
    return pbs::read_text_file(folder / ("bar" + extension));
}

const std::string points = "0 0 0\n{x=1} 0 0\n0 1 0\n0 0 1\n", fifth = "0.5 -0.25 -1\n",
                  faces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 {corner=2}\n";
const std::string msh =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{count=4}\n1 0 0 0\n2 {x=1} 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
    "$Elements\n1\n1 4 2 0 1 1 2 3 {corner=4}\n$EndElements\n";
const std::string medit =
    "MeshVersionFormatted 2\nDimension 3\nVertices\n{count=4}\n0 0 0 1\n{x=1} 0 0 1\n0 1 0 1\n0 0 1 "
    "1\nTetrahedra\n1\n1 2 3 {corner=4} "
    "1\nEnd\n";
const std::string vtk = "# vtk DataFile Version 3.0\ntet\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {count=4} double\n" +
                        points + "CELLS 1 5\n4 0 1 2 {corner=3}\nCELL_TYPES 1\n10\n";
const std::string node = "{count=4} 3 0 0\n0 0 0 0\n1 {x=1} 0 0\n2 0 1 0\n3 0 0 1\n",
                  ele = "1 4 0\n0 0 1 2 {corner=3}\n";
// Two tets, so that a count which is too small would leave out one of them.
const std::string msh_of_two =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{count=5}\n1 0 0 0\n2 {x=1} 0 0\n3 0 1 0\n4 0 0 1\n5 0.5 -0.25 "
    "-1\n$EndNodes\n"
    "$Elements\n{cells=2}\n1 4 2 0 1 1 2 3 4\n2 4 2 0 1 1 3 2 {corner=5}\n$EndElements\n";
const std::string medit_of_two =
    "MeshVersionFormatted 2\nDimension 3\nVertices\n{count=5}\n0 0 0 1\n{x=1} 0 0 1\n0 1 0 1\n0 0 1 1\n0.5 -0.25 -1 "
    "1\nTetrahedra\n"
    "{cells=2}\n1 2 3 4 1\n1 3 2 {corner=5} 1\nEnd\n";
const std::string vtk_of_two =
    "# vtk DataFile Version 3.0\ntets\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {count=5} double\n" + points + fifth +
    "CELLS {cells=2} 10\n4 0 1 2 3\n4 0 2 1 {corner=4}\nCELL_TYPES 2\n10\n10\n";
const std::string nodes_of_two = "{count=5} 3 0 0\n0 0 0 0\n1 {x=1} 0 0\n2 0 1 0\n3 0 0 1\n4 0.5 -0.25 -1\n",
                  tets_of_two = "{cells=2} 4 0\n0 0 1 2 3\n1 0 2 1 {corner=4}\n";
const std::string tobj = "v 0 0 0\nv {x=1} 0 0\nv 0 1 0\nv 0 0 1\nt 0 1 2 {corner=3}\n";
const std::string obj = "v 0 0 0\nv {x=1} 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex {count=4}\nproperty float x\nproperty float y\nproperty float z\nelement "
    "face {cells=4}\n"
    "property list uchar int vertex_indices\nend_header\n" +
    points + faces;
const std::string off = "OFF\n{count=4} {cells=4} 0\n" + points + faces;
const std::string stl =
    "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex {x=1} 0 0\nvertex 0 1 "
    "0\nendloop\nendfacet\nendsolid a\n";
const std::string bvh =
    "HIERARCHY\nROOT upper\n{\n OFFSET 0 0 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation "
    "Xrotation\n JOINT forearm\n"
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
        {.name = "written_msh", .file = "a.msh", .text = written(".msh"), .read = read_tets, .refused_dialects = 2},
        {"written_mesh", "a.mesh", written(".mesh"), read_tets},
        {"written_vtu", "a.vtu", written(".vtu"), read_tets},
        {"tetgen_tets", "a.ele", ele, read_tets, "a.node", node},
        {"tetgen_points", "a.node", node, read_tets, "a.ele", ele},
        {"two_in_gmsh", "a.msh", msh_of_two, read_tets},
        {"two_in_medit", "a.mesh", medit_of_two, read_tets},
        {"two_in_vtk", "a.vtk", vtk_of_two, read_tets},
        {"two_in_tetgen_tets", "a.ele", tets_of_two, read_tets, "a.node", nodes_of_two},
        {"two_in_tetgen_points", "a.node", nodes_of_two, read_tets, "a.ele", tets_of_two},
        {"gmsh_frame", "a.msh", msh_of_two, read_frame},
        {"medit_frame", "a.mesh", medit_of_two, read_frame},
        {"vtk_frame", "a.vtk", vtk_of_two, read_frame},
        {"written_frame", "a.vtu", written(".vtu"), read_frame},
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
        {"gltf_clip", "a.gltf", test_support::two_joint_document().text(), read_clip},
        {"fbx_clip", "a.fbx", test_support::fbx_arm(), read_clip},
        {.name = "skeleton",
         .file = "a.toml",
         .text = skeleton,
         .read = read_skeleton,
         .has_an_end = false,
         .refused_dialects = 0},
        {.name = "weights",
         .file = "a.csv",
         .text = "vertex,joint,weight\n0,upper,1\n1,upper,0.25\n1,forearm,0.75\n",
         .read = read_weights,
         .refused_dialects = 0},
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
    static const std::regex any(R"(\{(x|corner|count|cells)=(\d)\})");
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
    std::string answer_to(const std::string& content) const
    {
        return answer_of(GetParam(), folder.file(GetParam().file, content));
    }
    void expect_refused(const std::string& content, const std::string& change = "") const
    {
        const std::string answer = answer_to(content);
        EXPECT_FALSE(answer.starts_with("read: ")) << change << ": " << answer;
    }

    const ScratchFolder folder;
    const std::string whole = sound(GetParam().text);
};

class ReaderOfWholeFiles : public ReaderContract {};  // a part of any other file is another file
class ReaderOfText : public ReaderContract {};        // not of bytes
// The bad numbers of the other readers are in bad_files.cpp.
class ReaderOfNumbers : public ReaderContract {
protected:
    static bool has(const std::string& place) { return GetParam().text.find("{" + place + "=") != std::string::npos; }
};

class ReaderOfWholeWords : public ReaderOfNumbers {};

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
INSTANTIATE_TEST_SUITE_P(Readers, ReaderOfWholeFiles, testing::ValuesIn(readers_that(std::mem_fn(&Reader::has_an_end))),
                         name_in_suite);
INSTANTIATE_TEST_SUITE_P(Readers, ReaderOfText, testing::ValuesIn(readers_that([](const Reader& of) {
                             return of.text.find('\0') == std::string::npos;
                         })),
                         name_in_suite);
INSTANTIATE_TEST_SUITE_P(Readers, ReaderOfWholeWords, testing::ValuesIn(readers_that([](const Reader& of) {
                             return of.text.find("{x=") != std::string::npos;
                         })),
                         name_in_suite);
INSTANTIATE_TEST_SUITE_P(Readers, ReaderOfNumbers, testing::ValuesIn(readers_that([](const Reader& of) {
                             return of.text.find("{x=") != std::string::npos;
                         })),
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
    EXPECT_NE(answer_of(GetParam(), path).find("expected a file"), std::string::npos)
        << "a pipe, which would be waited for without end";
}

TEST_P(ReaderContract, RefusesNothingNoiseAndWords)
{
    for (const std::string& content :
         {std::string(), noise(500), noise(4096), std::string("these are words and no numbers\n")})
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

// The same content as other programs and editors write it.
struct Dialect {
    std::string name;
    std::string (*of)(const std::string& text);
};

const Dialect dialects[] = {
    {"a byte-order mark", [](const std::string& text) { return "\xef\xbb\xbf" + text; }},
    {"lines that end in CR LF",
     [](const std::string& text) { return std::regex_replace(text, std::regex("\n"), "\r\n"); }},
    {"tabs between numbers",
     [](const std::string& text) { return std::regex_replace(text, std::regex("(\\d) (?=[-\\d])"), "$1\t"); }},
    {"two spaces between numbers",
     [](const std::string& text) { return std::regex_replace(text, std::regex("(\\d) (?=[-\\d])"), "$1  "); }},
    {"spaces at the ends of lines",
     [](const std::string& text) { return std::regex_replace(text, std::regex("\n"), " \n"); }},
    {"empty lines at the end", [](const std::string& text) { return text + "\n\n"; }},
    {"no end of the last line",
     [](const std::string& text) { return text.ends_with('\n') ? text.substr(0, text.size() - 1) : text; }},
};

TEST_P(ReaderOfText, ReadsTheSameContentInEveryDialectThatItAccepts)
{
    const std::string answer = answer_to(whole);
    int refused = 0;
    for (const Dialect& dialect : dialects) {
        const std::string other = answer_to(dialect.of(whole));
        refused += !other.starts_with("read: ");
        EXPECT_TRUE(other == answer || !other.starts_with("read: ")) << dialect.name << ": " << other;
    }
    EXPECT_LE(refused, GetParam().refused_dialects);
}

TEST_P(ReaderOfNumbers, RefusesNumbersThatCannotBe)
{
    for (const auto& [place, numbers] :
         {std::pair<std::string, std::vector<std::string>>{"x", {"nan", "inf", "1e999", "abc", "--1"}},
          {"corner", {"9", "-1", "99999999999", "x"}},
          {"count", {"-4", "4000000000", "nan"}},
          {"cells", {"-4", "4000000000"}}})
        for (const std::string& number : numbers)
            if (has(place)) expect_refused(with_number(GetParam().text, place, number), place + " = " + number);
}

TEST_P(ReaderOfWholeWords, RefusesWordsThatOnlyBeginAsNumbers)
{
    for (const auto& [place, words] :
         {std::pair<std::string, std::vector<std::string>>{"x", {"1.#QNAN", "1.#INF", "1.5.2", "1,5", "1e"}},
          {"corner", {"1.5", "nan"}}})
        for (const std::string& word : words)
            if (has(place)) expect_refused(with_number(GetParam().text, place, word), place + " = " + word);
}

TEST_P(ReaderOfWholeWords, RefusesCountsThatAreWrongByOne)
{
    for (const std::string place : {"count", "cells"}) {
        std::smatch found;
        if (!std::regex_search(GetParam().text, found, std::regex("\\{" + place + "=(\\d)\\}"))) continue;
        const int count = std::stoi(found[1]);
        for (const int other : {count - 1, count + 1})
            expect_refused(with_number(GetParam().text, place, std::to_string(other)),
                           place + " = " + std::to_string(other));
    }
}

// Fortran writes 0.29 as 2.9D-01.
TEST_P(ReaderOfWholeWords, ReadsFortransExponentsOrRefusesThem)
{
    const std::string answer = answer_to(with_number(GetParam().text, "x", "0.29"));
    for (const std::string number : {"2.9D-01", "0.29d0"}) {
        const std::string of_fortran = answer_to(with_number(GetParam().text, "x", number));
        EXPECT_TRUE(of_fortran == answer || !of_fortran.starts_with("read: ")) << number << ": " << of_fortran;
    }
}

// Reading and writing files does not depend on the locale of the program that uses the library. Reference: the bytes
// that are written with the classic locale.

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
        EXPECT_EQ(pbs::read_text_file(folder / ("commas" + ending)), pbs::read_text_file(folder / ("classic" + ending)))
            << ending;
        EXPECT_EQ(pbs::read_tet_frame(folder / ("classic" + ending)).rest, mesh.rest) << ending;
    }
    pbs::write_pvd(folder / "commas.pvd", {{1234.5, "a.vtu"}});
    EXPECT_NE(pbs::read_text_file(folder / "commas.pvd").find("timestep=\"1234.5\""), std::string::npos);
}

}  // namespace
}  // namespace readers
