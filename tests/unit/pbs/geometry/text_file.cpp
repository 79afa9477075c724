// Reference: the bytes that were written.
#include "pbs/geometry/text_file.hpp"

#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <sys/stat.h>

namespace {

using namespace pbs;

TEST(ReadTextFile, IsWholeAndToTheByte)
{
    const test_support::ScratchFolder folder;
    const std::string bytes("a\r\n\0b\n", 6);
    EXPECT_EQ(read_text_file(folder.file("bytes", bytes)), bytes);
}

TEST(ReadTextFile, RefusesWhatCannotBeOpened)
{
    const test_support::ScratchFolder folder;
    const std::string none = (folder.path() / "none").string();
    expect_input_error([&] { read_text_file(none); }, none + ": ", "cannot be opened: No such file or directory");
    expect_input_error([&] { read_text_file(folder.path().string()); }, folder.path().string(), "cannot be opened: expected a file");
}

TEST(ReadTextFile, WaitsForNoPipeAndReadsNoDevice)
{
    const test_support::ScratchFolder folder;
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    for (const std::string& endless : {folder / "pipe", std::string("/dev/zero")})
        expect_input_error([&] { read_text_file(endless); }, endless + ": ", "cannot be opened: expected a file");
}

TEST(ReadTextFile, RefusesTooLargeAFileByItsSize)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder.file("text", "four");
    EXPECT_EQ(read_text_file(path, 4), "four");
    expect_input_error([&] { read_text_file(path, 3); }, path + ": bytes = 4: ", "expected at most 3");
    std::filesystem::resize_file(path, std::uintmax_t(1) << 36);  // a hole, which is read as that many zeros
    expect_input_error([&] { read_text_file(path); }, path + ": bytes = 68719476736: ", "expected at most 268435456");
}

}  // namespace
