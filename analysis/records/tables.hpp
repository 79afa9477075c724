// Records as CSV (RFC 4180): named columns, numbers that round-trip (the shortest text that reads back to the same
// double; nan, inf and -inf by name), and files that are written as a whole or not at all.
//   CsvTable table{{"frame", "volume_change_pct"}};  table.add_row({0, -0.25});  table.write("metrics.csv");
//   const CsvTable pbs = read_csv("metrics.csv").where("deformer", "pbs");  pbs[0].number("volume_change_pct");
#pragma once

#include <boost/preprocessor/seq/for_each.hpp>
#include <boost/preprocessor/stringize.hpp>
#include <boost/preprocessor/variadic/to_seq.hpp>

#include <algorithm>
#include <concepts>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace analysis {

std::string number_text(double value);  // shortest that round-trips; nan, inf, -inf

// The names of an enum's values in records; a specialisation defines `table`, an array of pairs of value and name.
template <typename Enum>
struct EnumNames;

// The name of a value in records; empty if EnumNames does not list it.
template <typename Enum>
requires std::is_enum_v<Enum> std::string recorded_name(Enum value)
{
    for (const auto& [entry, name] : EnumNames<Enum>::table)
        if (entry == value) return name;
    return "";
}

// Cells are kept as text. Tables and rows are values: they are cheap to copy, and a row outlives its table. Rows count
// from 0; std::out_of_range for a row that does not exist. A column that a table lacks is an InputError with the names
// of the table and of the column.
//   for (const CsvTable& method : points.where("stratum", "movement").groups({"method"}))
//       medians.add({{"method", method[0].text("method")}, {"ms", median(method.known_numbers("ms"))}});
class CsvTable {
public:
    // A text, a number, the name of an option, or no value (nullopt), which is an empty cell.
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
        template <typename Enum>
        requires std::is_enum_v<Enum> Cell(Enum value) : Cell(recorded_name(value)) {}
        template <typename Value>
        Cell(const std::optional<Value>& value) : Cell(value ? Cell(*value) : Cell(std::nullopt))
        {
        }

        Kind kind = Kind::nothing;
        std::string text;  // as the file has it
        long long whole = 0;
        double real = 0.0;
    };
    using NamedCells = std::vector<std::pair<std::string, Cell>>;  // by column

    // InputError file:line:column for a missing column or a value of another kind. `column` in the message is the
    // position of the field in its row, from 1.
    class Row {
    public:
        const std::string& text(const std::string& column) const;
        double number(const std::string& column) const;                            // nan and inf are allowed
        long long integer(const std::string& column) const;                        // without a fraction
        std::optional<double> number_or_nothing(const std::string& column) const;  // nothing for an empty cell
        template <typename Value>
        Value value(const std::string& column) const;  // of any type that CellOf reads
        // Numbers are compared as numbers: a cell 1.0 is 1.
        bool has(const NamedCells& cells) const;
        int line() const { return fields_->line; }  // at which it begins in the file
        // InputError file:line:column with the cell's value.
        [[noreturn]] void refuse(const std::string& column, const std::string& rule) const;

    private:
        friend class CsvTable;
        friend CsvTable parse_csv(const std::string& text, const std::string& file);
        struct Head {
            std::string name;  // of the table, or the file that was read, for messages
            std::vector<std::string> columns;
            std::size_t index_of(const std::string& column) const;
        };
        struct Fields {
            int line;
            std::vector<std::string> texts;
        };

        Row(std::shared_ptr<const Head> head, Fields fields);

        std::shared_ptr<const Head> head_;
        std::shared_ptr<const Fields> fields_;
    };

    // A table without rows; its name is that of its file, for messages.
    explicit CsvTable(std::vector<std::string> columns, const std::string& name = "");

    void add_row(const std::vector<Cell>& cells);  // std::logic_error unless there is one cell per column
    // The row has empty cells in all other columns. std::logic_error for a column that the table lacks.
    void add(const NamedCells& cells);
    // Appends all rows of another table with the same columns; a table without columns adopts those of the other.
    // InputError for different columns.
    //   CsvTable all{{}};  for (const CsvTable& table : of_runs) all.append(table);
    void append(const CsvTable& other);
    std::string text() const;                   // the whole file, column names first, each line with its end
    void write(const std::string& path) const;  // atomic; InputError if it cannot be written

    const std::vector<std::string>& columns() const { return head_->columns; }  // names, in order
    int rows() const { return static_cast<int>(rows_.size()); }                 // without the header line
    bool has_column(const std::string& name) const;                             // compares the exact name
    const Row& operator[](int row) const { return rows_.at(row); }
    auto begin() const { return rows_.begin(); }
    auto end() const { return rows_.end(); }

    // The rows with these cells, or those that a predicate accepts, in their order.
    CsvTable where(const NamedCells& cells) const;
    CsvTable where(const std::string& column, const Cell& cell) const { return where(NamedCells{{column, cell}}); }
    CsvTable where(const std::function<bool(const Row&)>& is_wanted) const;
    // The only row with these cells; nothing if there is none. InputError if there are several.
    std::optional<Row> find(const NamedCells& cells) const;
    // The rows that have the same texts in these columns, in the order of their first rows.
    std::vector<CsvTable> groups(const std::vector<std::string>& columns) const;
    std::map<std::string, Row> by(const std::string& column) const;  // InputError for a text that occurs twice
    template <typename Function>
    auto map(const Function& function) const  // #rows
    {
        std::vector<std::decay_t<std::invoke_result_t<Function, const Row&>>> values;
        for (const Row& row : rows_) values.push_back(std::invoke(function, row));
        return values;
    }
    std::vector<double> numbers(const std::string& column) const;        // #rows
    std::vector<double> known_numbers(const std::string& column) const;  // of the cells that are not empty

    // The same by the number of a row.
    const std::string& text_at(int row, const std::string& column) const { return (*this)[row].text(column); }
    double number(int row, const std::string& column) const { return (*this)[row].number(column); }
    long long integer(int row, const std::string& column) const { return (*this)[row].integer(column); }
    std::optional<double> number_or_nothing(int row, const std::string& column) const
    {
        return (*this)[row].number_or_nothing(column);
    }
    [[noreturn]] void refuse(int row, const std::string& column, const std::string& rule) const
    {
        (*this)[row].refuse(column, rule);
    }

