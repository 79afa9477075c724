// Reference: what the stand-in programs do, shell scripts in the place of ccx.
#include "reference_fem/verification/calculix/calculix_run.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <ostream>

namespace {

using namespace reference_fem;

class CalculixStandIn : public testing::Test {
protected:
    std::string program(const std::string& script)
    {
        const std::string path = folder_.file("ccx", "#!/bin/sh\n" + script);
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
        return path;
    }
    static CalculixRun run(const std::string& program, double seconds = 20.0)
    {
        return run_calculix(program, [](std::ostream& deck) { deck << "the deck"; }, {seconds});
    }

    test_support::ScratchFolder folder_;
};

TEST_F(CalculixStandIn, GetsTheDeckAndItsFilesComeBack)
{
    const CalculixRun result = run(program("cp $2.inp $2.dat; echo $1 $2; echo raw > deck.rout\n"));
    EXPECT_EQ(result.outcome, CalculixOutcome::finished);
    EXPECT_EQ(result.printed, "the deck");
    EXPECT_EQ(result.restart, "raw\n");
    EXPECT_EQ(result.output, "-i deck\n");
    EXPECT_GT(result.wall_s, 0.0);
}

TEST_F(CalculixStandIn, RunsOnOneThreadInAFolderOfItsOwnThatIsRemoved)
{
    const CalculixRun result = run(program("echo $OMP_NUM_THREADS $OPENBLAS_NUM_THREADS; pwd\n"));
    std::istringstream output(result.output);
    std::string threads, path;
    std::getline(output, threads);
    std::getline(output, path);
    EXPECT_EQ(threads, "1 1");
    EXPECT_NE(path, std::filesystem::current_path().string());
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(CalculixStandIn, ErrorsAreRefusals)
{
    EXPECT_EQ(run(program("exit 201\n")).outcome, CalculixOutcome::refused);
    EXPECT_EQ(run(program("echo ' *ERROR reading *NODE'\n")).outcome, CalculixOutcome::refused);
    EXPECT_EQ(run(program("kill -9 $$\n")).outcome, CalculixOutcome::refused);
}

TEST_F(CalculixStandIn, TheTimeLimitHolds)
{
    const CalculixRun result = run(program("exec sleep 30\n"), 0.1);
    EXPECT_EQ(result.outcome, CalculixOutcome::out_of_time);
    EXPECT_LT(result.wall_s, 10.0);
}

TEST_F(CalculixStandIn, ProcessorTimeIsThatOfTheProgram)
{
    EXPECT_LT(run(program("exec sleep 0.3\n")).cpu_s, 0.2);
    EXPECT_GT(run(program("i=0; while [ $i -lt 30000 ]; do i=$((i+1)); done\n")).cpu_s, 0.002);
}

TEST_F(CalculixStandIn, AProgramThatIsNoneIsNotStarted)
{
    EXPECT_EQ(run(folder_ / "none").outcome, CalculixOutcome::not_started);
    EXPECT_EQ(run(folder_.file("text", "no program")).outcome, CalculixOutcome::not_started);
}

TEST_F(CalculixStandIn, IsFoundOnThePath)
{
    const std::string before = std::getenv("PATH");
    setenv("PATH", folder_.path().c_str(), 1);
    EXPECT_EQ(calculix_on_path(), std::nullopt);
    const std::string path = program("echo 'This is Version 9.8_7'\n");
    EXPECT_EQ(calculix_on_path(), path);
    EXPECT_EQ(calculix_version(path), "CalculiX 9.8_7");
    std::filesystem::permissions(path, std::filesystem::perms::owner_read);
    EXPECT_EQ(calculix_on_path(), std::nullopt);
    setenv("PATH", "", 1);
    EXPECT_EQ(calculix_on_path(), std::nullopt);
    setenv("PATH", before.c_str(), 1);
}

TEST(LastWords, AreTheEndWithoutBlankLines)
{
    EXPECT_EQ(last_words("one\ntwo\n\n"), "one\ntwo");
    EXPECT_EQ(last_words(" \n"), "");
    std::string text = "end", last = text;
    text.insert(0, 1000, 'a');
    last.insert(0, 397, 'a');
    EXPECT_EQ(last_words(text), last);
}

}  // namespace
