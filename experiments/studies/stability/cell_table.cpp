#include "experiments/studies/stability/cell_table.hpp"

#include "analysis/statistics/statistics.hpp"
#include "analysis/verdicts/measurement.hpp"
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

using Keyed = std::vector<std::pair<analysis::CaseKey, std::vector<const MeasuredCell*>>>;

bool jiggles(const StabilityCell& cell)
{
    const auto* pbs = options_if<pbs::PbsOptions>(cell.spec);
    return pbs && pbs->jiggle;
}

// The sweeps in the order of their first cells.
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

// The outcome is bounded or inverted, and the body moves in one of the last steps that are examined for `converged`.
bool never_rests(const CellResult& result)
{
    if (!is(result, StabilityOutcome::bounded) && !is(result, StabilityOutcome::inverted)) return false;
    const analysis::StabilityBounds bounds;
    const auto& steps = result.steps;
    const auto looked_at = std::min<std::ptrdiff_t>(std::ssize(steps), bounds.still_steps);
    return std::any_of(steps.end() - looked_at, steps.end(), [&](const auto& step) { return step.motion > bounds.rest_motion; });
}

template <typename Predicate>
analysis::Interval share(const std::vector<const MeasuredCell*>& cells, Predicate of)
{
    const auto counted = std::ranges::count_if(cells, [&](const MeasuredCell* measured) { return of(measured->result); });
    return analysis::share_interval(static_cast<int>(counted), static_cast<int>(cells.size()));
}

std::string yes_or_no(bool value)
{
    return value ? "yes" : "no";
}

}  // namespace

const analysis::Columns<CellRow> cell_columns = {
    {"body", &CellRow::body, "", "name of the body"},
    {"model", &CellRow::model, "", "method: pbs, pbs_jiggle, xpbd, ..."},
    {"factor", &CellRow::factor, "", "what is varied"},
    {"value", &CellRow::value, "", "its value, in the unit of the next column"},
    {"unit", &CellRow::unit, "", "unit of the value; empty: none"},
    {"named", &CellRow::named, "", "value of a factor without numbers: flattened"},
    {"second_factor", &CellRow::second_factor, "", "what else a map varies; empty elsewhere"},
    {"second_value", &CellRow::second_value, "", "its value"},
    {"second_unit", &CellRow::second_unit, "", "unit of that value"},
    {"precision", &CellRow::precision, "", "f32 or f64"},
    {"time_step_s", &CellRow::time_step_s, "s", "time step"},
    {"steps", &CellRow::steps, "", "steps that were run"},
    {"outcome", &CellRow::outcome, "", "converged, bounded, inverted, diverged or not_finite; criteria.md defines them"},
    {"recovery_steps", &CellRow::recovery_steps, "", "still steps until the body was at rest; empty: it was not"},
    {"recovery_s", &CellRow::recovery_s, "s", "the same as time"},
    {"iterations_until_reached", &CellRow::iterations_until_reached, "",
     "from a broken initial state: iterations until the pose was reached"},
    {"undisturbed_at_rest", &CellRow::undisturbed_at_rest, "", "yes: the same body comes to rest if nothing disturbs it"},
    {"largest_reach_diagonals", &CellRow::largest_reach_diagonals, "diagonals", "largest distance of a vertex from its place on the bones"},
    {"last_reach_diagonals", &CellRow::last_reach_diagonals, "diagonals", "the same in the last step; empty where it is not finite"},
    {"last_motion_diagonals", &CellRow::last_motion_diagonals, "diagonals", "how far a vertex moved in the last step"},
    {"last_from_undisturbed_diagonals", &CellRow::last_from_undisturbed_diagonals, "diagonals",
     "distance from the undisturbed body in the last step"},
    {"most_inverted_tets", &CellRow::most_inverted_tets, "", "largest number of inverted tets in a step"},
    {"last_inverted_tets", &CellRow::last_inverted_tets, "", "inverted tets in the last step"},
    {"steps_not_reached", &CellRow::steps_not_reached, "", "steps whose solver did not converge"},
    {"as_published", &CellRow::as_published, "", "yes: the method of the paper with settings that it allows, which C08 is judged by"},
    {"cpu_s", &CellRow::cpu_s, "s", "processor time"}};

