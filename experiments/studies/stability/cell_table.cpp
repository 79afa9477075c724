#include "experiments/studies/stability/cell_table.hpp"

#include "analysis/measurement.hpp"
#include "experiments/studies/stability/share_interval.hpp"
#include "pbs/solver/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace experiments {
namespace {

using analysis::CsvTable;
using analysis::StabilityOutcome;

constexpr StabilityOutcome outcomes[] = {StabilityOutcome::converged, StabilityOutcome::bounded, StabilityOutcome::inverted,
                                         StabilityOutcome::diverged, StabilityOutcome::not_finite};

// Columns of cells.csv.
const std::vector<std::string> columns = {"body",
                                          "model",
                                          "factor",
                                          "value",
                                          "unit",
                                          "named",
                                          "second_factor",
                                          "second_value",
                                          "second_unit",
                                          "precision",
                                          "time_step_s",
                                          "steps",
                                          "outcome",
                                          "recovery_steps",
                                          "recovery_s",
                                          "iterations_until_reached",
                                          "undisturbed_at_rest",
                                          "largest_reach_diagonals",
                                          "last_reach_diagonals",
                                          "last_motion_diagonals",
                                          "last_from_undisturbed_diagonals",
                                          "most_inverted_tets",
                                          "last_inverted_tets",
                                          "steps_not_reached",
                                          "as_published",
                                          "cpu_s"};

using Keyed = std::vector<std::pair<analysis::CaseKey, std::vector<const MeasuredCell*>>>;

bool jiggles(const StabilityCell& cell)
{
    const auto* pbs = options_if<pbs::PbsOptions>(cell.spec);
    return pbs && pbs->jiggle;
}

// Sweeps in order of first appearance.
Keyed by_sweep(const std::vector<MeasuredCell>& cells)
{
    Keyed sweeps;
    for (const MeasuredCell& measured : cells) {
        const StabilityCell& cell = measured.cell;
        if (!cell.as_published) continue;
        const analysis::CaseKey key = {.body = cell.body,
                                       .deformer = "pbs",
                                       .variant = jiggles(cell) ? "jiggle" : "",
                                       .precision = precision_of(cell),
                                       .factor = cell.factor,
                                       .second_factor = cell.second_factor};
        auto found = std::find_if(sweeps.begin(), sweeps.end(), [&](const auto& sweep) { return sweep.first == key; });
        if (found == sweeps.end()) found = sweeps.insert(sweeps.end(), {key, {}});
        found->second.push_back(&measured);
    }
    return sweeps;
}

bool ran_away(const CellResult& result)
{
    const StabilityOutcome outcome = result.stability.outcome;
    return outcome == StabilityOutcome::diverged || outcome == StabilityOutcome::not_finite;
}

bool is(const CellResult& result, StabilityOutcome outcome)
{
    return result.stability.outcome == outcome;
}

// Nothing worse than bounded or inverted, and it moves in one of the last steps that `converged` looks at.
bool never_rests(const CellResult& result)
{
    if (!is(result, StabilityOutcome::bounded) && !is(result, StabilityOutcome::inverted)) return false;
    const analysis::StabilityBounds bounds;
    const auto& steps = result.steps;
    const auto looked_at = std::min<std::ptrdiff_t>(std::ssize(steps), bounds.still_steps);
    return std::any_of(steps.end() - looked_at, steps.end(), [&](const auto& step) { return step.motion > bounds.rest_motion; });
}

template <typename Predicate>
ShareInterval share(const std::vector<const MeasuredCell*>& cells, Predicate of)
{
    const auto counted = std::count_if(cells.begin(), cells.end(), [&](const MeasuredCell* measured) { return of(measured->result); });
    return share_interval(static_cast<int>(counted), static_cast<int>(cells.size()));
}

std::vector<CsvTable::Cell> row_of(const MeasuredCell& measured)
{
    using Cell = CsvTable::Cell;
    const auto& [cell, result] = measured;
    const auto& last = result.steps.back();
    double largest_reach = 0.0;
    int most_inverted = 0;
    for (const auto& step : result.steps) {
        largest_reach = std::max(largest_reach, step.reach);
        most_inverted = std::max(most_inverted, step.inverted_tets);
    }
    const auto recovery = result.stability.recovery_steps;
    const bool is_map = !cell.second_factor.empty();
    const auto when_finite = [&](Cell value) { return last.finite ? value : Cell(std::nullopt); };
    return {cell.body,
            cell.model,
            cell.factor,
            cell.value,
            cell.unit,
            cell.named,
            cell.second_factor,
            is_map ? Cell(cell.second_value) : Cell(std::nullopt),
            cell.second_unit,
            precision_of(cell),
            cell.time_step_s,
            static_cast<int>(result.steps.size()),
            name_of(result.stability.outcome),
            recovery ? Cell(*recovery) : Cell(std::nullopt),
            recovery ? Cell(*recovery * cell.time_step_s) : Cell(std::nullopt),
            result.iterations_until_reached ? Cell(*result.iterations_until_reached) : Cell(std::nullopt),
            result.has_undisturbed ? "yes" : "no",
            largest_reach,
            when_finite(last.reach),
            when_finite(last.motion),
            result.has_undisturbed ? when_finite(last.from_undisturbed) : Cell(std::nullopt),
            most_inverted,
            when_finite(last.inverted_tets),
            result.steps_not_reached,
            cell.as_published ? "yes" : "no",
            result.cpu_s};
}

}  // namespace

