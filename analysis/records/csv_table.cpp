#include "analysis/records/csv_table.hpp"

#include "analysis/records/atomic_file.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace analysis {
namespace {

std::string quoted_where_needed(const std::string& field)
{
    if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
    std::string quoted = "\"";
    for (char c : field) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string line_of(const std::vector<std::string>& fields)
{
    if (fields.size() == 1 && fields[0].empty()) return "\"\"\n";  // distinguishes a row of one empty field from an empty line
    std::vector<std::string> quoted;
    for (const std::string& field : fields) quoted.push_back(quoted_where_needed(field));
    return fmt::format("{}\n", fmt::join(quoted, ","));
}

template <typename Number>
bool reads_whole(const std::string& text, Number& value)
{
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc{} && stop == end;
}

}  // namespace

std::string number_text(double value)
{
    return std::isnan(value) ? "nan" : fmt::format("{}", value);
}

CsvTable::Cell::Cell(double value) : kind(Kind::real), text(number_text(value)), real(value)
{
}

CsvTable::CsvTable(std::vector<std::string> columns) : columns_(std::move(columns))
{
}

void CsvTable::add_row(const std::vector<Cell>& cells)
{
    if (cells.size() != columns_.size())
        throw std::logic_error{fmt::format("a row of {} cells in a table of {} columns", cells.size(), columns_.size())};
    std::vector<std::string> fields;
    for (const Cell& cell : cells) fields.push_back(cell.text);
    rows_.push_back(std::move(fields));
    lines_.push_back(rows() + 1);
}

void CsvTable::append(const CsvTable& other)
{
    if (columns_.empty()) columns_ = other.columns_;
    if (columns_ != other.columns_)
        throw pbs::InputError(other.file_, 1, "columns", fmt::format("{}", fmt::join(other.columns_, ",")),
                              fmt::format("expected those of the tables before: {}", fmt::join(columns_, ",")));
    rows_.insert(rows_.end(), other.rows_.begin(), other.rows_.end());
    while (lines_.size() < rows_.size()) lines_.push_back(static_cast<int>(lines_.size()) + 2);
}

std::string CsvTable::text() const
{
    std::string text = line_of(columns_);
    for (const auto& row : rows_) text += line_of(row);
    return text;
}

void CsvTable::write(const std::string& path) const
{
    write_text_atomically(path, text());
}

bool CsvTable::has_column(const std::string& name) const
{
    return std::find(columns_.begin(), columns_.end(), name) != columns_.end();
}

int CsvTable::index_of(const std::string& column) const
{
    const auto found = std::find(columns_.begin(), columns_.end(), column);
    if (found == columns_.end())
        throw pbs::InputError(file_, 1, "columns", fmt::format("{}", fmt::join(columns_, ",")), "expected a column " + column);
    return static_cast<int>(found - columns_.begin());
}

void CsvTable::refuse(int row, const std::string& column, const std::string& rule) const
{
    throw pbs::InputError(fmt::format("{}:{}", file_, lines_.at(row)), index_of(column) + 1, column, text_at(row, column), rule);
}

const std::string& CsvTable::text_at(int row, const std::string& column) const
{
    return rows_.at(row)[index_of(column)];
}

double CsvTable::number(int row, const std::string& column) const
{
    double value = 0.0;
    if (!reads_whole(text_at(row, column), value)) refuse(row, column, "expected a number");
    return value;
}

long long CsvTable::integer(int row, const std::string& column) const
{
    long long value = 0;
    if (!reads_whole(text_at(row, column), value)) refuse(row, column, "expected a whole number");
    return value;
}

std::optional<double> CsvTable::number_or_nothing(int row, const std::string& column) const
{
    return text_at(row, column).empty() ? std::nullopt : std::optional<double>(number(row, column));
}

std::vector<double> CsvTable::numbers(const std::string& column) const
{
    std::vector<double> values;
    for (int row = 0; row < rows(); ++row) values.push_back(number(row, column));
    return values;
}

CsvTable read_csv(const std::string& path)
{
    return parse_csv(read_text(path), path);
}

}  // namespace analysis