private:
    friend CsvTable parse_csv(const std::string& text, const std::string& file);

    std::shared_ptr<const Row::Head> head_;
    std::vector<Row> rows_;
};

// InputError file:line:column for a file that is empty or cut off, has a row of another length, a duplicate column or
// broken quotes.
CsvTable parse_csv(const std::string& text, const std::string& file);
CsvTable read_csv(const std::string& path);  // InputError as for read_text and parse_csv

// How a value is written in a cell and in JSON. `read` throws InputError file:line:column for a cell of another kind.
template <typename Value>
struct CellOf;

template <>
struct CellOf<double> {
    static CsvTable::Cell cell(double value) { return value; }
    static double read(const CsvTable::Row& row, const std::string& column) { return row.number(column); }
};

template <std::signed_integral Whole>
struct CellOf<Whole> {
    static CsvTable::Cell cell(Whole value) { return value; }
    static Whole read(const CsvTable::Row& row, const std::string& column)
    {
        const long long value = row.integer(column);
        if (value != static_cast<Whole>(value)) row.refuse(column, "expected a whole number of at most 31 bits");
        return static_cast<Whole>(value);
    }
};

template <>
struct CellOf<bool> {
    static CsvTable::Cell cell(bool value) { return value; }
    static bool read(const CsvTable::Row& row, const std::string& column)
    {
        const std::string& text = row.text(column);
        if (text != "0" && text != "1") row.refuse(column, "expected 0 or 1");
        return text == "1";
    }
};

template <>
struct CellOf<std::string> {
    static CsvTable::Cell cell(const std::string& value) { return value; }
    static std::string read(const CsvTable::Row& row, const std::string& column) { return row.text(column); }
};

template <typename Enum>
requires std::is_enum_v<Enum>
struct CellOf<Enum> {
    static CsvTable::Cell cell(Enum value) { return value; }
    static Enum read(const CsvTable::Row& row, const std::string& column)
    {
        std::string names;
        for (const auto& [entry, name] : EnumNames<Enum>::table) {
            if (row.text(column) == name) return entry;
            names += (names.empty() ? "" : ", ") + std::string(name);
        }
        row.refuse(column, "expected one of " + names);
    }
};

template <>
struct CellOf<std::vector<std::string>> {  // names, each without a space, joined by spaces
    static CsvTable::Cell cell(const std::vector<std::string>& names)
    {
        std::string text;
        for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
        return text;
    }
    static std::vector<std::string> read(const CsvTable::Row& row, const std::string& column)
    {
        std::istringstream text(row.text(column));
        return {std::istream_iterator<std::string>(text), {}};
    }
};

