// Reference: the files created by the test. Since root may do everything that modes forbid, a folder takes the place of a file to be
// removed, and the reverse.
#include "analysis/records/folder_files.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using test_support::ScratchFolder;
namespace fs = std::filesystem;

template <typename Work>
std::string refusal_of(const Work& work)
{
    try {
        work();
    } catch (const pbs::InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(FolderFiles, ARecordIsRemovedWhereItIs)
{
    const ScratchFolder folder;
    const std::string record = folder.file("run.json", "{}");
    analysis::remove_record(record);
    EXPECT_FALSE(fs::exists(record));
    analysis::remove_record(record);
}

TEST(FolderFiles, OneThatStaysIsNamedWithTheReason)
{
    const ScratchFolder folder;
    fs::create_directories(folder / "run.json/kept");
    EXPECT_EQ(refusal_of([&] { analysis::remove_record(folder / "run.json"); }),
              folder / "run.json" + ": an earlier run's record cannot be removed: Directory not empty");
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

}  // namespace