CsvTable cells_csv(const std::vector<MeasuredCell>& cells)
{
    CsvTable table(columns);
    for (const MeasuredCell& measured : cells) table.add_row(row_of(measured));
    return table;
}

CsvTable stability_measurements(const std::vector<MeasuredCell>& cells)
{
    std::vector<analysis::Measurement> rows;
    for (const auto& [sweep, of] : by_sweep(cells)) {
        const auto add = [&, key = sweep, n = static_cast<int>(of.size())](const std::string& quantity, const ShareInterval& share) {
            rows.push_back({"C08", quantity, key, share.value, share.low, share.high, "1"});
            rows.back().n = n;
        };
        const double away = share(of, ran_away).value;
        add("share_of_cells_diverged", {away, away, away});
        add("share_of_cells_inverted", share(of, [](const CellResult& result) { return is(result, StabilityOutcome::inverted); }));
        add("share_of_cells_in_motion", share(of, never_rests));
        add("share_of_cells_at_rest", share(of, [](const CellResult& result) { return is(result, StabilityOutcome::converged); }));
    }
    return analysis::measurement_table(rows);
}

std::string outcome_table(const std::vector<CsvTable>& tables, bool by_factor)
{
    std::vector<std::string> order;
    std::map<std::string, std::map<std::string, int>> counts;
    for (const CsvTable& cells : tables)
        for (int row = 0; row < cells.rows(); ++row) {
            std::string key = fmt::format("{:<7} {:<31}", cells.text_at(row, "body"), cells.text_at(row, "model"));
            if (const std::string second = cells.text_at(row, "second_factor"); by_factor)
                key += fmt::format(" {:<24}", cells.text_at(row, "factor") + (second.empty() ? "" : " x " + second));
            if (!counts.count(key)) order.push_back(key);
            ++counts[key][cells.text_at(row, "outcome")];
        }
    std::string text = fmt::format("{:<7} {:<31}{}", "body", "model", by_factor ? fmt::format(" {:<24}", "factor") : "");
    for (const StabilityOutcome outcome : outcomes) text += fmt::format(" {:>10}", name_of(outcome));
    for (const std::string& key : order) {
        text += "\n" + key;
        for (const StabilityOutcome outcome : outcomes) text += fmt::format(" {:>10}", counts[key][name_of(outcome)]);
    }
    return text + "\n";
}

std::string blind_spots(const std::vector<CsvTable>& tables)
{
    std::map<std::string, int> counts;
    std::string missing;
    for (const CsvTable& cells : tables)
        for (int row = 0; row < cells.rows(); ++row) {
            const std::string& outcome = cells.text_at(row, "outcome");
            ++counts[outcome];
            const bool control = cells.text_at(row, "named") == "sign" || cells.text_at(row, "factor").starts_with("sign,");
            if (control && outcome != "diverged" && outcome != "not_finite")
                missing += fmt::format("the sign as printed does not run away: {}, {}\n", cells.text_at(row, "model"),
                                       cells.text_at(row, "precision"));
        }
    for (const StabilityOutcome outcome : outcomes)
        if (counts[name_of(outcome)] == 0) missing += fmt::format("no cell is {}\n", name_of(outcome));
    return missing;
}

CsvTable map_csv(const std::vector<CsvTable>& tables, const std::string& factor, const std::string& second_factor)
{
    CsvTable map({"factor", "value", "unit", "second_factor", "second_value", "second_unit", "precision", "outcome", "steps",
                  "last_inverted_tets", "recovery_steps"});
    const auto or_nothing = [](const std::optional<double>& value) {
        return value ? CsvTable::Cell(*value) : CsvTable::Cell(std::nullopt);
    };
    for (const CsvTable& cells : tables)
        for (int row = 0; row < cells.rows(); ++row) {
            if (cells.text_at(row, "factor") != factor || cells.text_at(row, "second_factor") != second_factor) continue;
            map.add_row({factor, cells.number(row, "value"), cells.text_at(row, "unit"), second_factor, cells.number(row, "second_value"),
                         cells.text_at(row, "second_unit"), cells.text_at(row, "precision"), cells.text_at(row, "outcome"),
                         static_cast<int>(cells.integer(row, "steps")), or_nothing(cells.number_or_nothing(row, "last_inverted_tets")),
                         or_nothing(cells.number_or_nothing(row, "recovery_steps"))});
        }
    return map;
}

}  // namespace experiments
