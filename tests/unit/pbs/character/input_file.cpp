// Reference: the contents written to the files, before and between the calls.
#include "pbs/character/input_file.hpp"

#include "pbs/character/body_cache.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

namespace {

using namespace pbs;
using Hashes = std::vector<std::pair<std::string, std::string>>;

constexpr const char* changed = "was changed while it was read";

TEST(InputFile, IsTheHashOfItsBytesUnderItsName)
{
    const test_support::ScratchFolder folder;
    const InputFile file(folder.file("walk.bvh", "HIERARCHY"));
    EXPECT_EQ(file.hashed(), (Hashes{{"walk.bvh", content_hash("HIERARCHY")}}));
}

TEST(InputFile, OneThatIsOverwrittenIsRefused)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("arm.vtu", "one");
    const InputFile file(path);
    folder.file("arm.vtu", "two");  // of the same length
    expect_input_error([&] { file.hashed(); }, path + ": ", changed);
}

// The content is that of before, but a reader may have read the other content in between. The pause is longer than a tick of the file
// system's clock, which is a few milliseconds.
TEST(InputFile, OneThatIsOverwrittenAndRestoredIsRefused)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("arm.vtu", "one");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const InputFile file(path);
    folder.file("arm.vtu", "two");
    folder.file("arm.vtu", "one");
    expect_input_error([&] { file.hashed(); }, path + ": ", changed);
}

TEST(InputFile, OneThatGoesIsRefused)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("arm.vtu", "one");
    const InputFile file(path);
    std::filesystem::remove(path);
    expect_input_error([&] { file.hashed(); }, path + ": ", "No such file");
}

TEST(InputFile, OneThatComesIsRefused)
{
    const test_support::ScratchFolder folder;
    const InputFile file(folder / "arm.vtu");
    folder.file("arm.vtu", "one");
    expect_input_error([&] { file.hashed(); }, folder / "arm.vtu" + ": ", changed);
}

TEST(InputFile, TetGensOtherHalfBelongsToIt)
{
    const test_support::ScratchFolder folder;
    const std::string points = folder.file("a.node", "points"), tets = folder.file("a.ele", "tets");
    for (const std::string& named : {points, tets}) {
        const InputFile file(named);
        EXPECT_EQ(hashes_by_name(file.hashed()), hashes_by_name({{"a.node", hash_of_file(points)}, {"a.ele", hash_of_file(tets)}}));
        const std::string other = named == points ? tets : points;
        std::filesystem::resize_file(other, 2);
        expect_input_error([&] { file.hashed(); }, other + ": ", changed);
        folder.file("a.node", "points"), folder.file("a.ele", "tets");
    }
}

TEST(InputFile, TheBuffersOfAGltfBelongToIt)
{
    const test_support::ScratchFolder folder;
    const std::string buffer = folder.file("walk.bin", "\1\2\3");
    const std::string text = R"({"buffers": [{"uri" : "walk.bin"}, {"uri": "data:;base64,AA=="}, {"uri": "none.bin"}], "name": "uri"})";
    const InputFile file(folder.file("walk.gltf", text));
    EXPECT_EQ(file.hashed(), (Hashes{{"walk.gltf", content_hash(text)}, {"walk.bin", hash_of_file(buffer)}}));
    folder.file("walk.bin", "\1\2\4");
    expect_input_error([&] { file.hashed(); }, buffer + ": ", changed);
}

TEST(InputFile, AGltfThatEndsWithinAnAddressIsLeftToItsReader)
{
    const test_support::ScratchFolder folder;
    for (const std::string text : {R"({"uri")", R"({"uri" : )", R"({"uri": "walk)", R"({"uri": ")"}) {
        const InputFile file(folder.file("walk.gltf", text));
        EXPECT_EQ(file.hashed(), (Hashes{{"walk.gltf", content_hash(text)}})) << text;
    }
}

TEST(HashesByName, TwoFilesOfANameAreBothKept)
{
    const auto hashes = hashes_by_name({{"01.bvh", "a"}, {"01.bvh", "b"}, {"01.bvh", "a"}, {"01.bvh", "c"}});
    EXPECT_EQ(hashes, (std::map<std::string, std::string>{{"01.bvh", "a"}, {"01.bvh (2)", "b"}, {"01.bvh (3)", "c"}}));
}

}  // namespace
