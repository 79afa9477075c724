// Reference: the interface. The file of a surface may refer to files in and below its folder; no other file is opened,
// and the error names it if it is needed.

#include "experiments/rigs/surface_reader.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <array>
#include <chrono>
#include <cstdint>

namespace {

using test_support::ScratchFolder;

// A tet as glTF whose numbers are in another file.
std::string gltf(const std::string& buffer)
{
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 1]},
{"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
"buffers": [{"byteLength": 72, "uri": ")" +
           buffer + "\"}]}";
}

std::string numbers()
{
    const std::array<float, 12> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::array<std::uint16_t, 12> corners = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    return std::string(reinterpret_cast<const char*>(points.data()), sizeof points) +
           std::string(reinterpret_cast<const char*>(corners.data()), sizeof corners);
}

std::string outcome(const std::string& path)
{
    const auto begin = std::chrono::steady_clock::now();
    Eigen::Index triangles = 0;
    const std::string refusal = test_support::refusal_of([&] { triangles = pbs::read_surface(path).triangles.rows(); });
    // a reader that blocks has a limit of 20 s
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10)) << path;
    return refusal == "accepted" ? std::to_string(triangles) + " triangles" : refusal;
}

class ReferredFile : public testing::Test {
protected:
    void SetUp() override
    {
        std::filesystem::create_directories(scratch.path() / "own" / "deeper");
        for (const char* name : {"away.bin", "own/beside.bin", "own/deeper/below.bin"}) scratch.file(name, numbers());
    }
    std::string own(const std::string& name) const { return scratch / ("own/" + name); }
    std::string said_of(const std::string& buffer) const { return outcome(scratch.file("own/a.gltf", gltf(buffer))); }
    std::string refused(const std::string& file) const
    {
        return own("a.gltf") + ": referred file = " + own(file).substr(0, 80) + (own(file).size() > 80 ? "..." : "") +
               ": expected a regular file below the folder of the one that refers to it";
    }
    const ScratchFolder scratch;
};

TEST_F(ReferredFile, BesideAndBelowIsRead)
{
    for (const char* buffer : {"beside.bin", "deeper/below.bin", "deeper/../beside.bin"})
        EXPECT_EQ(said_of(buffer), "4 triangles");
}

TEST_F(ReferredFile, BesideWhatALinkStandsForIsRead)
{
    scratch.file("own/a.gltf", gltf("beside.bin"));
    std::filesystem::create_directory(scratch.path() / "links");
    for (const char* name : {"a.gltf", "beside.bin"})
        std::filesystem::create_symlink(own(name), scratch.path() / "links" / name);
    EXPECT_EQ(outcome(scratch / "links/a.gltf"), "4 triangles");
}

TEST_F(ReferredFile, ElsewhereAndWhatIsNoFileIsRefusedByNameAndNotWaitedFor)
{
    ASSERT_EQ(mkfifo(own("pipe").c_str(), 0600), 0);
    std::filesystem::create_symlink(scratch / "away.bin", own("link.bin"));
    std::filesystem::create_symlink("/dev/zero", own("zeros"));
    for (const char* file : {"../away.bin", "link.bin", "pipe", "zeros"}) EXPECT_EQ(said_of(file), refused(file));
    EXPECT_NE(said_of("none.bin").find("none.bin"), std::string::npos);
}

TEST_F(ReferredFile, MaterialsAreNotNeeded)
{
    ASSERT_EQ(mkfifo(own("pipe.mtl").c_str(), 0600), 0);
    for (const char* library : {"pipe.mtl", "../../../../etc/passwd", "none.mtl"})
        EXPECT_EQ(outcome(scratch.file(
                      "own/a.obj",
                      std::string("mtllib ") + library +
                          "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl a\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")),
                  "4 triangles")
            << library;
}

}  // namespace
