// Reference: the bytes that were written. Two objects share their bytes if they return the same address. The pauses are
// longer than a tick of the file system's clock.

#include "pbs/system/source_file.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/unit/experiments/characters/expect_input_error.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

namespace {

using SourceFile = test_support::FolderTest;

void wait_for_the_clock()
{
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
}

TEST_F(SourceFile, IsReadOnceWhileOneExistsByAnyOfItsNames)
{
    const std::string path = folder.file("arm.msh", "bytes"), link = folder / "link.msh";
    std::filesystem::create_symlink(path, link);
    wait_for_the_clock();
    const pbs::SourceFile file(path);
    EXPECT_EQ(file.beginning(), "bytes");
    EXPECT_EQ(&file.text(), &pbs::SourceFile(path).text());
    EXPECT_EQ(&file.text(), &pbs::SourceFile(link).text());
    EXPECT_FALSE(file.was_changed());
}

TEST_F(SourceFile, KeepsItsBytesWhereTheFileChangesAndOthersReadTheNewOnes)
{
    const std::string path = folder.file("arm.msh", "old");
    for (const bool waits : {true, false}) {
        if (waits) wait_for_the_clock();
        const pbs::SourceFile file(path);
        const std::string before = file.text();
        file.set_safe_for("tets");
        EXPECT_TRUE(file.is_safe_for("tets"));
        folder.file("arm.msh", waits ? "new" : "one");  // of the same length
        EXPECT_EQ(file.text(), before);
        EXPECT_TRUE(file.was_changed());
        EXPECT_NE(pbs::SourceFile(path).text(), before);
        EXPECT_FALSE(pbs::SourceFile(path).is_safe_for("tets"));
    }
    const pbs::SourceFile gone(path);
    EXPECT_EQ(gone.text(), "one");
    std::filesystem::remove(path);
    EXPECT_TRUE(gone.was_changed());
    EXPECT_EQ(gone.text(), "one");
}

TEST_F(SourceFile, RefusesWhatCannotBeReadOrIsTooLarge)
{
    const pbs::SourceFile none(folder / "none"), large(folder.file("large", std::string(5000, 'x')));
    EXPECT_EQ(none.beginning(), "");
    expect_input_error([&] { none.text(); }, folder / "none", "cannot be opened: No such file or directory");
    EXPECT_EQ(large.beginning(), std::string(4096, 'x'));
    expect_input_error([&] { large.text(4999); }, folder / "large", "expected at most 4999");
    EXPECT_EQ(large.text(5000), std::string(5000, 'x'));
}

}  // namespace
