// Reference: the cells that each test writes, and the tolerances that the header states.
#include "analysis/records/table_comparison.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using analysis::compare_tables;
using analysis::CsvTable;
using analysis::TableComparison;

TableComparison compared(const std::string& first, const std::string& second, const std::string& file = "measurements.csv",
                         const analysis::ComparedAs& as = {})
{
    return compare_tables(file, analysis::parse_csv(first, file), analysis::parse_csv(second, file), as);
}

const std::string head = "quantity,body,k_stretch,precision,value\n";

TEST(TableComparison, OfATableWithItselfFindsEveryNumberEqual)
{
    const std::string table = head + "radius,limb,0.2,f64,1.0625\nradius,limb,0.9,f64,nan\n";
    const TableComparison same = compared(table, table);
    EXPECT_EQ(same.numbers(), 2);
    EXPECT_EQ(same.equal(), 2);
    EXPECT_TRUE(same.differing.empty() && same.only_first.empty() && same.only_second.empty());
}

TEST(TableComparison, FindsRowsByTheirSettingsInAnyOrder)
{
    const TableComparison same =
        compared(head + "radius,limb,0.2,f64,1.5\nradius,limb,0.9,f64,2.5\n", head + "radius,limb,0.90,f64,2.5\nradius,limb,0.2,f64,1.5\n");
    EXPECT_EQ(same.equal(), 2);
    EXPECT_TRUE(same.only_first.empty() && same.only_second.empty());
}

TEST(TableComparison, NamesRowsThatOneTableLacks)
{
    const TableComparison part = compared(head + "radius,limb,0.2,f64,1.5\nradius,man,0.2,f64,1.5\n", head + "radius,limb,0.2,f64,1.5\n");
    ASSERT_EQ(part.only_first.size(), 1U);
    EXPECT_EQ(part.only_first[0], "radius, man, k_stretch 0.2, f64");
    EXPECT_TRUE(part.only_second.empty());
    EXPECT_EQ(part.numbers(), 1);
}

TEST(TableComparison, TellsRowsWithTheSameSettingsApartByTheirOrder)
{
    const std::string twice = head + "radius,limb,0.2,f64,1.5\nradius,limb,0.2,f64,2.5\n";
    EXPECT_EQ(compared(twice, twice).equal(), 2);
    EXPECT_EQ(compared(twice, head + "radius,limb,0.2,f64,1.5\n").only_first.size(), 1U);
}

TEST(TableComparison, NamesANumberThatDiffersInItsTenthDigit)
{
    const TableComparison other =
        compared(head + "radius,limb,0.2,f64,1.23456789012345\n", head + "radius,limb,0.2,f64,1.23456789512345\n");
    ASSERT_EQ(other.differing.size(), 1U);
    EXPECT_EQ(other.differing[0].row, "radius, limb, k_stretch 0.2, f64");
    EXPECT_EQ(other.differing[0].column, "value");
    EXPECT_EQ(other.differing[0].second, "1.23456789512345");
}

// A last digit of rounding is within the tolerance of doubles; in single precision and by finite elements the tolerance is 1e-5.
TEST(TableComparison, AllowsTheRoundingOfEachKindOfComputation)
{
    const auto differing = [&](const std::string& row, const std::string& first, const std::string& second) {
        return compared(head + row + first + "\n", head + row + second + "\n").differing.size();
    };
    EXPECT_EQ(differing("radius,limb,0.2,f64,", "1.23456789012345", "1.23456789012999"), 0U);
    EXPECT_EQ(differing("radius,limb,0.2,f64,", "1.23456789012345", "1.23456999012345"), 1U);
    EXPECT_EQ(differing("radius,limb,0.2,f32,", "1.23456789012345", "1.23456999012345"), 0U);
    EXPECT_EQ(differing("radius_over_reference,limb,0.2,f64,", "1.23456789012345", "1.23456999012345"), 0U);
    EXPECT_EQ(differing("radius_over_reference,limb,0.2,f64,", "1.23456789012345", "1.23466789012345"), 1U);
}

// A drift of 1e-15 is nothing but rounding, relative to a momentum of 1.
TEST(TableComparison, ComparesDriftsRelativeToOne)
{
    EXPECT_TRUE(compared(head + "linear_drift,limb,,f64,1.5e-15\n", head + "linear_drift,limb,,f64,4.5e-15\n").differing.empty());
    EXPECT_EQ(compared(head + "linear_drift,limb,,f64,1.5e-15\n", head + "linear_drift,limb,,f64,4.5e-5\n").differing.size(), 1U);
}

