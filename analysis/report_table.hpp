// Chosen columns of a record as a readable table: Markdown for a page, aligned columns for a terminal.
//   const std::vector<ReportColumn> columns = {{"body", "body"}, {"step [ms]", "step_s", "{:.2f}", 1e3}};
//   markdown_table(table, columns);   // | body | step [ms] | ...
//   text_table(table, columns);       // body   step [ms] ...
//   text_table(table, report_columns("body step_s:.2f"));   // body   step_s ...
#pragma once

#include "analysis/records/csv_table.hpp"

#include <string>
#include <vector>

namespace analysis {

struct ReportColumn {
    std::string heading;       // with the unit as shown
    std::string column;        // column of the record
    std::string format = "";   // fmt format for a number; "": the text of the cell as it is
    double factor = 1.0;       // from the unit of the record to the shown one
    std::string unknown = "";  // shown for an empty cell and for nan
};

// Columns under their own names, which blanks separate, each with an optional format: "body step_ms:.2f".
std::vector<ReportColumn> report_columns(const std::string& names);

// One line per row of the record. InputError for a missing column, or for a text where a format expects a number.
std::string markdown_table(const CsvTable& table, const std::vector<ReportColumn>& columns);
std::string text_table(const CsvTable& table, const std::vector<ReportColumn>& columns);

}  // namespace analysis
