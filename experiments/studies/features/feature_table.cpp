#include "experiments/studies/features/feature_table.hpp"

#include <fmt/format.h>

namespace experiments {
namespace {

using Cell = analysis::CsvTable::Cell;

struct Figure {
    const char* name;
    double SceneCost::*of;
};
constexpr Figure figures[] = {{"frame_ms", &SceneCost::frame_ms}, {"frame_cpu_ms", &SceneCost::frame_cpu_ms},
                              {"step_ms", &SceneCost::step_ms},   {"step_cpu_ms", &SceneCost::step_cpu_ms},
                              {"start_s", &SceneCost::start_s},   {"peak_mb", &SceneCost::peak_mb}};

std::vector<std::string> columns()
{
    std::vector<std::string> names = {"scene", "feature", "rounds"};
    for (const Figure& figure : figures)
        for (const char* part : {"_without", "_without_lower", "_without_upper", "_with", "_with_lower", "_with_upper", "_ratio",
                                 "_ratio_lower", "_ratio_upper"})
            names.push_back(std::string(figure.name) + part);
    for (const char* name : {"shared_objects_without", "shared_objects_with", "largest_distance_m", "volume_difference_pct"})
        names.push_back(name);
    return names;
}

std::string pair_of(const analysis::CsvTable& table, int row, const std::string& figure, const char* format)
{
    return fmt::format(fmt::runtime(std::string("{0:") + format + "} | {1:" + format + "}"), table.number(row, figure + "_without"),
                       table.number(row, figure + "_with"));
}

std::string ratio_of(const analysis::CsvTable& table, int row, const std::string& figure)
{
    return fmt::format("{:.2f} [{:.2f}, {:.2f}]", table.number(row, figure + "_ratio"), table.number(row, figure + "_ratio_lower"),
                       table.number(row, figure + "_ratio_upper"));
}

std::string change_of(const analysis::CsvTable& table, int row)
{
    const auto distance = table.number_or_nothing(row, "largest_distance_m");
    if (!distance) return "";
    return fmt::format("{:.2g} mm, {:.2g} %", 1e3 * *distance, table.number(row, "volume_difference_pct"));
}

}  // namespace

Compared compare(const FeatureRow& row, double SceneCost::*figure)
{
    const auto of = [&](const std::vector<SceneCost>& costs) {
        std::vector<double> rounds;
        for (const SceneCost& cost : costs) rounds.push_back(cost.*figure);
        return rounds;
    };
    const std::vector<double> without = of(row.without), with = of(row.with);
    const Spread ratio = spread_of_ratios(with, without);
    return {spread_of(without), spread_of(with), ratio};
}

analysis::CsvTable features_csv(const std::vector<FeatureRow>& rows)
{
    analysis::CsvTable table(columns());
    for (const FeatureRow& row : rows) {
        std::vector<Cell> cells = {row.scene, row.feature, static_cast<int>(row.without.size())};
        for (const Figure& figure : figures) {
            const Compared compared = compare(row, figure.of);
            for (const Spread& spread : {compared.without, compared.with, compared.ratio})
                for (const double value : {spread.median, spread.lower, spread.upper}) cells.emplace_back(value);
        }
        cells.emplace_back(row.without.back().shared_objects);
        cells.emplace_back(row.with.back().shared_objects);
        for (double AnswerChange::*part : {&AnswerChange::distance_m, &AnswerChange::volume_difference_pct}) {
            if (row.change)
                cells.emplace_back((*row.change).*part);
            else
                cells.emplace_back(std::nullopt);
        }
        table.add_row(cells);
    }
    return table;
}

std::string features_markdown(const analysis::CsvTable& table)
{
    std::string text =
        "| scene | feature | ms of processor a frame without | with | ratio [quartiles] | wall ms without | with | step, ms of processor "
        "without | with | start [s] without | with | peak [MB] without | with | shared objects | the answer moves, its volume |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (int row = 0; row < table.rows(); ++row)
        text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} | {} to {} | {} |\n", table.text_at(row, "scene"),
                            table.text_at(row, "feature"), pair_of(table, row, "frame_cpu_ms", ".2f"), ratio_of(table, row, "frame_cpu_ms"),
                            pair_of(table, row, "frame_ms", ".2f"), pair_of(table, row, "step_cpu_ms", ".2f"),
                            pair_of(table, row, "start_s", ".2f"), pair_of(table, row, "peak_mb", ".0f"),
                            table.integer(row, "shared_objects_without"), table.integer(row, "shared_objects_with"), change_of(table, row));
    return text;
}

}  // namespace experiments
