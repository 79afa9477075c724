// The remarks of a run. Reference: the rule of remark.hpp, by hand.
#include "experiments/process/terminal.hpp"
#include "experiments/run/run_remarks.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <regex>
#include <stdexcept>

namespace {

using namespace experiments;
using pbs::Gravity;
using Texts = std::vector<std::string>;

// The text that was printed since the last call, without the time that comes before each line.
std::string printed()
{
    const std::string text =
        std::regex_replace(testing::internal::GetCapturedStdout(), std::regex("[^\\n]*pbskin: "), "");
    testing::internal::CaptureStdout();
    return text;
}

TEST(RunRemarks, AtMostThreeAreWarningsTheGravestFirst)
{
    RunRemarks remarks;
    remarks.add(Gravity::part_left_out, {"a: 1", "a: 2"});
    remarks.add(Gravity::information, {"a: 3"});
    remarks.add(Gravity::comparison_wrong, {"a: 4"});
    remarks.add({{Gravity::part_left_out, "a: 5"}, {Gravity::results_wrong, "a: 6"}});
    EXPECT_EQ(remarks.warnings(), (Texts{"a: 6", "a: 4", "a: 1"}));
    EXPECT_EQ(remarks.notes(), (Texts{"a: 2", "a: 5", "a: 3"}));
}

TEST(RunRemarks, FewerThanThreeLeaveNotesAsTheyAre)
{
    RunRemarks remarks({.warnings = {"folder/a.glb: 1"}, .notes = {"b: 2"}});
    remarks.add(Gravity::comparison_wrong, {"other/a.glb: 1"});
    EXPECT_EQ(remarks.warnings(), Texts{"a.glb: 1"}) << "without folders, and once";
    EXPECT_EQ(remarks.notes(), Texts{"b: 2"});
}

// A user who can stop the run hears of it at once; what is only known to be among the gravest at the end comes there,
// and nothing twice.
TEST(RunRemarks, ArePrintedOnceAndTheGravestAtOnce)
{
    testing::internal::CaptureStdout();
    {
        RunRemarks remarks;
        remarks.add(Gravity::part_left_out, {"x/a: 1", "x/a: 2", "x/a: 3"});
        EXPECT_EQ(printed(), "");
        remarks.add(Gravity::results_wrong, {"x/a: 4"});
        remarks.add(Gravity::information, {"x/a: 5"});
        EXPECT_EQ(printed(), "warning: x/a: 4\nnote: x/a: 5\n");
        remarks.say_all();
        EXPECT_EQ(printed(), "warning: x/a: 1\nwarning: x/a: 2\nnote: x/a: 3\n");
    }
    EXPECT_EQ(printed(), "") << "all were said before it ended";
    testing::internal::GetCapturedStdout();
}

TEST(RunRemarks, AreSaidByTheSignalThatEndsTheProgram)
{
    const auto interrupted_with = [](const std::string& text, const auto& use) {
        EXPECT_EXIT(
            {
                watch_interrupts();
                RunRemarks remarks;
                remarks.add(Gravity::part_left_out, {"x/a: 1"});
                use(remarks);
                std::raise(SIGTERM);
            },
            testing::ExitedWithCode(exit_interrupted), "^" + text + "pbskin: interrupted");
    };
    interrupted_with("pbskin: warning: x/a: 1\n", [](RunRemarks&) {});
    interrupted_with("", [](RunRemarks& remarks) { remarks.say_all(); });
}

TEST(RunRemarks, AreSaidWhereARunIsInterrupted)
{
    testing::internal::CaptureStdout();
    EXPECT_ANY_THROW({
        RunRemarks remarks;
        remarks.add(Gravity::part_left_out, {"x/a: 1"});
        throw std::runtime_error("interrupted");
    });
    EXPECT_EQ(printed(), "warning: x/a: 1\n");
    testing::internal::GetCapturedStdout();
}

}  // namespace
