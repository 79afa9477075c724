// Reference: the cells that each case writes, and the tolerances that the header states.
#include "analysis/records/table_comparison.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using analysis::compare_tables;
using analysis::TableComparison;

TableComparison compared(const std::string& first, const std::string& second,
                         const std::string& file = "measurements.csv", const analysis::ComparedAs& as = {})
{
    return compare_tables(file, analysis::parse_csv(first, file), analysis::parse_csv(second, file), as);
}

const std::string head = "quantity,body,k_stretch,precision,value\n";

// A table of one value.
std::string radius_of(const std::string& value, const std::string& precision = "f64",
                      const std::string& quantity = "radius")
{
    return head + quantity + ",limb,0.2," + precision + "," + value + "\n";
}

// within: not equal, but within the tolerance.
struct ComparedCounts {
    int numbers, differing = 0, within = 0, only_first = 0, only_second = 0;
};
struct TablePair {
    const char* name;
    std::string first, second;
    ComparedCounts counts;
    std::string file = "a.csv";
    analysis::ComparedAs as = {};
};
const analysis::ComparedAs rounded = {.is_rounded = true}, part = {.second_is_part = true};

const std::string two_rows = radius_of("1.5") + "radius,limb,0.2,f64,2.5\n",
                  reference_quantity = "radius_over_reference", drift_quantity = "linear_drift",
                  programs_quantity = "largest_node_difference", sizes_head = "body,radius_m,area_m2\n",
                  outcomes_head = "body,outcome,inverted_tets,residual\n",
                  frames_head = "deformer,frame,time_s,volume_change_pct\n",
                  methods_head = "method,smooth_pct,skin_mm\n", first_of_two = sizes_head + "limb,1,2\nhuman,3,4\n";

// In doubles a last digit is rounding; in single precision and by finite elements the tolerance is 1e-5. A drift of
// 1e-15 is nothing but rounding, relative to a momentum of 1, and so is the difference of two programs. A rounded
// record has six digits; a short number is exact anywhere else. A minimum of an energy in single precision is known to
// 0.0345 points. A slower clip has other numbers of its frames at the same times.
const TablePair table_pairs[] = {
    {"a table with itself",
     radius_of("1.0625") + "radius,limb,0.9,f64,nan\n",
     radius_of("1.0625") + "radius,limb,0.9,f64,nan\n",
     {2}},
    {"rows in another order",
     radius_of("1.5") + "radius,limb,0.9,f64,2.5\n",
     head + "radius,limb,0.90,f64,2.5\nradius,limb,0.2,f64,1.5\n",
     {2}},
    {"rows of the same settings by their order", two_rows, two_rows, {2}},
    {"one of two rows of the same settings", two_rows, radius_of("1.5"), {1, 0, 0, 1}},
    {"no rows", head, head, {0}},
    {"another processor", "body,cpu_model,radius_m\nlimb,one,1.5\n", "body,cpu_model,radius_m\nlimb,other,1.5\n", {1}},
    {"a row that the first lacks", head, radius_of("1"), {0, 0, 0, 0, 1}},
    {"the tenth digit", radius_of("1.23456789012345"), radius_of("1.23456789512345"), {1, 1}},
    {"the last digits", radius_of("1.23456789012345"), radius_of("1.23456789012999"), {1, 0, 1}},
    {"the seventh digit", radius_of("1.23456789012345"), radius_of("1.23456999012345"), {1, 1}},
    {"the seventh digit in float",
     radius_of("1.23456789012345", "f32"),
     radius_of("1.23456999012345", "f32"),
     {1, 0, 1}},
    {"the seventh digit by finite elements",
     radius_of("1.23456789012345", "f64", reference_quantity),
     radius_of("1.23456999012345", "f64", reference_quantity),
     {1, 0, 1}},
    {"the fifth digit by finite elements",
     radius_of("1.23456789012345", "f64", reference_quantity),
     radius_of("1.23466789012345", "f64", reference_quantity),
     {1, 1}},
    {"a drift by rounding",
     radius_of("1.5e-15", "f64", drift_quantity),
     radius_of("4.5e-15", "f64", drift_quantity),
     {1, 0, 1}},
    {"a drift", radius_of("1.5e-15", "f64", drift_quantity), radius_of("4.5e-5", "f64", drift_quantity), {1, 1}},
    {"a difference of two programs by rounding",
     radius_of("1.5e-13", "f64", programs_quantity),
     radius_of("4.5e-13", "f64", programs_quantity),
     {1, 0, 1}},
    {"a difference of two programs",
     radius_of("1.5e-13", "f64", programs_quantity),
     radius_of("4.5e-8", "f64", programs_quantity),
     {1, 1}},
    {"half a digit of a rounded record", radius_of("1.23457"), radius_of("1.23456789012345"), {1}, "a.csv", rounded},
    {"more than half a digit", radius_of("1.23457"), radius_of("1.23458123456789"), {1, 1}, "a.csv", rounded},
    {"six digits on both sides", radius_of("1.23457"), radius_of("1.23458"), {1, 1}, "a.csv", rounded},
    {"six digits of a record that is not rounded", radius_of("1.23457"), radius_of("1.23456789012345"), {1, 1}},
    {"a short number", radius_of("0.5"), radius_of("0.50000049"), {1, 1}},
    {"a column that a part did not measure", first_of_two, sizes_head + "limb,1,\nhuman,3,\n", {2}, "a.csv", part},
    {"a column that a part lacks in a row", first_of_two, sizes_head + "limb,1,2\nhuman,3,\n", {4, 1}, "a.csv", part},
    {"a column that is empty", first_of_two, sizes_head + "limb,1,\nhuman,3,\n", {4, 2}},
    {"an outcome and a count",
     outcomes_head + "limb,finished,3,inf\n",
     outcomes_head + "limb,diverged,4,inf\n",
     {3, 2},
     "cells.csv"},
    {"an empty cell",
     outcomes_head + "limb,finished,3,inf\n",
     outcomes_head + "limb,finished,3,\n",
     {3, 1},
     "cells.csv"},
    {"times",
     "body,value,total_ms,solve_s\nlimb,1.5,3.25,7\n",
     "body,value,total_ms,solve_s,more\nlimb,1.5,4.5,8,9\n",
     {1}},
    {"a quantity that is a time", radius_of("3.5", "f64", "total_ms"), radius_of("4.5", "f64", "total_ms"), {0}},
    {"frames by their time",
     frames_head + "pbs,0,0,0\npbs,5,0.2,-1.25\n",
     frames_head + "pbs,0,0,0\npbs,1,0.2,-1.25004\n",
     {2, 0, 1},
     "metrics.csv"},
    {"a method in single precision",
     methods_head + "dqs,1.23456789,2\n",
     methods_head + "dqs,1.23456999,2\n",
     {2, 0, 1},
     "errors.csv"},
    {"more than that", methods_head + "dqs,1.23456789,2\n", methods_head + "dqs,1.23466789,2\n", {2, 1}, "errors.csv"},
    {"a minimum in single precision",
     methods_head + "vbd,1.25,2\n",
     methods_head + "vbd,1.28,2.05\n",
     {2, 0, 2},
     "errors.csv"},
    {"another minimum", methods_head + "vbd,1.25,2\n", methods_head + "vbd,1.29,2.06\n", {2, 2}, "errors.csv"},
    {"more than 1e-4 points",
     frames_head + "pbs,5,0.2,-1.25\n",
     frames_head + "pbs,1,0.2,-1.2504\n",
     {1, 1},
     "metrics.csv"},
};

