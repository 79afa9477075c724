#include "analysis/report_table.hpp"

#include "analysis/text_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace analysis {
namespace {

std::string shown(const CsvTable& table, int row, const ReportColumn& column)
{
    const std::string& text = table.text_at(row, column.column);
    if (text.empty() || text == "nan") return column.unknown;
    return column.format.empty() ? text : fmt::format(fmt::runtime(column.format), column.factor * table.number(row, column.column));
}

// The headings, then each row's cells.
std::vector<std::vector<std::string>> shown_rows(const CsvTable& table, const std::vector<ReportColumn>& columns)
{
    std::vector<std::vector<std::string>> rows(1);
    for (const ReportColumn& column : columns) rows[0].push_back(column.heading);
    for (int r = 0; r < table.rows(); ++r) {
        rows.emplace_back();
        for (const ReportColumn& column : columns) rows.back().push_back(shown(table, r, column));
    }
    return rows;
}

}  // namespace

std::vector<ReportColumn> report_columns(const std::string& names)
{
    std::vector<ReportColumn> columns;
    std::istringstream words(names);
    for (std::string word; words >> word;) {
        const auto end = word.find(':');
        const std::string name = word.substr(0, end);
        columns.push_back({name, name, end == std::string::npos ? "" : fmt::format("{{{}}}", word.substr(end))});
    }
    return columns;
}

std::string markdown_table(const CsvTable& table, const std::vector<ReportColumn>& columns)
{
    std::string text;
    for (const auto& row : shown_rows(table, columns)) {
        for (const std::string& cell : row) text += "| " + cell + " ";
        text += "|\n";
        if (text.find('\n') == text.size() - 1) {  // there are no rows below the headings
            for (std::size_t c = 0; c < columns.size(); ++c) text += "|---";
            text += "|\n";
        }
    }
    return text;
}

std::string text_table(const CsvTable& table, const std::vector<ReportColumn>& columns)
{
    const auto rows = shown_rows(table, columns);
    std::vector<std::size_t> widths(columns.size(), 0);
    for (const auto& row : rows)
        for (std::size_t c = 0; c < columns.size(); ++c) widths[c] = std::max(widths[c], characters(row[c]));
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const std::string blanks(widths[c] - characters(row[c]), ' ');
            line += (c ? "  " : "") + (columns[c].format.empty() ? row[c] + blanks : blanks + row[c]);
        }
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

}  // namespace analysis
