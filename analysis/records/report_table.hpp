// Chosen columns of a record as aligned columns for a terminal.
//   const std::vector<ReportColumn> columns = {{"body", "body"}, {"step [ms]", "step_s", "{:.2f}", 1e3}};
//   text_table(table, columns);   // body   step [ms] ...
//   text_table(table, report_columns("body step_s:.2f"));   // body   step_s ...
#pragma once

#include "analysis/records/tables.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace analysis {

// Text for a terminal: lines wrapped between words to a width, and columns side by side.
//   fmt::print("{}", side_by_side({{"C02", 4}, {"reproduced in part", 14}, {statement, 40}}));
// Lines of at most `width` characters (UTF-8 code points, not bytes). A longer word is broken, and line breaks in the text are kept.
std::vector<std::string> wrapped(const std::string& text, std::size_t width);

std::size_t characters(const std::string& text);  // number of code points of a UTF-8 text

// A cell of a row, which is wrapped if it is too wide.
struct TextColumn {
    std::string text;         // without escape sequences
    std::size_t width;        // in characters, at least 1
    std::string colour = {};  // an escape sequence; empty: none
};

// Each column is wrapped to its width, with two blanks between columns. Lines end without blanks, and the last one with a line break.
std::string side_by_side(const std::vector<TextColumn>& columns);

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
std::string text_table(const CsvTable& table, const std::vector<ReportColumn>& columns);

// Markdown as plain text for a terminal.
//   fmt::print("{}", plain_text(page, terminal_width()));
// Headings, paragraphs, lists and tables within `width` characters. Only the text of a link is kept, and comments are left out. Lines of
// code keep their blanks unless they are too long.
std::string plain_text(const std::string& markdown, std::size_t width);

std::string first_paragraph(const std::string& markdown);  // the one below the title, on one line

}  // namespace analysis
