#include "experiments/run/frame_statistics.hpp"

#include "analysis/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace experiments {
namespace {

using analysis::CsvTable;

const std::vector<std::string> settings = {"scene", "deformer", "variant", "order", "precision", "iterations"};
const std::vector<std::string> quantities = {"volume_change", "volume_abs_change", "error_l2", "error_joint"};  // each [%]
const std::vector<std::pair<std::string, double>> shares = {{"least", 0.0}, {"p10", 0.1}, {"median", 0.5}, {"p90", 0.9}, {"most", 1.0}};

struct Group {
    std::vector<std::string> setting;
    std::vector<int> rows;
};

// In order of first appearance.
std::vector<Group> by_setting(const CsvTable& metrics)
{
    std::vector<Group> groups;
    for (int row = 0; row < metrics.rows(); ++row) {
        std::vector<std::string> setting;
        for (const std::string& column : settings) setting.push_back(metrics.text_at(row, column));
        auto found = std::find_if(groups.begin(), groups.end(), [&](const Group& group) { return group.setting == setting; });
        if (found == groups.end()) found = groups.insert(groups.end(), {std::move(setting), {}});
        found->rows.push_back(row);
    }
    return groups;
}

std::vector<double> values_of(const CsvTable& metrics, const std::vector<int>& rows, const std::string& column)
{
    std::vector<double> values;
    if (!metrics.has_column(column)) return values;
    for (const int row : rows)
        if (const auto value = metrics.number_or_nothing(row, column); value && std::isfinite(*value)) values.push_back(*value);
    return values;
}

}  // namespace

CsvTable frame_statistics(const CsvTable& metrics)
{
    std::vector<std::string> columns = settings;
    columns.push_back("frames");
    for (const std::string& quantity : quantities)
        for (const auto& [name, share] : shares) columns.push_back(quantity + "_" + name + "_pct");
    CsvTable table(columns);
    for (const Group& group : by_setting(metrics)) {
        std::vector<CsvTable::Cell> cells(group.setting.begin(), group.setting.end());
        cells.push_back(static_cast<int>(group.rows.size()));
        for (const std::string& quantity : quantities) {
            const std::vector<double> values = values_of(metrics, group.rows, quantity + "_pct");
            for (const auto& [name, share] : shares)
                cells.push_back(values.empty() ? CsvTable::Cell(std::nullopt) : analysis::quantile(values, share));
        }
        table.add_row(cells);
    }
    return table;
}

}  // namespace experiments
