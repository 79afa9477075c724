// Truth: the bytes that were written.
#include "pbs/character/text_file.hpp"

#include "tests/unit/pbs/character/expect_input_error.hpp"
#include "tests/support/scratch_folder.hpp"

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
    expect_input_error([&] { read_text_file(none); }, none + ": ", "cannot be opened");
    expect_input_error([&] { read_text_file(folder.path().string()); }, folder.path().string(), "cannot be opened");
}

}  // namespace
