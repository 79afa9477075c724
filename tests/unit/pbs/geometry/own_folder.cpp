// Reference: the interface. A file may refer to regular files in and below its own folder.
#include "pbs/geometry/own_folder.hpp"

#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <sys/stat.h>

namespace {

class OwnFolderTest : public testing::Test {
protected:
    void SetUp() override
    {
        std::filesystem::create_directories(scratch.path() / "own" / "deeper");
        std::filesystem::create_directories(scratch.path() / "own2");
        for (const char* name : {"own/a.gltf", "own/beside.bin", "own/deeper/below.bin", "own2/similar.bin", "above.bin"})
            scratch.file(name, "x");
    }
    bool may_open(const std::string& file) const { return pbs::may_be_opened_for(scratch / "own/a.gltf", scratch / file); }

    const test_support::ScratchFolder scratch;
};

TEST_F(OwnFolderTest, AllowsTheFileItselfAndThoseBesideAndBelow)
{
    for (const char* file : {"own/a.gltf", "own/beside.bin", "own/deeper/below.bin", "own/deeper/../beside.bin", "own/./beside.bin"})
        EXPECT_TRUE(may_open(file)) << file;
}

TEST_F(OwnFolderTest, RefusesFilesElsewhereAndThoseThatDoNotExist)
{
    for (const char* file : {"above.bin", "own/../above.bin", "own2/similar.bin", "own/none.bin", "own/deeper"})
        EXPECT_FALSE(may_open(file)) << file;
    EXPECT_FALSE(pbs::may_be_opened_for(scratch / "own/a.gltf", "/etc/passwd"));
    EXPECT_FALSE(pbs::may_be_opened_for(scratch / "own/a.gltf", ""));
}

TEST_F(OwnFolderTest, FollowsLinksBeforeItDecides)
{
    std::filesystem::create_symlink(scratch / "above.bin", scratch / "own/out.bin");
    std::filesystem::create_symlink(scratch / "own/deeper/below.bin", scratch / "own/in.bin");
    EXPECT_FALSE(may_open("own/out.bin"));
    EXPECT_TRUE(may_open("own/in.bin"));
}

TEST_F(OwnFolderTest, AllowsWhatLiesBesideTheFileOrBesideALinkToIt)
{
    std::filesystem::create_symlink(scratch / "own/a.gltf", scratch / "own2/link.gltf");
    EXPECT_TRUE(pbs::may_be_opened_for(scratch / "own2/link.gltf", scratch / "own/beside.bin"));
    EXPECT_TRUE(pbs::may_be_opened_for(scratch / "own2/link.gltf", scratch / "own2/similar.bin"));
    EXPECT_FALSE(pbs::may_be_opened_for(scratch / "own2/link.gltf", scratch / "above.bin"));
}

TEST_F(OwnFolderTest, RefusesPipes)
{
    ASSERT_EQ(mkfifo((scratch / "own/pipe").c_str(), 0600), 0);
    EXPECT_FALSE(may_open("own/pipe"));
}

}  // namespace
