// What a run says. Reference: the rule of remark.hpp, by hand.
#include "experiments/run/run_remarks.hpp"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <sstream>

namespace {

using namespace experiments;
using pbs::Gravity;
using Texts = std::vector<std::string>;

// What is printed while it exists, a line each.
class PrintedLines {
public:
    PrintedLines() : before_(spdlog::default_logger())
    {
        auto logger = std::make_shared<spdlog::logger>("", std::make_shared<spdlog::sinks::ostream_sink_mt>(text_));
        logger->set_pattern("%v");
        spdlog::set_default_logger(logger);
    }
    ~PrintedLines() { spdlog::set_default_logger(before_); }

    std::string text() const { return text_.str(); }

private:
    std::ostringstream text_;
    std::shared_ptr<spdlog::logger> before_;
};

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

// A user who can stop the run hears of it at once; what is only known to be among the gravest at the end comes there, and nothing twice.
TEST(RunRemarks, ArePrintedOnceAndTheGravestAtOnce)
{
    const PrintedLines printed;
    {
        RunRemarks remarks;
        remarks.add(Gravity::part_left_out, {"x/a: 1", "x/a: 2", "x/a: 3"});
        EXPECT_EQ(printed.text(), "");
        remarks.add(Gravity::results_wrong, {"x/a: 4"});
        remarks.add(Gravity::information, {"x/a: 5"});
        const std::string at_once = "pbskin: warning: x/a: 4\npbskin: note: x/a: 5\n";
        EXPECT_EQ(printed.text(), at_once);
        remarks.say_all();
        EXPECT_EQ(printed.text(), at_once + "pbskin: warning: x/a: 1\npbskin: warning: x/a: 2\npbskin: note: x/a: 3\n");
    }
    EXPECT_EQ(std::ranges::count(printed.text(), '\n'), 5) << "all were said before it ended";
}

TEST(RunRemarks, AreSaidWhereARunIsInterrupted)
{
    const PrintedLines printed;
    EXPECT_ANY_THROW({
        RunRemarks remarks;
        remarks.add(Gravity::part_left_out, {"x/a: 1"});
        throw std::runtime_error("interrupted");
    });
    EXPECT_EQ(printed.text(), "pbskin: warning: x/a: 1\n");
}

}  // namespace