CellRow cell_row(const MeasuredCell& measured)
{
    const auto& [cell, result] = measured;
    const auto& last = result.steps.back();
    CellRow row;
    row.body = cell.body;
    row.model = cell.model;
    row.factor = cell.factor;
    row.value = cell.value;
    row.unit = cell.unit;
    row.named = cell.named;
    row.second_factor = cell.second_factor;
    if (!cell.second_factor.empty()) row.second_value = cell.second_value;
    row.second_unit = cell.second_unit;
    row.precision = precision_of(cell);
    row.time_step_s = cell.time_step_s;
    row.steps = static_cast<int>(result.steps.size());
    row.outcome = name_of(result.stability.outcome);
    row.recovery_steps = result.stability.recovery_steps;
    if (row.recovery_steps) row.recovery_s = *row.recovery_steps * cell.time_step_s;
    row.iterations_until_reached = result.iterations_until_reached;
    row.undisturbed_at_rest = yes_or_no(result.has_undisturbed);
    for (const auto& step : result.steps) {
        row.largest_reach_diagonals = std::max(row.largest_reach_diagonals, step.reach);
        row.most_inverted_tets = std::max(row.most_inverted_tets, step.inverted_tets);
    }
    if (last.finite) {
        row.last_reach_diagonals = last.reach;
        row.last_motion_diagonals = last.motion;
        if (result.has_undisturbed) row.last_from_undisturbed_diagonals = last.from_undisturbed;
        row.last_inverted_tets = last.inverted_tets;
    }
    row.steps_not_reached = result.steps_not_reached;
    row.as_published = yes_or_no(cell.as_published);
    row.cpu_s = result.cpu_s;
    return row;
}

CsvTable stability_measurements(const std::vector<MeasuredCell>& cells)
{
    std::vector<analysis::Measurement> rows;
    for (const auto& [sweep, of] : by_sweep(cells)) {
        const auto add = [&, key = sweep](const std::string& quantity, const analysis::Interval& share) {
            rows.push_back({"C08", quantity, key, share.estimate, share.low, share.high, "1"});
            rows.back().n = static_cast<int>(of.size());
        };
        const double away = share(of, ran_away).estimate;
        add("share_of_cells_diverged", {away, away, away});
        add("share_of_cells_inverted", share(of, [](const CellResult& result) { return is(result, StabilityOutcome::inverted); }));
        add("share_of_cells_in_motion", share(of, never_rests));
        add("share_of_cells_at_rest", share(of, [](const CellResult& result) { return is(result, StabilityOutcome::converged); }));
    }
    return analysis::measurement_table(rows);
}

std::string outcome_table(const std::vector<CellRow>& cells, bool by_factor)
{
    std::vector<std::string> order;
    std::map<std::string, std::map<std::string, int>> counts;
    for (const CellRow& cell : cells) {
        std::string key = fmt::format("{:<7} {:<31}", cell.body, cell.model);
        if (by_factor) key += fmt::format(" {:<24}", cell.factor + (cell.second_factor.empty() ? "" : " x " + cell.second_factor));
        if (!counts.count(key)) order.push_back(key);
        ++counts[key][cell.outcome];
    }
    std::string text = fmt::format("{:<7} {:<31}{}", "body", "model", by_factor ? fmt::format(" {:<24}", "factor") : "");
    for (const StabilityOutcome outcome : outcomes) text += fmt::format(" {:>10}", name_of(outcome));
    for (const std::string& key : order) {
        text += "\n" + key;
        for (const StabilityOutcome outcome : outcomes) text += fmt::format(" {:>10}", counts[key][name_of(outcome)]);
    }
    return text + "\n";
}

std::string blind_spots(const std::vector<CellRow>& cells)
{
    std::map<std::string, int> counts;
    std::string missing;
    for (const CellRow& cell : cells) {
        ++counts[cell.outcome];
        if (cell.named == "sign" && cell.outcome != "diverged" && cell.outcome != "not_finite")
            missing += fmt::format("the sign as printed does not run away: {}, {}\n", cell.model, cell.precision);
    }
    for (const StabilityOutcome outcome : outcomes)
        if (counts[name_of(outcome)] == 0) missing += fmt::format("no cell is {}\n", name_of(outcome));
    return missing;
}

CsvTable map_csv(const std::vector<CellRow>& cells, const std::string& factor, const std::string& second_factor)
{
    analysis::Columns<CellRow> columns;
    for (const char* name : {"factor", "value", "unit", "second_factor", "second_value", "second_unit", "precision", "outcome", "steps",
                             "last_inverted_tets", "recovery_steps"})
        columns.push_back(cell_columns.named(name));
    std::vector<CellRow> map = cells;
    std::erase_if(map, [&](const CellRow& cell) { return cell.factor != factor || cell.second_factor != second_factor; });
    return table_of(columns, map);
}

}  // namespace experiments
