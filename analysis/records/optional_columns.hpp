// Columns that a file has only if some row has a value for them.
//   const auto columns = Columns<Row>{{"value", &Row::value, "", "..."}} + optional({{"n", &Row::n, "", "number of trials"}});
//   table_of(used_columns(columns, rows), rows).write("values.csv");
#pragma once

#include "analysis/records/typed_table.hpp"

namespace analysis {

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
        return cell.kind != CsvTable::Cell::Kind::nothing && !(cell.kind == CsvTable::Cell::Kind::text && cell.text.empty());
    };
    std::erase_if(columns, [&](const Column<Row>& column) {
        return !column.group.empty() && std::ranges::none_of(rows, [&](const Row& row) { return is_filled(column.cell(row)); });
    });
    return columns;
}

// A column whose cell is empty for one value: a count of 0, a bound at infinity.
template <typename Row, typename Value>
Column<Row> column_with_empty(Value empty, const std::string& name, Value Row::*member, const std::string& unit, const std::string& meaning)
{
    Column<Row> column(name, member, unit, meaning);
    column.cell = [member, empty, filled = column.cell](const Row& row) {
        return row.*member == empty ? CsvTable::Cell(std::nullopt) : filled(row);
    };
    column.read = [member, empty, name, filled = column.read](Row& row, const CsvTable& table, int r) {
        if (table.text_at(r, name).empty())
            row.*member = empty;
        else
            filled(row, table, r);
    };
    return column;
}

}  // namespace analysis
