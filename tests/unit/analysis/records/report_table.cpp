#include "analysis/records/report_table.hpp"
#include "pbs/geometry/input_error.hpp"

#include <gtest/gtest.h>

namespace {

using analysis::CsvTable;
using analysis::ReportColumn;

const std::vector<ReportColumn> columns = {{"body", "body"}, {"step [ms]", "step_s", "{:.1f}", 1e3, "-"}};

CsvTable table()
{
    CsvTable table({"step_s", "body", "unused"});
    table.add_row({0.0125, "limb", 1});
    table.add_row({std::nullopt, "lady", 2});
    return table;
}

TEST(ReportTable, MarkdownHasOneRuleBelowTheHeadingsAndAScaledNumberPerRow)
{
    EXPECT_EQ(markdown_table(table(), columns), "| body | step [ms] |\n|---|---|\n| limb | 12.5 |\n| lady | - |\n");
}

TEST(ReportTable, ColumnsUnderTheirOwnNames)
{
    EXPECT_EQ(markdown_table(table(), analysis::report_columns("body step_s:.2f")),
              "| body | step_s |\n|---|---|\n| limb | 0.01 |\n| lady |  |\n");
}

TEST(ReportTable, TextAlignsWordsLeftAndNumbersRight)
{
    EXPECT_EQ(text_table(table(), columns),
              "body  step [ms]\n"
              "limb       12.5\n"
              "lady          -\n");
}

TEST(ReportTable, ARecordWithoutRowsIsItsHeadings)
{
    EXPECT_EQ(text_table(CsvTable({"body", "step_s"}), columns), "body  step [ms]\n");
    EXPECT_EQ(markdown_table(CsvTable({"body", "step_s"}), columns), "| body | step [ms] |\n|---|---|\n");
}

TEST(ReportTable, AMissingColumnAndTextUnderAFormatAreRefused)
{
    EXPECT_THROW(text_table(table(), {{"step", "step_ms"}}), pbs::InputError);
    EXPECT_THROW(text_table(table(), {{"body", "body", "{:g}"}}), pbs::InputError);
}

// Reference: the definition. No line is longer than requested, every word is there and in order, and columns begin at the same position.

using namespace analysis;

TEST(TextColumns, BreaksBetweenWords)
{
    EXPECT_EQ(wrapped("one two three", 7), (std::vector<std::string>{"one two", "three"}));
    EXPECT_EQ(wrapped("one two three", 6), (std::vector<std::string>{"one", "two", "three"}));
    EXPECT_TRUE(wrapped("", 6).empty());
}

TEST(TextColumns, BreaksAWordThatIsLonger)
{
    EXPECT_EQ(wrapped("a abcdefgh", 3), (std::vector<std::string>{"a", "abc", "def", "gh"}));
}

TEST(TextColumns, KeepsLineBreaks)
{
    EXPECT_EQ(wrapped("one\ntwo", 20), (std::vector<std::string>{"one", "two"}));
}

TEST(TextColumns, CountsCharactersNotBytes)
{
    EXPECT_EQ(characters("90\u00b0 \u2264"), 5u);
    EXPECT_EQ(wrapped("\u2264\u2264 \u2264\u2264", 5), (std::vector<std::string>{"\u2264\u2264 \u2264\u2264"}));
    EXPECT_EQ(wrapped("\u2264\u2264\u2264", 2), (std::vector<std::string>{"\u2264\u2264", "\u2264"}));
}

TEST(TextColumns, ColumnsBeginAtTheSamePlace)
{
    EXPECT_EQ(side_by_side({{"a", 2}, {"\u2264 and more", 5}, {"end of it", 6}}), "a   \u2264 and  end of\n    more   it\n");
}

TEST(TextColumns, AColourTakesNoRoom)
{
    EXPECT_EQ(side_by_side({{"a b", 1, "\033[31m"}, {"c", 1}}), "\033[31ma\033[0m  c\n\033[31mb\033[0m\n");
}

}  // namespace

// Reference: the definition, on small texts.

TEST(PlainMarkdown, FillsParagraphsAndLeavesOutCommentsAndLinks)
{
    EXPECT_EQ(plain_text("# A title\n\nOne [page](../page.md) has\n`code` in it.\n\n<!-- kept:begin -->\n\n## Next\n", 20),
              "A title\n\nOne page has code in\nit.\n\nNext\n");
}

TEST(PlainMarkdown, IndentsItems)
{
    EXPECT_EQ(plain_text("- one two three four\n  five\n- six\n1. seven\n", 16), "-  one two three\n   four five\n-  six\n1.  seven\n");
}

TEST(PlainMarkdown, KeepsCodeUnlessItIsTooLong)
{
    EXPECT_EQ(plain_text("    a  =  b\n    c = d (and more)\n", 14), "    a  =  b\nc = d (and\nmore)\n");
}

TEST(PlainMarkdown, SetsTablesInColumns)
{
    EXPECT_EQ(plain_text("| a | b |\n|---|---|\n| 1 | two words |\n\nend\n", 30), "a  b\n1  two words\n\nend\n");
    EXPECT_EQ(plain_text("| a | b |\n|---|---|\n| 1 | two words |\n", 9), "a  b\n1  two\n   words\n");
}

TEST(PlainMarkdown, FindsTheFirstParagraph)
{
    EXPECT_EQ(first_paragraph("# volume\n\nHow much\nis lost?\n\nMore.\n"), "How much is lost?");
}
