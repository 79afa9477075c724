// Typed rows as JSON: one object per row, with the names of the columns.
//   json["responses"] = json_of(response_columns, rows);
#pragma once

#include "analysis/records/tables.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace analysis {

// Numbers are doubles. Values that are not finite are texts, as in the CSV: nan, inf, or "" for no value.
template <typename Row>
nlohmann::json json_of(const Columns<Row>& columns, const std::vector<Row>& rows)
{
    nlohmann::json list = nlohmann::json::array();
    for (const Row& row : rows) {
        nlohmann::json object;
        for (const Column<Row>& column : columns) {
            const CsvTable::Cell cell = column.cell(row);
            if (cell.kind == CsvTable::Cell::Kind::whole)
                object[column.name] = static_cast<double>(cell.whole);
            else if (cell.kind == CsvTable::Cell::Kind::real && std::isfinite(cell.real))
                object[column.name] = cell.real;
            else
                object[column.name] = cell.text;
        }
        list.push_back(object);
    }
    return list;
}

}  // namespace analysis