template <typename Value>
struct CellOf<std::optional<Value>> {
    static CsvTable::Cell cell(const std::optional<Value>& value)
    {
        return value ? CellOf<Value>::cell(*value) : std::nullopt;
    }
    static std::optional<Value> read(const CsvTable::Row& row, const std::string& column)
    {
        if (row.text(column).empty()) return std::nullopt;
        return CellOf<Value>::read(row, column);
    }
};

template <typename Value>
Value CsvTable::Row::value(const std::string& column) const
{
    return CellOf<Value>::read(*this, column);
}

// std::logic_error unless the name ends with its unit or, if it ends with no unit, contains it: time_s is in s,
// volume_change_pct in %, step_ms_median in ms. A name that ends with a unit cannot belong to a pure number.
void require_unit(const std::string& name, const std::string& unit);

template <typename Row>
struct Column {
    // access: a pointer to the member, or a generic function from the row to a reference inside it.
    template <typename Access>
    Column(std::string its_name, Access access) : name(std::move(its_name))
    {
        using Value = std::remove_cvref_t<std::invoke_result_t<Access, Row&>>;
        cell = [access](const Row& row) { return CellOf<Value>::cell(std::invoke(access, row)); };
        read = [access, column = name](Row& row, const CsvTable::Row& cells) {
            std::invoke(access, row) = CellOf<Value>::read(cells, column);
        };
    }
    // With what the program prints of it. unit: "" for a pure number.
    template <typename Access>
    Column(std::string its_name, Access access, std::string its_unit, std::string its_meaning)
        : Column(std::move(its_name), access)
    {
        using Value = std::remove_cvref_t<std::invoke_result_t<Access, Row&>>;
        require_unit(name, its_unit);
        constexpr bool is_truth = std::is_same_v<Value, bool> || std::is_same_v<Value, std::optional<bool>>;
        unit = is_truth ? "0/1" : std::move(its_unit);
        meaning = std::move(its_meaning);
    }
    // A column of a member that is itself a struct.
    template <typename Part>
    Column(const Column<Part>& other, Part Row::*part)
        : name(other.name), unit(other.unit), meaning(other.meaning), group(other.group)
    {
        cell = [part, of = other.cell](const Row& row) { return of(row.*part); };
        read = [part, of = other.read](Row& row, const CsvTable::Row& cells) { of(row.*part, cells); };
    }
    // A column of an optional member struct; if a row has no value for it, all its cells are empty.
    template <typename Part>
    Column(const Column<Part>& other, std::optional<Part> Row::*part)
        : name(other.name), unit(other.unit), meaning(other.meaning), group(other.group)
    {
        cell = [part, of = other.cell](const Row& row) { return row.*part ? of(*(row.*part)) : std::nullopt; };
        read = [part, column = name, of = other.read](Row& row, const CsvTable::Row& cells) {
            if (cells.text(column).empty()) return;
            if (!(row.*part)) (row.*part).emplace();
            of(*(row.*part), cells);
        };
    }

    std::string name;
    // of the metrics, which `pbskin explain` prints; experiments/records/columns.md has the others
    std::string unit = {}, meaning = {};
    // "": in every file; the columns of a group occur in a file together or not at all
    std::string group = {};
    std::function<CsvTable::Cell(const Row&)> cell;
    std::function<void(Row&, const CsvTable::Row&)> read;
};

// A CSV record that is declared once: a row is a plain struct, and one list of columns names, writes and reads its
// members.
//   struct Distance { int frame; double rms_mm, largest; };
//   // members under their own names
//   const Columns<Distance> distance_columns = MEMBER_COLUMNS(Distance, frame, rms_mm) +
//                                              Columns<Distance>{{"most_mm", &Distance::largest}};
//   table_of(distance_columns, rows).write("distances.csv");
//   const std::vector<Distance> rows = rows_of(distance_columns, read_csv("distances.csv"));
// A member is a double, int, long, long long, bool (0 or 1), std::string, an enum with EnumNames, std::optional of one
// (nothing: an empty cell), or a list of names without spaces.
template <typename Row>
class Columns : public std::vector<Column<Row>> {
public:
    using std::vector<Column<Row>>::vector;

