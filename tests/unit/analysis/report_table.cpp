#include "analysis/report_table.hpp"

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

}  // namespace
