// Reference: the contents of the file system afterwards. Failing writes: tests/unit/analysis/records/record_files.cpp.
#include "pbs/geometry/atomic_file.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/text_file.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <thread>
#include <vector>

namespace {

namespace fs = std::filesystem;
using pbs::InputError;
using pbs::read_text_file;
using pbs::require_no_device;
using pbs::write_atomically;
using test_support::ScratchFolder;

long files_in(const fs::path& folder)
{
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(WriteAtomically, WritesAndReplaces)
{
    const ScratchFolder folder;
    const std::string path = folder / "limb.vtu", bytes("a\0b\n", 4);
    write_atomically(path, "old");
    write_atomically(path, bytes);
    EXPECT_EQ(read_text_file(path), bytes);
    EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(AtomicFile, IsThereOnceItIsFinished)
{
    const ScratchFolder folder;
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

TEST(AtomicFile, ThatIsNotFinishedLeavesNothing)
{
    const ScratchFolder folder;
    write_atomically(folder / "hero.glb", "old");
    pbs::AtomicFile(folder / "hero.glb").write("new");
    EXPECT_EQ(read_text_file(folder / "hero.glb"), "old");
    EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(WriteAtomically, GivesTheUsualPermissions)
{
    const ScratchFolder folder;
    const mode_t before = umask(027);
    write_atomically(folder / "limb.vtu", "");
    umask(before);
    struct stat status = {};
    ASSERT_EQ(stat((folder / "limb.vtu").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST(WriteAtomically, ANameOfTheGreatestLengthIsWritten)
{
    const ScratchFolder folder;
    std::string name = ".vtu";
    name.insert(0, 251, 'x');
    const std::string path = folder / name;
    write_atomically(path, "whole");
    EXPECT_EQ(read_text_file(path), "whole");
}

// Anyone who can write to the folder could create a link with the name of the temporary file, if that name were predictable.
TEST(WriteAtomically, NothingThatLiesThereIsWrittenThrough)
{
    const ScratchFolder folder;
    const std::string theirs = folder.file("theirs", "theirs");
    fs::create_directory(folder.path() / "out");
    for (const std::string& name : {".limb." + std::to_string(getpid()) + ".vtu", ".limb.vtu." + std::to_string(getpid())})
        fs::create_symlink(theirs, folder.path() / "out" / name);
    write_atomically(folder / "out/limb.vtu", "ours");
    EXPECT_EQ(read_text_file(theirs), "theirs");
    EXPECT_EQ(files_in(folder.path() / "out"), 3);
}

TEST(WriteAtomically, ADeviceOrANamedPipeIsLeftThere)
{
    const ScratchFolder folder;
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

TEST(WriteAtomically, ThreadsThatWriteOneFileLeaveAWholeOne)
{
    const ScratchFolder folder;
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