    // The columns of this list, followed by those of another.
    Columns operator+(const Columns& more) const
    {
        Columns joined = *this;
        joined.insert(joined.end(), more.begin(), more.end());
        return joined;
    }
    Columns in_group(const std::string& group) const
    {
        Columns grouped = *this;
        for (Column<Row>& column : grouped) column.group = group;
        return grouped;
    }
    Columns without(const std::string& group) const
    {
        Columns rest = *this;
        std::erase_if(rest, [&](const Column<Row>& column) { return column.group == group; });
        return rest;
    }
    const Column<Row>& named(const std::string& name) const  // std::out_of_range if no column has that name
    {
        for (const Column<Row>& column : *this)
            if (column.name == name) return column;
        throw std::out_of_range("no column " + name);
    }
    std::vector<std::string> names() const
    {
        std::vector<std::string> names;
        for (const Column<Row>& column : *this) names.push_back(column.name);
        return names;
    }
};

#define MEMBER_COLUMN(_, Row, member) {BOOST_PP_STRINGIZE(member), &Row::member},
#define MEMBER_COLUMNS(Row, ...) \
    (analysis::Columns<Row>{BOOST_PP_SEQ_FOR_EACH(MEMBER_COLUMN, Row, BOOST_PP_VARIADIC_TO_SEQ(__VA_ARGS__))})

// The columns of a member struct, which may be optional: within(&Frame::errors, error_columns).
template <typename Row, typename Member, typename Part>
Columns<Row> within(Member Row::*part, const Columns<Part>& columns)
{
    Columns<Row> columns_of_row;
    for (const Column<Part>& column : columns) columns_of_row.emplace_back(column, part);
    return columns_of_row;
}

template <typename Row>
std::vector<CsvTable::Cell> cells_of(const Columns<Row>& columns, const Row& row)
{
    std::vector<CsvTable::Cell> cells;
    for (const Column<Row>& column : columns) cells.push_back(column.cell(row));
    return cells;
}

template <typename Row>
CsvTable table_of(const Columns<Row>& columns, const std::vector<Row>& rows)
{
    CsvTable table(columns.names());
    for (const Row& row : rows) table.add_row(cells_of(columns, row));
    return table;
}

// Further columns of the table are ignored. InputError for a missing column, unless its whole group is missing.
template <typename Row>
std::vector<Row> rows_of(const Columns<Row>& columns, const CsvTable& table)
{
    const auto is_present = [&](const std::string& group) {
        return group.empty() || std::any_of(columns.begin(), columns.end(), [&](const Column<Row>& column) {
                   return column.group == group && table.has_column(column.name);
               });
    };
    std::vector<Row> rows(table.rows());
    for (const Column<Row>& column : columns)
        if (is_present(column.group))
            for (int r = 0; r < table.rows(); ++r) column.read(rows[r], table[r]);
    return rows;
}

// Columns that a file has only if some row has a value for them.
//   const auto columns = Columns<Row>{{"value", &Row::value}} + optional({{"n", &Row::n}});
//   table_of(used_columns(columns, rows), rows).write("values.csv");
// Each column becomes a group of its own: files without it are read, and its member keeps its default value.
template <typename Row>
Columns<Row> optional(Columns<Row> columns)
{
    for (Column<Row>& column : columns) column.group = column.name;
    return columns;
}

// The columns without a group, and those for which some row has a value.
template <typename Row>
Columns<Row> used_columns(Columns<Row> columns, const std::vector<Row>& rows)
{
    const auto is_filled = [](const CsvTable::Cell& cell) {
        return cell.kind != CsvTable::Cell::Kind::nothing &&
               !(cell.kind == CsvTable::Cell::Kind::text && cell.text.empty());
    };
    std::erase_if(columns, [&](const Column<Row>& column) {
        return !column.group.empty() &&
               std::ranges::none_of(rows, [&](const Row& row) { return is_filled(column.cell(row)); });
    });
    return columns;
}

// A column whose cell is empty for one value: a count of 0, a bound at infinity.
template <typename Row, typename Value>
Column<Row> column_with_empty(Value empty, const std::string& name, Value Row::*member)
{
    Column<Row> column(name, member);
    column.cell = [member, empty, filled = column.cell](const Row& row) {
        return row.*member == empty ? CsvTable::Cell(std::nullopt) : filled(row);
    };
    column.read = [member, empty, name, filled = column.read](Row& row, const CsvTable::Row& cells) {
        if (cells.text(name).empty())
            row.*member = empty;
        else
            filled(row, cells);
    };
    return column;
}

}  // namespace analysis
