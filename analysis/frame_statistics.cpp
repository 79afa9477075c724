#include "analysis/frame_statistics.hpp"

#include "analysis/records/typed_table.hpp"
#include "analysis/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace analysis {
namespace {

const std::array<std::string, 6> settings = {"scene", "deformer", "variant", "order", "precision", "iterations"};
const std::array<std::string, 4> quantities = {"volume_change", "volume_abs_change", "error_l2", "error_joint"};  // each [%]
const std::array<std::pair<std::string, double>, 5> shares = {{{"least", 0.0}, {"p10", 0.1}, {"median", 0.5}, {"p90", 0.9}, {"most", 1.0}}};

struct Group {
    std::array<std::string, 6> setting;
    std::vector<int> rows = {};
    int frames = 0;
    std::array<std::array<std::optional<double>, 5>, 4> statistics = {};  // by quantity and share
};

Columns<Group> all_columns()
{
    Columns<Group> columns;
    for (std::size_t i = 0; i < settings.size(); ++i)
        columns.emplace_back(
            settings[i], [i](auto& group) -> decltype(auto) { return (group.setting[i]); }, "", "as in metrics.csv");
    columns.emplace_back("frames", &Group::frames, "", "number of frames");
    for (std::size_t q = 0; q < quantities.size(); ++q)
        for (std::size_t i = 0; i < shares.size(); ++i)
            columns.emplace_back(
                quantities[q] + "_" + shares[i].first + "_pct", [q, i](auto& group) -> decltype(auto) { return (group.statistics[q][i]); },
                "%", fmt::format("{} quantile of {}_pct over the finite frames", shares[i].second, quantities[q]));
    return columns;
}

// In order of first appearance.
std::vector<Group> by_setting(const CsvTable& metrics)
{
    std::vector<Group> groups;
    for (int row = 0; row < metrics.rows(); ++row) {
        std::array<std::string, 6> setting;
        for (std::size_t i = 0; i < settings.size(); ++i) setting[i] = metrics.text_at(row, settings[i]);
        auto found = std::find_if(groups.begin(), groups.end(), [&](const Group& group) { return group.setting == setting; });
        if (found == groups.end()) found = groups.insert(groups.end(), {setting});
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
    static const Columns<Group> columns = all_columns();
    std::vector<Group> groups = by_setting(metrics);
    for (Group& group : groups) {
        group.frames = static_cast<int>(group.rows.size());
        for (std::size_t q = 0; q < quantities.size(); ++q) {
            const std::vector<double> values = values_of(metrics, group.rows, quantities[q] + "_pct");
            if (values.empty()) continue;
            for (std::size_t i = 0; i < shares.size(); ++i) group.statistics[q][i] = quantile(values, shares[i].second);
        }
    }
    return table_of(columns, groups);
}

}  // namespace analysis
