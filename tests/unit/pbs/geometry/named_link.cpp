// Reference: the specification in named_link.hpp.
#include "pbs/geometry/named_link.hpp"

#include "tests/support/scratch_folder.hpp"
#include "tests/unit/pbs/character/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace {

namespace fs = std::filesystem;
using test_support::ScratchFolder;

// The folder for temporary files, as long as the object exists.
class TemporaryFiles {
public:
    explicit TemporaryFiles(const std::string& folder)
    {
        if (const char* before = std::getenv("TMPDIR")) before_ = before;
        setenv("TMPDIR", folder.c_str(), 1);
    }
    ~TemporaryFiles() { before_.empty() ? unsetenv("TMPDIR") : setenv("TMPDIR", before_.c_str(), 1); }
    TemporaryFiles(const TemporaryFiles&) = delete;
    TemporaryFiles& operator=(const TemporaryFiles&) = delete;

private:
    std::string before_;
};

TEST(NamedLink, IsTheFileUnderTheOtherNameAndLeavesNothing)
{
    const ScratchFolder folder, temporary;
    const std::string file = folder.file("a.txt", "text");
    const TemporaryFiles here(temporary.path());
    {
        const pbs::NamedLink link(file, ".mesh");
        EXPECT_TRUE(link.path().ends_with("/a.txt.mesh")) << link.path();
        std::string text;
        std::ifstream(link.path()) >> text;
        EXPECT_EQ(text, "text");
    }
    EXPECT_TRUE(fs::is_empty(temporary.path()));
    EXPECT_TRUE(fs::exists(file));
}

TEST(NamedLink, IsTheFileItselfIfItHasTheExtension)
{
    const ScratchFolder folder;
    const std::string file = folder.file("A.MESH", "text");
    EXPECT_EQ(pbs::NamedLink(file, ".mesh").path(), file);
}

TEST(NamedLink, AsksForAnotherNameWhereNoLinkCanBeMade)
{
    const ScratchFolder folder;
    const std::string file = folder.file("a.txt", "text");
    const TemporaryFiles nowhere(folder / "none");
    expect_input_error([&] { pbs::NamedLink(file, ".mesh"); }, file + ": extension = .txt: ", "rename the file to .mesh");
}

}  // namespace