TEST(TableComparison, FindsWhatDiffersBeyondTheRoundingOfItsComputation)
{
    for (const auto& [name, first, second, counts, file, as] : table_pairs) {
        SCOPED_TRACE(name);
        const TableComparison found = compared(first, second, file, as);
        EXPECT_EQ(found.numbers(), counts.numbers);
        EXPECT_EQ(found.equal(), counts.numbers - counts.differing - counts.within);
        EXPECT_EQ(std::ssize(found.differing), counts.differing);
        EXPECT_EQ(std::ssize(found.only_first), counts.only_first);
        EXPECT_EQ(std::ssize(found.only_second), counts.only_second);
    }
}

TEST(TableComparison, NamesRowsColumnsAndNumbers)
{
    using Names = std::vector<std::string>;
    EXPECT_EQ(compared(two_rows + "radius,man,0.2,f64,1.5\n", two_rows).only_first,
              Names{"radius, man, k_stretch 0.2, f64"});
    const auto number = compared(radius_of("1.23456789012345"), radius_of("1.23456789512345")).differing.at(0);
    EXPECT_EQ(number.row, "radius, limb, k_stretch 0.2, f64");
    EXPECT_EQ(number.column, "value");
    EXPECT_EQ(number.second, "1.23456789512345");
    const TableComparison columns = compared("body,radius_m\nlimb,1\n", "body,area_m2\nlimb,1\n");
    EXPECT_EQ(columns.columns_only_first, Names{"radius_m"});
    EXPECT_EQ(columns.columns_only_second, Names{"area_m2"});
    const auto differing =
        compared(outcomes_head + "limb,finished,3,inf\n", outcomes_head + "limb,diverged,4,inf\n", "cells.csv")
            .differing;
    EXPECT_EQ(differing.at(0).column + " " + differing.at(1).column, "outcome inverted_tets");
}

}  // namespace