// Six digits, where a record is rounded; a short number is exact anywhere else.
TEST(TableComparison, AllowsHalfADigitOfARoundedRecord)
{
    const auto differing = [&](const std::string& first, const std::string& second, bool is_rounded) {
        const std::string row = "radius,limb,0.2,f64,";
        const TableComparison found =
            compared(head + row + first + "\n", head + row + second + "\n", "measurements.csv", {.is_rounded = is_rounded});
        return found.differing.size();
    };
    EXPECT_EQ(differing("1.23457", "1.23456789012345", true), 0U);
    EXPECT_EQ(differing("1.23457", "1.23458123456789", true), 1U);
    EXPECT_EQ(differing("1.23457", "1.23458", true), 1U) << "both have six digits";
    EXPECT_EQ(differing("1.23457", "1.23456789012345", false), 1U);
    EXPECT_EQ(differing("0.5", "0.50000049", false), 1U);
}

TEST(TableComparison, NamesColumnsThatOneTableLacksAndSkipsThoseThatAPartDidNotMeasure)
{
    const TableComparison other = compared("body,radius_m\nlimb,1\n", "body,area_m2\nlimb,1\n");
    EXPECT_EQ(other.columns_only_first, std::vector<std::string>{"radius_m"});
    EXPECT_EQ(other.columns_only_second, std::vector<std::string>{"area_m2"});
    const std::string columns = "body,radius_m,area_m2\n", first = columns + "limb,1,2\nhuman,3,4\n";
    EXPECT_TRUE(compared(first, columns + "limb,1,\nhuman,3,\n", "a.csv", {.second_is_part = true}).differing.empty());
    EXPECT_EQ(compared(first, columns + "limb,1,2\nhuman,3,\n", "a.csv", {.second_is_part = true}).differing.size(), 1U);
    EXPECT_EQ(compared(first, columns + "limb,1,\nhuman,3,\n", "a.csv").differing.size(), 2U);
}

TEST(TableComparison, ComparesCountsAndOutcomesExactlyAndNumbersThatAreNotFiniteByName)
{
    const std::string columns = "body,outcome,inverted_tets,residual\n";
    const TableComparison other = compared(columns + "limb,finished,3,inf\n", columns + "limb,diverged,4,inf\n", "cells.csv");
    ASSERT_EQ(other.differing.size(), 2U);
    EXPECT_EQ(other.differing[0].column, "outcome");
    EXPECT_EQ(other.differing[1].column, "inverted_tets");
    EXPECT_EQ(compared(columns + "limb,finished,3,inf\n", columns + "limb,finished,3,\n", "cells.csv").differing.size(), 1U)
        << "an empty cell";
}

TEST(TableComparison, LeavesOutTimesAndColumnsThatOneTableLacks)
{
    const TableComparison same =
        compared("body,value,total_ms,solve_s\nlimb,1.5,3.25,7\n", "body,value,total_ms,solve_s,more\nlimb,1.5,4.5,8,9\n");
    EXPECT_EQ(same.numbers(), 1);
    EXPECT_EQ(compared(head + "total_ms,limb,,f64,3.5\n", head + "total_ms,limb,,f64,4.5\n").numbers(), 0) << "a quantity that is a time";
}

// A slower clip has other numbers of its frames at the same times.
TEST(TableComparison, FindsFramesByTheirTime)
{
    const std::string columns = "deformer,frame,time_s,volume_change_pct\n";
    const TableComparison part =
        compared(columns + "pbs,0,0,0\npbs,5,0.2,-1.25\n", columns + "pbs,0,0,0\npbs,1,0.2,-1.25004\n", "metrics.csv");
    EXPECT_EQ(part.numbers(), 2);
    EXPECT_TRUE(part.differing.empty()) << "within 1e-4 points";
    EXPECT_EQ(compared(columns + "pbs,5,0.2,-1.25\n", columns + "pbs,1,0.2,-1.2504\n", "metrics.csv").differing.size(), 1U);
}

TEST(TableComparison, OfTablesWithoutRowsIsEmpty)
{
    EXPECT_EQ(compared(head, head).numbers(), 0);
    EXPECT_EQ(compared(head, head + "radius,limb,0.2,f64,1\n").only_second.size(), 1U);
}

}  // namespace
