// Reference: the bytes that were written.

#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <thread>
#include <vector>

namespace {

using ReadTextFile = test_support::FolderTest;
using WriteAtomically = test_support::FolderTest;
using AtomicFile = test_support::FolderTest;
using namespace pbs;
TEST_F(ReadTextFile, IsWholeToTheByteAndWaitsForNoPipeOrDevice)
{
    const std::string bytes("a\r\n\0b\n", 6), none = folder / "none";
    EXPECT_EQ(read_text_file(folder.file("bytes", bytes)), bytes);
    expect_input_error([&] { read_text_file(none); }, none + ": ", "cannot be opened: No such file or directory");
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    for (const std::string& other : {folder.path().string(), folder / "pipe", std::string("/dev/zero")})
        expect_input_error([&] { read_text_file(other); }, other + ": ", "cannot be opened: expected a file");
}

TEST_F(ReadTextFile, RefusesTooLargeAFileByItsSize)
{
    const std::string path = folder.file("text", "four");
    EXPECT_EQ(read_text_file(path, 4), "four");
    expect_input_error([&] { read_text_file(path, 3); }, path + ": bytes = 4: ", "expected at most 3");
    std::filesystem::resize_file(path, std::uintmax_t(1) << 36);  // a hole, which is read as that many zeros
    expect_input_error([&] { read_text_file(path); }, path + ": bytes = 68719476736: ", "expected at most 268435456");
}

// Reference: TOML's grammar, https://toml.io/en/v1.0.0: bare keys are ASCII; texts, comments and lists hold any number
// of dots.

std::string repeated(const std::string& before, int count, const std::string& text, const std::string& after)
{
    std::string all = before;
    for (int i = 0; i < count; ++i) all += text;
    return all += after;
}

std::string message_of(const std::string& text)
{
    return test_support::refusal_of([&] { check_toml_keys(text, "x.toml"); });
}

TEST(TomlText, KeysOfManyPartsAreNamedWithTheirLine)
{
    const std::string head = "# a key\n", told = "x.toml:2: key = ";
    for (const std::string part : {"a.", "\"a\".", "'a'.", "a . ", "\"a\\\".\"."})
        for (const std::string before : {"", "[", "[["}) {
            const std::string text = repeated(head + before, 64, part, "a = 1\n");
            EXPECT_EQ(message_of(text).substr(0, told.size()), told) << text;
        }
    EXPECT_EQ(message_of(repeated("", 63, "a.", "a = 1\n")), "accepted");
}

TEST(TomlText, KeysOfInlineTablesAreCountedWithThoseAroundThem)
{
    const std::string told = "x.toml:1: key = x = ";
    for (const std::string before :
         {"x = {", "x = { b = 1, ", "x = [1, {", "x = [{ b = { c = 2 }, ", "x = { b = \"{#\", 'c' = '}', "})
        EXPECT_EQ(message_of(repeated(before, 64, "a.", "a = 1}\n")).substr(0, told.size()), told) << before;
    EXPECT_EQ(message_of(repeated("x = ", 8, "{a.a.a.a.a.a.a.a.a = ", "1\n")).substr(0, told.size()), told);
    EXPECT_EQ(message_of(repeated("x = [", 100, "{ a.b = 0.5, c.d = { e.f = 0.5 } }, ", "]\n")), "accepted");
    EXPECT_EQ(message_of(repeated("x = [\n", 100, "{ a.b = 0.5 },\n", "]\n")), "accepted");
}

TEST(TomlText, QuotesOfManyLinesHideNoKey)
{
    const std::string told = "x.toml:3: key = ";
    for (const std::string text : {"x = [\"\"\"\n\"\n\"\"\"\", ", "x = ['''\n'\n''''', ", "x = \"\"\n\n["})
        EXPECT_EQ(message_of(repeated(text + "{", 64, "a.", "a = 1}]\n")).substr(0, told.size()), told) << text;
    EXPECT_EQ(message_of(repeated("x = \"\"\"\n\"\n\\\"\"\"", 100, "a.", "\n\"\"\"\"\"\n")), "accepted");
}

TEST(TomlText, DotsElsewhereAreNoParts)
{
    EXPECT_EQ(message_of(repeated("x = \"", 100, "a.", "\"\n")), "accepted");
    EXPECT_EQ(message_of(repeated("# ", 100, "a.", "\n")), "accepted");
    EXPECT_EQ(message_of(repeated("x = [\n", 100, "0.5, ", "\n]\n")), "accepted");
    // a single part, whose name contains dots
    EXPECT_EQ(message_of(repeated("\"", 100, "a.", "\" = 1\n")), "accepted");
}

TEST(TomlText, BareWordsAreAscii)
{
    EXPECT_EQ(message_of("x = 1\nt\xc3\xa9te = 2\n"), "x.toml:2: byte = 195: expected ASCII outside of texts");
    EXPECT_EQ(message_of(std::string("x\0y = 2\n", 8)), "x.toml:1: byte = 0: expected ASCII outside of texts");
    EXPECT_EQ(message_of("x = \"\"\"\n\"\"\"\nt\xc3\xa9te = 2\n"),
              "x.toml:3: byte = 195: expected ASCII outside of texts");
    EXPECT_EQ(message_of("x = r\"t\xc3\xa9te\"\n").substr(0, 18), "x.toml:1: quote = ");
    EXPECT_EQ(message_of("x = \"t\xc3\xa9te\"  # t\xc3\xa9te\r\n\ty = 2\r\n"), "accepted");
}

// Reference: the contents of the file system afterwards. Failing writes: tests/unit/analysis/records/record_files.cpp.

namespace fs = std::filesystem;

long files_in(const fs::path& folder)
{
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST_F(WriteAtomically, WritesAndReplacesAlsoUnderANameOfTheGreatestLength)
{
    const std::string bytes("a\0b\n", 4);
    for (const std::string& path : {folder / "limb.vtu", folder / std::string(255, 'x')}) {
        for (const std::string& text : {std::string("old"), bytes, std::string()}) {
            write_atomically(path, text);
            EXPECT_EQ(read_text_file(path), text);
        }
    }
    EXPECT_EQ(files_in(folder.path()), 2);
}

TEST_F(AtomicFile, IsThereOnceItIsFinished)
{
    const std::string path = folder / "hero.glb";
    {
        pbs::AtomicFile file(path);
        file.write("begin");
        file.write("");
        file.write(", end");
        EXPECT_FALSE(fs::exists(path));
        EXPECT_EQ(read_text_file(file.temporary()), "begin, end");
        file.finish();
        EXPECT_EQ(read_text_file(path), "begin, end");
    }
    EXPECT_EQ(files_in(folder.path()), 1);
}

TEST_F(AtomicFile, ThatIsNotFinishedLeavesNothing)
{
    write_atomically(folder / "hero.glb", "old");
    pbs::AtomicFile(folder / "hero.glb").write("new");
    EXPECT_EQ(read_text_file(folder / "hero.glb"), "old");
    EXPECT_EQ(files_in(folder.path()), 1);
}

TEST_F(WriteAtomically, GivesTheUsualPermissions)
{
    const mode_t before = umask(027);
    write_atomically(folder / "limb.vtu", "");
    umask(before);
    struct stat status = {};
    ASSERT_EQ(stat((folder / "limb.vtu").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0640u);
}

// Anyone who can write to the folder could create a link with the name of the temporary file, if that name were
// predictable.
TEST_F(WriteAtomically, NothingThatLiesThereIsWrittenThrough)
{
    const std::string theirs = folder.file("theirs", "theirs");
    fs::create_directory(folder.path() / "out");
    for (const std::string& name :
         {".limb." + std::to_string(getpid()) + ".vtu", ".limb.vtu." + std::to_string(getpid())})
        fs::create_symlink(theirs, folder.path() / "out" / name);
    write_atomically(folder / "out/limb.vtu", "ours");
    EXPECT_EQ(read_text_file(theirs), "theirs");
    EXPECT_EQ(files_in(folder.path() / "out"), 3);
}

TEST_F(WriteAtomically, ADeviceOrANamedPipeIsLeftThere)
{
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    fs::create_symlink("/dev/null", folder.path() / "device");
    for (const char* name : {"pipe", "device"}) {
        EXPECT_THROW(write_atomically(folder / name, "ours"), InputError) << name;
        EXPECT_THROW(require_no_device(folder / name), InputError) << name;
    }
    EXPECT_TRUE(fs::is_fifo(folder.path() / "pipe"));
    EXPECT_TRUE(fs::is_symlink(folder.path() / "device"));
    EXPECT_EQ(files_in(folder.path()), 2);
}

TEST_F(WriteAtomically, ThreadsThatWriteOneFileLeaveAWholeOne)
{
    const std::string path = folder / "limb.vtu";
    std::vector<std::thread> writers;
    for (const char letter : {'a', 'b', 'c', 'd'})
        writers.emplace_back([&path, letter] {
            for (int i = 0; i < 20; ++i) write_atomically(path, std::string(300'000, letter));
        });
    for (std::thread& writer : writers) writer.join();
    const std::string text = read_text_file(path);
    EXPECT_EQ(text, std::string(300'000, text.front()));
    EXPECT_EQ(files_in(folder.path()), 1);
}

}  // namespace
