#include "analysis/records/tables.hpp"

#include "analysis/records/record_files.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <set>
#include <string_view>

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
    // distinguishes a row of one empty field from an empty line
    if (fields.size() == 1 && fields[0].empty()) return "\"\"\n";
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

[[noreturn]] void refuse(const std::string& file, int line, std::size_t column, const std::string& value,
                         const std::string& rule)
{
    throw pbs::InputError(fmt::format("{}:{}", file, line), static_cast<int>(column), value.empty() ? "" : "column",
                          value, rule);
}

// Reads one record at a time from the text and resolves quotes and line ends.
class RecordReader {
public:
    RecordReader(const std::string& text, const std::string& file) : text_(text), file_(file) {}

    bool at_end() const { return at_ == text_.size(); }
    int line() const { return line_; }

    std::vector<std::string> next()
    {
        std::vector<std::string> fields;
        do {
            fields.emplace_back();
            if (take('"'))
                read_quoted(fields);
            else
                read_plain(fields);
        } while (take(','));
        take('\r');
        if (!take('\n'))
            refuse(file_, line_, fields.size(), "",
                   at_end() ? "the file ends within a line: cut off?" : "unexpected text after a field");
        ++line_;
        return fields;
    }

private:
    bool take(char c)
    {
        if (at_end() || text_[at_] != c) return false;
        ++at_;
        return true;
    }

    void read_plain(std::vector<std::string>& fields)
    {
        for (; !at_end() && std::string_view(",\r\n").find(text_[at_]) == std::string_view::npos; ++at_) {
            if (text_[at_] == '"' || text_[at_] == '\0')
                refuse(file_, line_, fields.size(), "", "unexpected quote or zero byte within a field");
            fields.back() += text_[at_];
        }
    }

    void read_quoted(std::vector<std::string>& fields)
    {
        const int first_line = line_;
        while (!at_end()) {
            const char c = text_[at_++];
            if (c == '"' && !take('"')) return;
            if (c == '\n') ++line_;
            fields.back() += c;
        }
        refuse(file_, first_line, fields.size(), "", "a quote is never closed");
    }

    const std::string& text_;
    const std::string& file_;
    std::size_t at_ = 0;
    int line_ = 1;
};

// Units as column names spell them and as they are written. If two endings fit a name, the longer one comes first.
constexpr std::array<std::pair<const char*, const char*>, 22> units{{{"m_s2", "m/s^2"},   {"m_s", "m/s"},
                                                                     {"n_m", "N/m"},      {"per_s", "1/s"},
                                                                     {"kg_m3", "kg/m^3"}, {"m3", "m^3"},
                                                                     {"m2", "m^2"},       {"pct", "%"},
                                                                     {"deg", "deg"},      {"rad", "rad"},
                                                                     {"mm", "mm"},        {"m", "m"},
                                                                     {"ns", "ns"},        {"us", "us"},
                                                                     {"ms", "ms"},        {"s", "s"},
                                                                     {"hz", "Hz"},        {"pa", "Pa"},
                                                                     {"kg", "kg"},        {"mb", "MB"},
                                                                     {"n", "N"},          {"diagonals", "diagonals"}}};

// The unit of the longest ending that is one.
std::string unit_by_ending(const std::string& name)
{
    for (const auto& [ending, unit] : units)
        if (name.ends_with(fmt::format("_{}", ending))) return unit;
    return "";
}

bool is_inside(const std::string& name, const std::string& wanted)
{
    for (const auto& [part, unit] : units)
        if (unit == wanted && fmt::format("_{}_", name).find(fmt::format("_{}_", part)) != std::string::npos)
            return true;
    return false;
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
        throw std::logic_error{
            fmt::format("a row of {} cells in a table of {} columns", cells.size(), columns_.size())};
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
        throw pbs::InputError(file_, 1, "columns", fmt::format("{}", fmt::join(columns_, ",")),
                              "expected a column " + column);
    return static_cast<int>(found - columns_.begin());
}

void CsvTable::refuse(int row, const std::string& column, const std::string& rule) const
{
    throw pbs::InputError(fmt::format("{}:{}", file_, lines_.at(row)), index_of(column) + 1, column,
                          text_at(row, column), rule);
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

CsvTable parse_csv(const std::string& text, const std::string& file)
{
    if (text.empty()) throw pbs::InputError(file, 0, "", "", "the file is empty: expected a line of column names");
    if (text.starts_with("\xef\xbb\xbf"))
        throw pbs::InputError(file, 1, "", "",
                              "begins with a byte order mark, as a spreadsheet writes it: expected UTF-8 without one");
    RecordReader reader(text, file);
    CsvTable table(reader.next());
    table.file_ = file;
    if (table.columns_.size() == 1 && table.columns_.front().find(';') != std::string::npos)
        refuse(file, 1, 1, "", "the separator is a semicolon: expected commas between fields and points in decimals");
    std::set<std::string> names;
    for (std::size_t i = 0; i < table.columns_.size(); ++i)
        if (!names.insert(table.columns_[i]).second)
            refuse(file, 1, i + 1, table.columns_[i], "expected each column once");
    while (!reader.at_end()) {
        const int line = reader.line();
        table.rows_.push_back(reader.next());
        table.lines_.push_back(line);
        const std::size_t fields = table.rows_.back().size(), wanted = table.columns_.size();
        if (fields != wanted)
            refuse(file, line, fields, "", fmt::format("{} fields: expected {} as in the first line", fields, wanted));
    }
    return table;
}

void require_unit(const std::string& name, const std::string& unit)
{
    const std::string ending = unit_by_ending(name);
    if (unit == ending || (ending.empty() && is_inside(name, unit))) return;
    throw std::logic_error{
        fmt::format("column {}: the unit '{}' does not agree with the name, which says '{}'", name, unit, ending)};
}

}  // namespace analysis
