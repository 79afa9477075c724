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

CsvTable::Row::Row(std::shared_ptr<const Head> head, Fields fields)
    : head_(std::move(head)), fields_(std::make_shared<const Fields>(std::move(fields)))
{
}

std::size_t CsvTable::Row::Head::index_of(const std::string& column) const
{
    const auto found = std::ranges::find(columns, column);
    if (found == columns.end())
        throw pbs::InputError(name, 1, "columns", fmt::format("{}", fmt::join(columns, ",")),
                              "expected a column " + column);
    return found - columns.begin();
}

void CsvTable::Row::refuse(const std::string& column, const std::string& rule) const
{
    throw pbs::InputError(fmt::format("{}:{}", head_->name, line()), static_cast<int>(head_->index_of(column)) + 1,
                          column, text(column), rule);
}

const std::string& CsvTable::Row::text(const std::string& column) const
{
    return fields_->texts[head_->index_of(column)];
}

double CsvTable::Row::number(const std::string& column) const
{
    double value = 0.0;
    if (!reads_whole(text(column), value)) refuse(column, "expected a number");
    return value;
}

long long CsvTable::Row::integer(const std::string& column) const
{
    long long value = 0;
    if (!reads_whole(text(column), value)) refuse(column, "expected a whole number");
    return value;
}

std::optional<double> CsvTable::Row::number_or_nothing(const std::string& column) const
{
    return text(column).empty() ? std::nullopt : std::optional(number(column));
}

bool CsvTable::Row::has(const NamedCells& cells) const
{
    return std::ranges::all_of(cells, [&](const auto& named) {
        const auto& [column, cell] = named;
        const std::string& own = text(column);
        double value = 0.0;
        const bool is_number = cell.kind == Cell::Kind::whole || cell.kind == Cell::Kind::real;
        return own == cell.text || (is_number && reads_whole(own, value) &&
                                    value == (cell.kind == Cell::Kind::whole ? double(cell.whole) : cell.real));
    });
}

CsvTable::CsvTable(std::vector<std::string> columns, const std::string& name)
    : head_(std::make_shared<const Row::Head>(Row::Head{name, std::move(columns)}))
{
}

void CsvTable::add_row(const std::vector<Cell>& cells)
{
    if (cells.size() != columns().size())
        throw std::logic_error{
            fmt::format("{}: a row of {} cells in a table of {} columns", head_->name, cells.size(), columns().size())};
    Row::Fields fields{rows() + 2, {}};
    for (const Cell& cell : cells) fields.texts.push_back(cell.text);
    rows_.push_back(Row(head_, std::move(fields)));
}

void CsvTable::add(const NamedCells& cells)
{
    Row::Fields fields{rows() + 2, std::vector<std::string>(columns().size())};
    for (const auto& [column, cell] : cells) {
        if (!has_column(column)) throw std::logic_error{fmt::format("{}: there is no column {}", head_->name, column)};
        fields.texts[head_->index_of(column)] = cell.text;
    }
    rows_.push_back(Row(head_, std::move(fields)));
}

void CsvTable::append(const CsvTable& other)
{
    if (columns().empty()) head_ = other.head_;
    if (columns() != other.columns())
        throw pbs::InputError(other.head_->name, 1, "columns", fmt::format("{}", fmt::join(other.columns(), ",")),
                              fmt::format("expected those of the tables before: {}", fmt::join(columns(), ",")));
    rows_.insert(rows_.end(), other.rows_.begin(), other.rows_.end());
}

std::string CsvTable::text() const
{
    std::string text = line_of(columns());
    for (const Row& row : rows_) text += line_of(row.fields_->texts);
    return text;
}

void CsvTable::write(const std::string& path) const
{
    write_text_atomically(path, text());
}

bool CsvTable::has_column(const std::string& name) const
{
    return std::ranges::count(columns(), name) > 0;
}

CsvTable CsvTable::where(const std::function<bool(const Row&)>& is_wanted) const
{
    CsvTable wanted = *this;
    std::erase_if(wanted.rows_, [&](const Row& row) { return !is_wanted(row); });
    return wanted;
}

CsvTable CsvTable::where(const NamedCells& cells) const
{
    for (const auto& [column, cell] : cells) head_->index_of(column);  // also if there is no row
    return where([&](const Row& row) { return row.has(cells); });
}

std::optional<CsvTable::Row> CsvTable::find(const NamedCells& cells) const
{
    const CsvTable found = where(cells);
    if (found.rows() > 1)
        found[1].refuse(cells.at(0).first, fmt::format("expected one such row: line {} has it too", found[0].line()));
    return found.rows() == 0 ? std::nullopt : std::optional(found[0]);
}

std::vector<CsvTable> CsvTable::groups(const std::vector<std::string>& columns) const
{
    std::vector<std::size_t> indices;
    for (const std::string& column : columns) indices.push_back(head_->index_of(column));
    std::map<std::vector<std::string>, std::size_t> places;
    std::vector<CsvTable> groups;
    for (const Row& row : rows_) {
        std::vector<std::string> key;
        for (const std::size_t index : indices) key.push_back(row.fields_->texts[index]);
        const auto [place, is_new] = places.emplace(std::move(key), groups.size());
        if (is_new) groups.emplace_back(*this).rows_.clear();
        groups[place->second].rows_.push_back(row);
    }
    return groups;
}

std::map<std::string, CsvTable::Row> CsvTable::by(const std::string& column) const
{
    head_->index_of(column);  // also if there is no row
    std::map<std::string, Row> rows;
    for (const Row& row : rows_)
        if (const auto [place, is_new] = rows.emplace(row.text(column), row); !is_new)
            row.refuse(column, fmt::format("expected it once: line {} has it too", place->second.line()));
    return rows;
}

std::vector<double> CsvTable::numbers(const std::string& column) const
{
    head_->index_of(column);  // also if there is no row
    return map([&](const Row& row) { return row.number(column); });
}

std::vector<double> CsvTable::known_numbers(const std::string& column) const
{
    return where([&](const Row& row) { return !row.text(column).empty(); }).numbers(column);
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
    CsvTable table(reader.next(), file);
    const std::vector<std::string>& columns = table.columns();
    if (columns.size() == 1 && columns.front().find(';') != std::string::npos)
        refuse(file, 1, 1, "", "the separator is a semicolon: expected commas between fields and points in decimals");
    std::set<std::string> names;
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (!names.insert(columns[i]).second) refuse(file, 1, i + 1, columns[i], "expected each column once");
    while (!reader.at_end()) {
        const int line = reader.line();
        std::vector<std::string> texts = reader.next();
        if (texts.size() != columns.size())
            refuse(file, line, texts.size(), "",
                   fmt::format("{} fields: expected {} as in the first line", texts.size(), columns.size()));
        table.rows_.push_back(CsvTable::Row(table.head_, {line, std::move(texts)}));
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
