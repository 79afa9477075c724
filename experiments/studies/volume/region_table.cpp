#include "experiments/studies/volume/region_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

// Rows of one deformer and kind, the greatest loss first.
std::vector<int> rows_by_loss(const analysis::CsvTable& regions, const std::string& deformer, const std::string& kind)
{
    std::vector<int> rows;
    for (int row = 0; row < regions.rows(); ++row)
        if (regions.text_at(row, "deformer") == deformer && regions.text_at(row, "kind") == kind) rows.push_back(row);
    std::stable_sort(rows.begin(), rows.end(),
                     [&](int a, int b) { return regions.number(a, "change_pct") < regions.number(b, "change_pct"); });
    return rows;
}

std::string line_of(const RunRegions& run, const std::string& deformer, const std::string& kind, int most)
{
    const std::vector<int> rows = rows_by_loss(run.regions, deformer, kind);
    if (rows.empty()) return {};
    double sum = 0.0;
    std::string text;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double change = run.regions.number(rows[i], "change_pct");
        sum += change;
        if (static_cast<int>(i) < most)
            text += fmt::format("{}{} {:.2f} ({:.1f})", i ? ", " : "", run.regions.text_at(rows[i], "region"), change,
                                run.regions.number(rows[i], "own_change_pct"));
    }
    return fmt::format("{:<16} {:<4} {:<6} {:>7.2f}  {}\n", run.run, deformer, kind, sum, text);
}

}  // namespace

std::string region_text(const std::vector<RunRegions>& runs, int most)
{
    std::string text = fmt::format("{:<16} {:<4} {:<6} {:>7}  {}\n", "mean over frames", "", "by", "all [%]",
                                   "greatest losses [% of the body] (of the region itself)");
    for (const RunRegions& run : runs)
        for (const char* deformer : {"lbs", "pbs"})
            for (const char* kind : {"bone", "joint"}) text += line_of(run, deformer, kind, most);
    return text;
}

analysis::CsvTable region_csv(const std::vector<RunRegions>& runs)
{
    std::vector<std::string> columns = {"run"};
    if (!runs.empty()) columns.insert(columns.end(), runs.front().regions.columns().begin(), runs.front().regions.columns().end());
    analysis::CsvTable all(columns);
    for (const RunRegions& run : runs)
        for (int row = 0; row < run.regions.rows(); ++row) {
            std::vector<analysis::CsvTable::Cell> cells = {run.run};
            for (const std::string& column : run.regions.columns()) cells.emplace_back(run.regions.text_at(row, column));
            all.add_row(cells);
        }
    return all;
}

}  // namespace experiments
