// Reference: the folders that the header specifies for the search for modules.
#include "pbs/geometry/module.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace {

std::string refusal(const std::string& name)
{
    try {
        pbs::load_module(name);
    } catch (const pbs::InputError& error) {
        return error.what();
    }
    return "";
}

class Modules : public ::testing::Test {
protected:
    void TearDown() override { unsetenv("PBSKIN_MODULES"); }
};

TEST_F(Modules, AMissingOneSaysWhereItWasLookedFor)
{
    const std::string words = refusal("pbskin_no_such_module");
    EXPECT_NE(words.find("libpbskin_no_such_module.so"), std::string::npos) << words;
    EXPECT_NE(words.find("/lib/pbskin"), std::string::npos) << words;
    EXPECT_NE(words.find("PBSKIN_MODULES"), std::string::npos) << words;
}

TEST_F(Modules, TheEnvironmentVariableNamesTheOnlyFolder)
{
    setenv("PBSKIN_MODULES", "/no/such/folder", 1);
    const std::string words = refusal("pbskin_no_such_module");
    EXPECT_NE(words.find("looked in /no/such/folder)"), std::string::npos) << words;
}

TEST_F(Modules, AFileThatIsNoLibraryIsRefusedInTheLoadersWords)
{
    const test_support::ScratchFolder folder;
    folder.file("libpbskin_text.so", "no library");
    setenv("PBSKIN_MODULES", folder.path().c_str(), 1);
    EXPECT_NE(refusal("pbskin_text").find("cannot be loaded"), std::string::npos) << refusal("pbskin_text");
}

TEST_F(Modules, AreLoadedOnceAndFoundBesideTheExecutable)
{
    const pbs::Module& gmsh = pbs::load_module("pbskin_gmsh");
    EXPECT_EQ(&gmsh, &pbs::load_module("pbskin_gmsh"));
    EXPECT_NE(gmsh.function<void()>("pbskin_gmsh_read"), nullptr);
}

TEST_F(Modules, AFunctionThatIsNotThereIsRefusedByName)
{
    try {
        pbs::load_module("pbskin_gmsh").function<void()>("pbskin_no_such_function");
        FAIL();
    } catch (const pbs::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("pbskin_no_such_function"), std::string::npos) << error.what();
    }
}

}  // namespace
