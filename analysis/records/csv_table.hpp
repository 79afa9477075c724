// Records as CSV (RFC 4180): named columns, numbers that round-trip (the shortest text that reads back to the same double; nan, inf and
// -inf by name), whole files only.
//   CsvTable table{{"frame", "volume_change_pct"}};  table.add_row({0, -0.25});  table.write("metrics.csv");
//   const CsvTable table = read_csv("metrics.csv");  double change = table.number(0, "volume_change_pct");
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace analysis {

std::string number_text(double value);  // shortest that round-trips; nan, inf, -inf

// Cells are kept as text; rows count from 0. std::out_of_range for a row that is not there.
class CsvTable {
public:
    using Cell = std::variant<std::string, double, int, long long, std::nullopt_t>;  // nullopt: an empty cell, no value

    explicit CsvTable(std::vector<std::string> columns);  // without rows

    void add_row(const std::vector<Cell>& cells);  // std::logic_error unless there is one cell a column
    // All rows of another table of the same columns, under one head; a table without columns takes on the other's. InputError for others.
    //   CsvTable all{{}};  for (const CsvTable& table : of_runs) all.append(table);
    void append(const CsvTable& other);
    std::string text() const;                   // the whole file, column names first, each line with its end
    void write(const std::string& path) const;  // atomic; InputError where it cannot be

    const std::vector<std::string>& columns() const { return columns_; }  // names, in order
    int rows() const { return static_cast<int>(rows_.size()); }           // without the line of names
    bool has_column(const std::string& name) const;                       // exactly of that name

    // Values by row and column name; InputError file:line:column for a missing column or a value of another kind. `column` in the
    // message is the field's place in its row, from 1.
    const std::string& text_at(int row, const std::string& column) const;
    double number(int row, const std::string& column) const;                            // nan, inf too
    long long integer(int row, const std::string& column) const;                        // no fraction
    std::optional<double> number_or_nothing(int row, const std::string& column) const;  // nothing for an empty cell
    std::vector<double> numbers(const std::string& column) const;                       // #rows
    // InputError file:line:column with the cell's value.
    [[noreturn]] void refuse(int row, const std::string& column, const std::string& rule) const;

private:
    friend CsvTable parse_csv(const std::string& text, const std::string& file);

    int index_of(const std::string& column) const;

    std::string file_;  // as read, for messages
    std::vector<std::string> columns_;
    std::vector<std::vector<std::string>> rows_;
    std::vector<int> lines_;  // where each row began in the file
};

// InputError file:line:column for a file that is empty, cut off, has a row of another length, a column twice or broken quotes.
CsvTable parse_csv(const std::string& text, const std::string& file);
CsvTable read_csv(const std::string& path);  // InputError as read_text, parse_csv

}  // namespace analysis
