// Compares two tables of the same quantities, row by row: the record of one machine and the results of another, or
// those before and after a change.
//   const TableComparison compared = compare_tables("measurements.csv", read_csv(record), read_csv(here));
//   for (const CellDifference& difference : compared.differing) ...
// Rows are found by their settings: texts, and numbers such as vertices or k_stretch. All other cells are results.
// Counts and texts have to be equal. Numbers agree within the tolerances below, or to the last digit of a record that
// is rounded. Times and what else belongs to the machine are not compared.
#pragma once

#include "analysis/records/tables.hpp"

#include <string>
#include <vector>

namespace analysis {

// The relative tolerances of two computations of one number in another order of rounding. Measured on two systems: at
// most 1e-9 in double precision, and 1.1e-6 where a linear system of finite elements is solved. In single precision,
// the rounding of 6e-8 grows over 24 iterations and the dozens of constraints of a vertex.
inline constexpr double same_in_double = 1e-9, same_in_single = 1e-5, same_by_finite_elements = 1e-5;
inline constexpr double same_frame_points = 1e-4;  // of a volume or an error of a frame, in percentage points
// The tolerance for the error of a method that minimises an energy in single precision, in percentage points of the
// displacement. Such a method ends where a step changes the energy by less than the rounding of the energy, which is
// 2^-24 of it. The energy grows with the square of the distance from the minimum, so that the shape is then known to
// sqrt(2 * 2^-24) of the displacement.
inline constexpr double same_minimum_points = 100.0 * 3.453e-4;

struct CellDifference {
    std::string row, column, first, second;  // the row's settings; the cells as the files have them
};

// A row that both tables have.
struct ComparedRow {
    std::string settings;            // by which it is found
    int first = 0, second = 0;       // its places
    int numbers = 0, differing = 0;  // results that were compared
    int equal = 0;                   // of these, in every digit that both files have
};

struct TableComparison {
    std::vector<ComparedRow> rows = {};
    std::vector<std::string> only_first = {}, only_second = {};                  // the settings of further rows
    std::vector<std::string> columns_only_first = {}, columns_only_second = {};  // which are not compared
    std::vector<CellDifference> differing = {};

    int numbers() const { return sum(&ComparedRow::numbers); }
    int equal() const { return sum(&ComparedRow::equal); }

private:
    int sum(int ComparedRow::*member) const
    {
        int total = 0;
        for (const ComparedRow& row : rows) total += row.*member;
        return total;
    }
};

struct ComparedAs {
    bool second_is_part = false;  // columns in which the second table has empty cells alone were not measured there
    bool is_rounded = false;      // one of the tables has six digits
};

// file: the name of both tables.
TableComparison compare_tables(const std::string& file, const CsvTable& first, const CsvTable& second,
                               const ComparedAs& as = {});

}  // namespace analysis
