// Reference: the specification of the cache: a hit is the mesh that was made, to the bit, and a damaged file is made
// again.

#include "experiments/characters/body_cache.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "pbs/system/files.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace {

using InputFile = test_support::FolderTest;
using namespace pbs;
namespace fs = std::filesystem;

TetMesh two_tets()
{
    return {Positions{{0, 0, 0}, {1.0 / 3.0, 0, 0}, {0, 1e-3, 0}, {0, 0, M_PI}, {0.1, 0.1, -2.0 / 7.0}},
            Tets{{0, 1, 2, 3}, {0, 2, 1, 4}}};
}

class BodyCache : public testing::Test {
protected:
    void SetUp() override { ::setenv("PBSKIN_CACHE", folder.path().c_str(), 1); }
    void TearDown() override { ::unsetenv("PBSKIN_CACHE"); }

    TetMesh get(const std::string& key = "two")
    {
        return cached_mesh(key, [&] {
            ++made;
            return two_tets();
        });
    }
    fs::path stored() const
    {
        std::vector<fs::path> files;
        for (const auto& entry : fs::directory_iterator(folder.path()))
            if (entry.path().filename() != "making.lock") files.push_back(entry.path());
        EXPECT_EQ(files.size(), 1u);
        return files.at(0);
    }

    test_support::ScratchFolder folder;
    int made = 0;
};

TEST_F(BodyCache, AHitIsWhatWasMadeToTheBit)
{
    get();
    EXPECT_EQ(content_hash(get()), content_hash(two_tets()));
    EXPECT_EQ(made, 1);
    EXPECT_TRUE(stored().filename().string().starts_with("two-")) << "no half-made file is left";
}

TEST_F(BodyCache, AnotherKeyIsAnotherMesh)
{
    for (const char* key : {"two", "two-1", "tw"}) get(key);
    EXPECT_EQ(made, 3);
}

TEST_F(BodyCache, AFileThatIsNotTheMeshIsMadeAnew)
{
    const auto flip_a_bit = [](const std::string& file) {
        std::string bytes = read_text_file(file);
        bytes[bytes.size() / 2] ^= 1;
        std::ofstream(file, std::ios::binary) << bytes;
    };
    const auto write_another_mesh = [](const std::string& file) {
        TetMesh other = two_tets();
        other.rest(4, 2) -= 1e-9;
        write_tet_mesh(file, other);
    };
    const std::vector<std::pair<const char*, std::function<void(const std::string&)>>> damages = {
        {"one byte changed", flip_a_bit},
        {"a whole file of another mesh", write_another_mesh},
        {"truncated", [](const std::string& file) { fs::resize_file(file, fs::file_size(file) / 2); }},
        {"empty", [](const std::string& file) { fs::resize_file(file, 0); }}};
    get();
    for (const auto& [name, damage] : damages) {
        SCOPED_TRACE(name);
        const int before = made;
        damage(stored().string());
        EXPECT_EQ(content_hash(get()), content_hash(two_tets()));
        EXPECT_EQ(made, before + 1);
        get();
        EXPECT_EQ(made, before + 1) << "the new file is whole";
    }
}

TEST_F(BodyCache, WhatAKilledMakerLeftIsRemovedAndWhatALivingOneMakesIsNot)
{
    const pid_t gone = fork();
    if (gone == 0) _exit(0);
    waitpid(gone, nullptr, 0);
    const fs::path folder = cache_folder();
    fs::create_directories(folder);
    const std::string dead = "making-other-" + std::to_string(gone),
                      living = "making-other-" + std::to_string(getpid());
    for (const std::string& name : {dead + ".vtu", "." + dead + "." + std::to_string(gone) + ".vtu", living + ".vtu"})
        std::ofstream(folder / name) << "half";
    get();
    EXPECT_FALSE(fs::exists(folder / (dead + ".vtu")));
    EXPECT_FALSE(fs::exists(folder / ("." + dead + "." + std::to_string(gone) + ".vtu")));
    EXPECT_TRUE(fs::exists(folder / (living + ".vtu")));
}

