// Reference: the contents of the file system after each way in which writing can fail. Whole files or none, never a
// remaining temporary file.

#include "analysis/records/record_files.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/scratch_folder.hpp"

#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <map>

namespace {

namespace fs = std::filesystem;
using analysis::read_text;
using analysis::write_text_atomically;
using test_support::refusal_of;

class AtomicFile : public testing::Test {
protected:
    void SetUp() override { fs::permissions(folder, fs::perms::all); }
    void TearDown() override { fs::permissions(folder, fs::perms::all); }
    long files() const { return std::distance(fs::directory_iterator(folder), fs::directory_iterator()); }

    const test_support::ScratchFolder scratch;
    const fs::path folder = scratch.path();
};

// Whole files, names and permissions: tests/unit/pbs/system/files.cpp.
TEST_F(AtomicFile, ReadOnlyFolderIsRefused)
{
    fs::permissions(folder,
                    fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read | fs::perms::others_exec);
    const bool is_root = geteuid() == 0;  // permissions do not apply to root
    if (is_root) {
        ASSERT_EQ(seteuid(65534), 0);
    }
    EXPECT_THROW(write_text_atomically(folder / "run.json", "{}"), pbs::InputError);
    if (is_root) {
        ASSERT_EQ(seteuid(0), 0);
    }
    EXPECT_EQ(files(), 0);
}

TEST_F(AtomicFile, WhatCannotBeWrittenIsSaidBeforehandInTheSameWords)
{
    fs::create_directory(folder / "run.json");
    write_text_atomically(folder / "file", "");
    const std::map<std::string, std::string> reasons{
        {"run.json", "Is a directory"}, {"file/a", "Not a directory"}, {"none/a", "No such file or directory"}};
    for (const auto& [name, reason] : reasons) {
        const std::string path = folder / name, refusal = path + ": cannot be written: " + reason;
        EXPECT_EQ(refusal_of([&] { analysis::require_writable(path); }), refusal);
        EXPECT_EQ(refusal_of([&] { write_text_atomically(path, "{}"); }), refusal);
    }
    EXPECT_EQ(files(), 2);
    EXPECT_NO_THROW(analysis::require_writable(folder / "metrics.csv"));
    EXPECT_NO_THROW(analysis::require_writable(folder / "file"));
    EXPECT_EQ(files(), 2);
}

// A limit on file sizes simulates a full disk: write() ends early with an error.
TEST_F(AtomicFile, FullDiskKeepsTheOldFile)
{
    const std::string path = folder / "metrics.csv";
    write_text_atomically(path, "old\n");
    const auto before = std::signal(SIGXFSZ, SIG_IGN);
    rlimit usual;
    getrlimit(RLIMIT_FSIZE, &usual);
    const rlimit small{1000, usual.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(write_text_atomically(path, std::string(5000, 'x')), pbs::InputError);
    setrlimit(RLIMIT_FSIZE, &usual);
    std::signal(SIGXFSZ, before);
    EXPECT_EQ(read_text(path), "old\n");
    EXPECT_EQ(files(), 1);
}

// A process that has ended and been waited for, so its number belongs to no process.
pid_t ended_process()
{
    const pid_t process = fork();
    if (process == 0) _exit(0);
    waitpid(process, nullptr, 0);
    return process;
}

TEST_F(AtomicFile, WhatKilledWritersLeftIsRemovedAndNothingElse)
{
    const std::string gone = std::to_string(ended_process()), here = std::to_string(getpid());
    fs::create_directory(folder / "frames");
    const fs::path deeper = folder / "frames" / (".pbs_000001.vtu." + gone + ".aB3xYz");
    write_text_atomically(deeper, "half");
    for (const std::string& name :
         {".run.json." + gone + ".aB3xYz", ".limb.msh." + gone + ".a1b2c3", ".run.json." + here + ".aB3xYz",
          ".notes." + gone + ".txt", "run.json." + gone + ".aB3xYz"})
        write_text_atomically(folder / name, "half");
    analysis::remove_abandoned_files(folder, false);
    EXPECT_EQ(files(), 4);
    EXPECT_TRUE(fs::exists(deeper));
    analysis::remove_abandoned_files(folder);
    EXPECT_FALSE(fs::exists(deeper));
    for (const std::string& name :
         {".run.json." + here + ".aB3xYz", ".notes." + gone + ".txt", "run.json." + gone + ".aB3xYz"})
        EXPECT_TRUE(fs::exists(folder / name)) << name;
    analysis::remove_abandoned_files(folder / "missing");
}

// The writer is killed while its file grows; the remaining file has the name that is searched for.
TEST_F(AtomicFile, AKilledWriterLeavesTheOldFileAndWhatIsRemoved)
{
    write_text_atomically(folder / "run.json", "old");
    const pid_t writer = fork();
    if (writer == 0) {
        std::signal(SIGXFSZ, SIG_DFL);  // kills the process in the middle of the write
        const rlimit small{1000, 1000}, no_core{0, 0};
        setrlimit(RLIMIT_CORE, &no_core);
        setrlimit(RLIMIT_FSIZE, &small);
        write_text_atomically(folder / "run.json", std::string(5000, 'x'));
        _exit(0);
    }
    int status = 0;
    waitpid(writer, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(read_text(folder / "run.json"), "old");
    EXPECT_EQ(files(), 2);
    analysis::remove_abandoned_files(folder);
    EXPECT_EQ(files(), 1);
}

TEST_F(AtomicFile, ReadingWhatIsNotThereIsRefused)
{
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    for (const fs::path& path : {folder / "missing", folder, folder / "pipe"})
        EXPECT_THROW(read_text(path), pbs::InputError) << path;
}

// Reference: the files created by the test. Since root may do everything that modes forbid, a folder takes the place of
// a file to be removed, and the reverse.

using test_support::ScratchFolder;

TEST(FolderFiles, ARecordIsRemovedAndOneThatStaysIsNamedWithTheReason)
{
    const ScratchFolder folder;
    const std::string record = folder.file("run.json", "{}");
    for (int k = 0; k < 2; ++k) {
        analysis::remove_record(record);
        EXPECT_FALSE(fs::exists(record));
    }
    fs::create_directories(folder / "run.json/kept");
    EXPECT_EQ(refusal_of([&] { analysis::remove_record(record); }),
              record + ": an earlier run's record cannot be removed: Directory not empty");
}

TEST(FolderFiles, FilesOfAFolder)
{
    const ScratchFolder folder;
    folder.file("b", "");
    folder.file("a", "");
    std::vector<fs::path> files = analysis::files_in(folder.path());
    std::sort(files.begin(), files.end());
    EXPECT_EQ(files, (std::vector<fs::path>{folder / "a", folder / "b"}));
    const std::string file = folder / "a";
    EXPECT_EQ(refusal_of([&] { analysis::files_in(file); }), file + ": the folder cannot be read: Not a directory");
}

// Reference: Unicode's definition of UTF-8 (RFC 3629).

TEST(TemporaryFolder, RemovesThoseOfProcessesThatAreGoneAndNothingElse)
{
    const ScratchFolder parent;
    const fs::path abandoned = parent.path() / ("pbskin_" + std::to_string(ended_process()) + "_abcdef");
    const fs::path own = parent.path() / ("pbskin_" + std::to_string(getpid()) + "_abcdef"),
                   other = parent.path() / "pbskin_notes";
    for (const fs::path& folder : {abandoned / "deep", own, other}) fs::create_directories(folder);
    setenv("TMPDIR", parent.path().c_str(), 1);
    const analysis::ScratchFolder folder;
    unsetenv("TMPDIR");
    EXPECT_EQ(folder.path().parent_path(), parent.path());
    EXPECT_FALSE(fs::exists(abandoned));
    EXPECT_TRUE(fs::exists(own) && fs::exists(other) && fs::exists(folder.path()));
}

TEST(RecordText, KnowsUtf8AndANameThatIsNotLosesNothingElse)
{
    for (const char* text : {"", "limb", "Gelenk \xc3\xa4", "\xe2\x82\xac", "\xf0\x9d\x84\x9e"})
        EXPECT_TRUE(analysis::is_utf8(text)) << text;
    for (const char* text : {"\xff", "limb\xfe", "\xc3", "\xc0\xaf", "\xed\xa0\x80", "\xf5\x80\x80\x80"})
        EXPECT_FALSE(analysis::is_utf8(text)) << text;
    const auto record = nlohmann::json::parse(analysis::record_text({{"name", "li\xffmb"}, {"frames", 3}}));
    EXPECT_EQ(record.at("name"), "li\xef\xbf\xbdmb");
    EXPECT_EQ(record.at("frames"), 3);
}

}  // namespace
