// Records as CSV (RFC 4180): named columns, numbers that round-trip (the shortest text that reads back to the same double; nan, inf and
// -inf by name), and files that are written as a whole or not at all.
//   CsvTable table{{"frame", "volume_change_pct"}};  table.add_row({0, -0.25});  table.write("metrics.csv");
//   const CsvTable table = read_csv("metrics.csv");  double change = table.number(0, "volume_change_pct");
#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace analysis {

std::string number_text(double value);  // shortest that round-trips; nan, inf, -inf

// Cells are kept as text; rows count from 0. std::out_of_range for a row that does not exist.
class CsvTable {
public:
    // A text, a number, or no value (nullopt), which is an empty cell.
    struct Cell {
        enum class Kind { nothing, text, whole, real };

        Cell(std::nullopt_t) {}
        Cell(const char* text) : Cell(std::string(text)) {}
        Cell(std::string text) : kind(Kind::text), text(std::move(text)) {}
        Cell(double value);
        template <std::integral Whole>
        Cell(Whole value) : kind(Kind::whole), text(std::to_string(value)), whole(value)
        {
        }

        Kind kind = Kind::nothing;
        std::string text;  // as the file has it
        long long whole = 0;
        double real = 0.0;
    };

    explicit CsvTable(std::vector<std::string> columns);  // a table without rows

    void add_row(const std::vector<Cell>& cells);  // std::logic_error unless there is one cell per column
    // Appends all rows of another table with the same columns; a table without columns adopts those of the other. InputError for different
    // columns.
    //   CsvTable all{{}};  for (const CsvTable& table : of_runs) all.append(table);
    void append(const CsvTable& other);
    std::string text() const;                   // the whole file, column names first, each line with its end
    void write(const std::string& path) const;  // atomic; InputError if it cannot be written

    const std::vector<std::string>& columns() const { return columns_; }  // names, in order
    int rows() const { return static_cast<int>(rows_.size()); }           // without the header line
    bool has_column(const std::string& name) const;                       // compares the exact name

    // Values by row and column name. InputError file:line:column for a missing column or a value of another kind. `column` in the message
    // is the position of the field in its row, from 1.
    const std::string& text_at(int row, const std::string& column) const;
    double number(int row, const std::string& column) const;                            // nan and inf are allowed
    long long integer(int row, const std::string& column) const;                        // without a fraction
    std::optional<double> number_or_nothing(int row, const std::string& column) const;  // nothing for an empty cell
    std::vector<double> numbers(const std::string& column) const;                       // #rows
    // InputError file:line:column with the cell's value.
    [[noreturn]] void refuse(int row, const std::string& column, const std::string& rule) const;

private:
    friend CsvTable parse_csv(const std::string& text, const std::string& file);

    int index_of(const std::string& column) const;

    std::string file_;  // the file that was read, for messages
    std::vector<std::string> columns_;
    std::vector<std::vector<std::string>> rows_;
    std::vector<int> lines_;  // the line at which each row begins in the file
};

// InputError file:line:column for a file that is empty or cut off, has a row of another length, a duplicate column or broken quotes.
CsvTable parse_csv(const std::string& text, const std::string& file);
CsvTable read_csv(const std::string& path);  // InputError as for read_text and parse_csv

}  // namespace analysis
