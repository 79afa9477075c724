#include "experiments/studies/stability/stability_cells.hpp"

#include "analysis/metrics/error_norms.hpp"
#include "analysis/metrics/stability_outcome.hpp"
#include "analysis/statistics/statistics.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/settings/scene_values.hpp"
#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

namespace experiments {
namespace {

using analysis::CsvTable;
using analysis::StabilityOutcome;

constexpr StabilityOutcome outcomes[] = {StabilityOutcome::converged, StabilityOutcome::bounded,
                                         StabilityOutcome::inverted, StabilityOutcome::diverged,
                                         StabilityOutcome::not_finite};

using Group = std::vector<const MeasuredCell*>;
using Keyed = std::vector<std::pair<analysis::CaseKey, Group>>;

// In the key of its values; empty: the cell has none.
std::string deformer_of(const StabilityCell& cell)
{
    if (cell.as_published) return "pbs";
    for (const char* model : {"pbs_printed_sign", "pbs_undisturbed", "pbs_author", "fem_stable_neo_hookean_in_time"})
        if (cell.model == model) return model;
    return {};
}

// The sweeps in the order of their first cells.
Keyed by_sweep(const std::vector<MeasuredCell>& cells)
{
    Keyed sweeps;
    for (const MeasuredCell& measured : cells) {
        const StabilityCell& cell = measured.cell;
        if (deformer_of(cell).empty() || cell.named == "not_used") continue;  // not_used: no time step of its own
        const auto* pbs = options_if<pbs::PbsOptions>(cell.spec);
        const analysis::CaseKey key = {.body = cell.body,
                                       .deformer = deformer_of(cell),
                                       .variant = pbs && pbs->jiggle ? "jiggle" : "",
                                       .order = traits_of(cell.spec).order,
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
    return std::any_of(steps.end() - looked_at, steps.end(),
                       [&](const auto& step) { return step.motion > bounds.rest_motion; });
}

// Whatever its shape, which may have inverted tets or differ from that of the undisturbed body.
bool is_at_rest(const CellResult& result)
{
    return !ran_away(result) && !never_rests(result) && result.steps.back().solved;
}

template <typename Predicate>
analysis::Interval share(const Group& cells, Predicate predicate)
{
    const auto counted =
        std::ranges::count_if(cells, [&](const MeasuredCell* measured) { return predicate(measured->result); });
    return analysis::share_interval(static_cast<int>(counted), static_cast<int>(cells.size()));
}

std::string yes_or_no(bool value)
{
    return value ? "yes" : "no";
}

// The deformer with so many iterations and all its other options. The numbers, texts and truth values of JSON are
// spelled as in TOML.
DeformerSpec with_iterations(const DeformerSpec& spec, int iterations)
{
    const DeformerKind& kind = *find_deformer_kind(spec.kind);
    nlohmann::json options = kind.options_json(spec);
    options["iterations"] = iterations;
    std::vector<std::string> overrides;
    for (const auto& [name, setting] : options.items())
        overrides.push_back(spec.kind + "." + name + "=" + setting.dump());
    DeformerSpec changed = spec;
    kind.read(SceneValues("schema = 1\n", "stability", overrides, scene_schema()), spec.kind, changed);
    return changed;
}

// The result of so many iterations from the broken shape of the cell, or from the deformer's own initial guess [m], #V
// x 3.
pbs::Positions result_of(StabilityCell cell, int iterations, bool is_broken)
{
    if (!is_broken) cell.disturbance.start = Start::none;
    cell.disturbance.stays = true;
    StabilityBody body(cell);
    const std::unique_ptr<Deformer> deformer = make_deformer(with_iterations(cell.spec, iterations));
    deformer->reset(body.character());
    const Drive drive = body.drive(0);
    if (is_broken) deformer->start_from(drive.blended);
    deformer->advance(drive.pose, cell.time_step_s);
    return deformer->positions();
}

std::optional<double> joint_pct(const StabilityCell& cell, const pbs::Positions& positions, const pbs::Positions& other)
{
    if (!positions.allFinite() || !other.allFinite()) return std::nullopt;
    return analysis::ErrorMetrics(error_domain(stability_character(cell), {})).measure(positions, other).joint_pct;
}

int inverted(const StabilityCell& cell, const pbs::Positions& positions)
{
    return static_cast<int>((pbs::tet_volumes(positions, stability_character(cell).mesh.tets).array() <= 0.0).count());
}

bool is_far(const StabilityCell& cell, const pbs::Positions& positions, const pbs::Positions& other)
{
    const pbs::Positions& rest = stability_character(cell).mesh.rest;
    const double diagonal_m = pbs::diagonal_m(rest);
    return (positions - other).rowwise().norm().maxCoeff() > analysis::StabilityBounds{}.farthest * diagonal_m;
}

// The least number of iterations from which on all distances are within the bound. pct: by increasing number of
// iterations.
std::optional<int> first_to_stay(const std::map<int, std::optional<double>>& pct)
{
    std::optional<int> first;
    for (const auto& [iterations, distance] : pct)
        if (!distance || *distance > reached_within_pct)
            first.reset();
        else if (!first)
            first = iterations;
    return first;
}

StartRow row_of(const StabilityCell& cell)
{
    StartRow row;
    row.body = cell.body;
    row.model = cell.model;
    row.precision = precision_of(cell);
    const Disturbance& disturbance = cell.disturbance;
    row.pose = fmt::format("{}_{:g}", disturbance.axis == pbs::Vec3::UnitX() ? "twist" : "bend", disturbance.angle_deg);
    row.start = name_of(disturbance.start);
    row.setting = cell.second_factor;
    if (!row.setting.empty()) row.setting_value = cell.second_value;
    return row;
}

}  // namespace

using Cells = analysis::Columns<StabilityCell>;
const analysis::Columns<CellRow> cell_columns =
    within(&CellRow::of, MEMBER_COLUMNS(StabilityCell, body, model, factor, value, unit, named, second_factor)) +
    analysis::Columns<CellRow>{{"second_value", &CellRow::second_value}} +
    within(&CellRow::of, Cells{{"second_unit", &StabilityCell::second_unit}}) +
    analysis::Columns<CellRow>{{"precision", &CellRow::precision}} +
    within(&CellRow::of, Cells{{"time_step_s", &StabilityCell::time_step_s}}) +
    MEMBER_COLUMNS(CellRow, steps, outcome, recovery_steps, recovery_s, iterations_until_reached, undisturbed_at_rest,
                   largest_reach_diagonals, last_reach_diagonals, last_motion_diagonals,
                   last_from_undisturbed_diagonals, most_inverted_tets, last_inverted_tets, steps_not_reached,
                   as_published, cpu_s);

CellRow cell_row(const MeasuredCell& measured)
{
    const auto& [cell, result] = measured;
    const auto& last = result.steps.back();
    CellRow row;
    row.of = cell;
    if (!cell.second_factor.empty()) row.second_value = cell.second_value;
    row.precision = precision_of(cell);
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
    for (const auto& [sweep, group] : by_sweep(cells)) {
        const auto add = [&, key = sweep](const std::string& quantity, const Group& among,
                                          const analysis::Interval& share) {
            rows.push_back({"C08", quantity, key, share.estimate, share.low, share.high, "1"});
            rows.back().n = static_cast<int>(among.size());
        };
        const auto add_at_rest = [&, whole = group](const std::string& quantity, double least_s, double most_s) {
            Group among = whole;
            std::erase_if(among, [&](const auto* measured) {
                return measured->cell.time_step_s < least_s || measured->cell.time_step_s > most_s;
            });
            if (among.empty()) return;
            const double at_rest = share(among, is_at_rest).estimate;
            add(quantity, among, {at_rest, at_rest, at_rest});
        };
        const double away = share(group, ran_away).estimate;
        add("share_of_cells_diverged", group, {away, away, away});
        add("share_of_cells_inverted", group,
            share(group, [](const CellResult& result) { return is(result, StabilityOutcome::inverted); }));
        add("share_of_cells_in_motion", group, share(group, never_rests));
        add("share_of_cells_at_rest", group,
            share(group, [](const CellResult& result) { return is(result, StabilityOutcome::converged); }));
        add_at_rest("share_of_cells_at_rest_in_small_steps", 0.0, 0.1);
        add_at_rest("share_of_cells_at_rest_in_large_steps", 0.05, std::numeric_limits<double>::infinity());
    }
    return analysis::measurement_table(rows);
}

std::string blind_spots(const std::vector<CellRow>& cells)
{
    std::map<std::string, int> counts;
    std::string missing;
    for (const CellRow& cell : cells) {
        ++counts[cell.outcome];
        if (cell.of.named == "sign" && cell.outcome != "diverged" && cell.outcome != "not_finite")
            missing += fmt::format("the sign as printed does not run away: {}, {}\n", cell.of.model, cell.precision);
    }
    for (const StabilityOutcome outcome : outcomes)
        if (counts[name_of(outcome)] == 0) missing += fmt::format("no cell is {}\n", name_of(outcome));
    return missing;
}

CsvTable map_csv(const std::vector<CellRow>& cells, const std::string& factor, const std::string& second_factor)
{
    analysis::Columns<CellRow> columns;
    for (const char* name : {"factor", "value", "unit", "second_factor", "second_value", "second_unit", "precision",
                             "outcome", "steps", "last_inverted_tets", "recovery_steps"})
        columns.push_back(cell_columns.named(name));
    std::vector<CellRow> map = cells;
    std::erase_if(
        map, [&](const CellRow& cell) { return cell.of.factor != factor || cell.of.second_factor != second_factor; });
    return table_of(columns, map);
}

const analysis::Columns<StartRow> start_columns = MEMBER_COLUMNS(
    StartRow, body, model, precision, pose, start, setting, setting_value, outcome, iterations_until_reached,
    most_iterations, from_own_result_pct, own_change_pct, inverted_tets, own_inverted_tets, reason, cpu_s);

StartRow run_broken_start(const StabilityCell& cell, int most_iterations)
{
    const double start_s = process_cpu_s();
    StartRow row = row_of(cell);
    row.most_iterations = most_iterations;
    const pbs::Positions own = result_of(cell, most_iterations, false),
                         half = result_of(cell, most_iterations / 2, false);
    row.own_change_pct = joint_pct(cell, half, own);
    std::map<int, std::optional<double>> pct;
    pbs::Positions last;
    bool is_finite = own.allFinite();
    for (int iterations = 1; iterations <= most_iterations; iterations *= 2) {
        last = result_of(cell, iterations, true);
        is_finite = is_finite && last.allFinite();
        pct[iterations] = row.from_own_result_pct = joint_pct(cell, last, own);
    }
    if (is_finite) {
        row.iterations_until_reached = first_to_stay(pct);
        row.inverted_tets = inverted(cell, last);
        row.own_inverted_tets = inverted(cell, own);
    }
    if (!is_finite)
        row.outcome = StartOutcome::not_finite;
    else if (is_far(cell, last, own))
        row.outcome = StartOutcome::diverged;
    else if (row.iterations_until_reached && *row.own_change_pct <= reached_within_pct)
        row.outcome = StartOutcome::reached;
    row.cpu_s = process_cpu_s() - start_s;
    return row;
}

std::string start_criteria_text(int most_iterations)
{
    return fmt::format(
        "\n## Broken initial shapes of the deformers that minimise an energy\n\n"
        "A deformer begins at a broken shape and runs 1, 2, 4, ... up to {} iterations. Its own result is that of {} "
        "iterations from its\n"
        "normal initial guess. Distances are root mean squares over the vertices at the joints, over their mean "
        "distance to the bones.\n"
        "The first that applies:\n\n"
        "| outcome | when |\n|---|---|\n"
        "| not_finite | a position of a result is not finite |\n"
        "| diverged | after the most iterations a vertex is farther than {:g} D from its place in the own result |\n"
        "| reached | after the most iterations the distance from the own result is at most {:g} %, and the own result "
        "moved by no more "
        "in the second half of its iterations |\n"
        "| not_reached | none of these: another equilibrium, too few iterations, or an own result that has not settled "
        "|\n"
        "| not_applicable | the method has no initial shape; `reason` states why |\n",
        most_iterations, most_iterations, analysis::StabilityBounds{}.farthest, reached_within_pct);
}

}  // namespace experiments