// Each maker appends a byte; the second process starts while the first one still works.
TEST_F(BodyCache, OneProcessMakesWhileAnotherWaits)
{
    const fs::path makers = folder.path() / "makers";
    const auto slowly = [&] {
        std::ofstream(makers, std::ios::app) << '+';
        usleep(300'000);
        return two_tets();
    };
    const pid_t other = fork();
    if (other == 0) {
        cached_mesh("two", slowly);
        _exit(0);
    }
    while (!fs::exists(makers)) usleep(1'000);
    EXPECT_EQ(content_hash(cached_mesh("two", slowly)), content_hash(two_tets()));
    waitpid(other, nullptr, 0);
    EXPECT_EQ(fs::file_size(makers), 1u);
}

TEST_F(BodyCache, WhatAKilledMakerLockedIsFree)
{
    const fs::path makers = folder.path() / "makers";
    const pid_t other = fork();
    if (other == 0)
        cached_mesh("two", [&] {
            std::ofstream(makers) << '+';
            for (;;) pause();
            return two_tets();
        });
    while (!fs::exists(makers)) usleep(1'000);
    kill(other, SIGKILL);
    waitpid(other, nullptr, 0);
    get();
    EXPECT_EQ(made, 1);
}

TEST_F(BodyCache, WhereTheFolderCannotBeWrittenTheMeshIsMadeEveryTime)
{
    ::setenv("PBSKIN_CACHE", "/proc/none", 1);
    EXPECT_EQ(content_hash(get()), content_hash(two_tets()));
    EXPECT_EQ(content_hash(get()), content_hash(two_tets()));
    EXPECT_EQ(made, 2);
}

// A folder of references with tets for the key "two", which differ from those that the mesher makes and from those in
// the cache.
class KeptTets : public BodyCache {
protected:
    void SetUp() override
    {
        BodyCache::SetUp();
        ::setenv("PBSKIN_REFERENCES", references.path().c_str(), 1);
        fs::create_directory(references.path() / "tets");
        write_tet_mesh(references / "tets/new.vtu", kept());
        file = references.path() / "tets" / ("two-" + hash_of_file(references / "tets/new.vtu") + ".vtu");
        fs::rename(references / "tets/new.vtu", file);
    }
    void TearDown() override
    {
        ::unsetenv("PBSKIN_REFERENCES");
        BodyCache::TearDown();
    }

    static TetMesh kept()
    {
        TetMesh mesh = two_tets();
        mesh.rest(4, 2) -= 0.5;
        return mesh;
    }

    test_support::ScratchFolder references;
    fs::path file;
};

TEST_F(KeptTets, WinOverTheCacheAndTheMesher)
{
    fs::rename(file, references.path() / "elsewhere.vtu");
    EXPECT_EQ(content_hash(get()), content_hash(two_tets()));
    fs::rename(references.path() / "elsewhere.vtu", file);
    EXPECT_EQ(content_hash(get()), content_hash(kept()));
    EXPECT_EQ(made, 1);
    EXPECT_EQ(content_hash(get("one")), content_hash(two_tets())) << "another key";
}

// What came with the program is not removed, and other tets do not take its place in silence.
TEST_F(KeptTets, ThatAreDamagedAreRefusedAndStay)
{
    const std::string whole = read_text_file(file.string());
    for (const std::string& damaged : {whole.substr(0, whole.size() / 2), std::string(), whole + " "}) {
        std::ofstream(file, std::ios::binary) << damaged;
        const std::string refused = test_support::refusal_of([&] { get(); });
        EXPECT_TRUE(refused.starts_with(file.string() + ": is damaged: ")) << refused;
        EXPECT_EQ(read_text_file(file.string()), damaged);
    }
    EXPECT_EQ(made, 0);
    std::ofstream(file, std::ios::binary) << whole;
    EXPECT_EQ(content_hash(get()), content_hash(kept()));
}

TEST(ReferencesFolder, FollowsTheVariableOrLiesNextToTheProgramsFolder)
{
    ::setenv("PBSKIN_REFERENCES", "/a", 1);
    EXPECT_EQ(references_folder(), "/a");
    for (const auto& unset : std::vector<std::function<void()>>{[] { ::setenv("PBSKIN_REFERENCES", "", 1); },
                                                                [] { ::unsetenv("PBSKIN_REFERENCES"); }}) {
        unset();
        const fs::path program = fs::read_symlink("/proc/self/exe");
        EXPECT_EQ(fs::path(references_folder()), program.parent_path().parent_path() / "share/pbskin/references");
    }
}

TEST(CacheFolder, FollowsTheVariablesInTheirOrder)
{
    ::setenv("PBSKIN_CACHE", "/a", 1);
    ::setenv("XDG_CACHE_HOME", "/b", 1);
    EXPECT_EQ(cache_folder(), "/a");
    ::unsetenv("PBSKIN_CACHE");
    EXPECT_EQ(cache_folder(), "/b/pbskin");
    ::unsetenv("XDG_CACHE_HOME");
    const char* home = std::getenv("HOME");
    const std::string before = home ? home : "";
    ::setenv("HOME", "/c", 1);
    EXPECT_EQ(cache_folder(), "/c/.cache/pbskin");
    ::setenv("HOME", before.c_str(), 1);
}

TEST(ContentHash, IsXxh3)
{
    // The published value of XXH3 (128 bits) for no bytes and seed 0.
    EXPECT_EQ(content_hash(std::string()), "99aa06d3014798d86001c324468d497f");
}

// Reference: the contents written to the files, before and between the calls.

using Hashes = std::vector<std::pair<std::string, std::string>>;

constexpr const char* changed = "was changed while it was read";
TEST_F(InputFile, IsTheHashOfItsBytesUnderItsName)
{
    const pbs::InputFile file(folder.file("walk.bvh", "HIERARCHY"));
    EXPECT_EQ(file.hashed(), (Hashes{{"walk.bvh", content_hash("HIERARCHY")}}));
}

TEST_F(InputFile, OneThatIsOverwrittenGoesOrComesIsRefused)
{
    const std::string path = folder / "arm.vtu";
    const pbs::InputFile none(path);
    folder.file("arm.vtu", "one");
    expect_input_error([&] { none.hashed(); }, path + ": ", changed);
    const pbs::InputFile file(path);
    folder.file("arm.vtu", "two");  // of the same length
    expect_input_error([&] { file.hashed(); }, path + ": ", changed);
    std::filesystem::remove(path);
    expect_input_error([&] { file.hashed(); }, path + ": ", changed);
}

// The content is that of before, but a reader may have read the other content in between. The pause is longer than a
// tick of the file system's clock, which is a few milliseconds.
TEST_F(InputFile, OneThatIsOverwrittenAndRestoredIsRefused)
{
    const std::string path = folder.file("arm.vtu", "one");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const pbs::InputFile file(path);
    folder.file("arm.vtu", "two");
    folder.file("arm.vtu", "one");
    expect_input_error([&] { file.hashed(); }, path + ": ", changed);
}

TEST_F(InputFile, TetGensOtherHalfBelongsToIt)
{
    const std::string points = folder.file("a.node", "points"), tets = folder.file("a.ele", "tets");
    for (const std::string& named : {points, tets}) {
        const pbs::InputFile file(named);
        EXPECT_EQ(hashes_by_name(file.hashed()),
                  hashes_by_name({{"a.node", hash_of_file(points)}, {"a.ele", hash_of_file(tets)}}));
        const std::string other = named == points ? tets : points;
        std::filesystem::resize_file(other, 2);
        expect_input_error([&] { file.hashed(); }, other + ": ", changed);
        folder.file("a.node", "points"), folder.file("a.ele", "tets");
    }
}

TEST_F(InputFile, TheBuffersOfAGltfBelongToIt)
{
    const std::string buffer = folder.file("walk.bin", "\1\2\3");
    const std::string text =
        R"({"buffers": [{"uri" : "walk.bin"}, {"uri": "data:;base64,AA=="}, {"uri": "none.bin"}], "name": "uri"})";
    const pbs::InputFile file(folder.file("walk.gltf", text));
    EXPECT_EQ(file.hashed(), (Hashes{{"walk.gltf", content_hash(text)}, {"walk.bin", hash_of_file(buffer)}}));
    folder.file("walk.bin", "\1\2\4");
    expect_input_error([&] { file.hashed(); }, buffer + ": ", changed);
}

TEST_F(InputFile, AGltfThatEndsWithinAnAddressIsLeftToItsReader)
{
    for (const std::string text : {R"({"uri")", R"({"uri" : )", R"({"uri": "walk)", R"({"uri": ")"}) {
        const pbs::InputFile file(folder.file("walk.gltf", text));
        EXPECT_EQ(file.hashed(), (Hashes{{"walk.gltf", content_hash(text)}})) << text;
    }
}

TEST(HashesByName, TwoFilesOfANameAreBothKept)
{
    const auto hashes = hashes_by_name({{"01.bvh", "a"}, {"01.bvh", "b"}, {"01.bvh", "a"}, {"01.bvh", "c"}});
    EXPECT_EQ(hashes, (std::map<std::string, std::string>{{"01.bvh", "a"}, {"01.bvh (2)", "b"}, {"01.bvh (3)", "c"}}));
}

}  // namespace
