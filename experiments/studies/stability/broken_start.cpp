#include "experiments/studies/stability/cell_table.hpp"

#include "analysis/metrics/error_norms.hpp"
#include "analysis/metrics/stability_outcome.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/process/terminal.hpp"
#include "experiments/run/frame_measurement.hpp"
#include "experiments/studies/stability/cell_run.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace experiments {
namespace {

// The result of so many iterations from the broken shape of the cell, or from the deformer's own initial guess [m], #V x 3.
pbs::Positions result_of(StabilityCell cell, int iterations, bool is_broken)
{
    stop_if_interrupted();
    if (!is_broken) cell.disturbance.start = Start::none;
    cell.disturbance.stays = true;
    StabilityBody body(cell);
    const std::unique_ptr<Deformer> deformer = make_deformer(with_option(cell.spec, "iterations", iterations));
    deformer->reset(body.character());
    const Drive drive = body.drive(0);
    if (is_broken) deformer->start_from(drive.blended);
    deformer->advance(drive.pose, cell.time_step_s);
    return deformer->positions();
}

std::optional<double> joint_pct(const StabilityCell& cell, const pbs::Positions& one, const pbs::Positions& other)
{
    if (!one.allFinite() || !other.allFinite()) return std::nullopt;
    return analysis::ErrorMetrics(error_domain(stability_character(cell), {})).measure(one, other).joint_pct;
}

int inverted(const StabilityCell& cell, const pbs::Positions& positions)
{
    return static_cast<int>((pbs::tet_volumes(positions, stability_character(cell).mesh.tets).array() <= 0.0).count());
}

bool is_far(const StabilityCell& cell, const pbs::Positions& one, const pbs::Positions& other)
{
    const pbs::Positions& rest = stability_character(cell).mesh.rest;
    const double diagonal_m = (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm();
    return (one - other).rowwise().norm().maxCoeff() > analysis::StabilityBounds{}.farthest * diagonal_m;
}

// The least number of iterations from which on all distances are within the bound. pct: by increasing number of iterations.
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

std::string pose_of(const Disturbance& disturbance)
{
    return fmt::format("{}_{:g}", disturbance.axis == pbs::Vec3::UnitX() ? "twist" : "bend", disturbance.angle_deg);
}

StartRow row_of(const StabilityCell& cell)
{
    StartRow row;
    row.body = cell.body;
    row.model = cell.model;
    row.precision = precision_of(cell);
    row.pose = pose_of(cell.disturbance);
    row.start = name_of(cell.disturbance.start);
    row.setting = cell.second_factor;
    if (!row.setting.empty()) row.setting_value = cell.second_value;
    return row;
}

}  // namespace

const analysis::Columns<StartRow> start_columns = {
    {"body", &StartRow::body, "", "name of the body"},
    {"model", &StartRow::model, "", "deformer"},
    {"precision", &StartRow::precision, "", "f32 or f64"},
    {"pose", &StartRow::pose, "", "bend_90 or twist_90: the pose whose shape is sought"},
    {"start", &StartRow::start, "", "flattened, mirrored, random or point: the initial shape"},
    {"setting", &StartRow::setting, "", "the option that is changed; empty: all have their defaults"},
    {"setting_value", &StartRow::setting_value, "", "its value"},
    {"outcome", &StartRow::outcome, "", "reached, not_reached, diverged, not_finite or not_applicable; criteria.md defines them"},
    {"iterations_until_reached", &StartRow::iterations_until_reached, "",
     "the first tried number of iterations from which on all end within the bound; the tried numbers are powers of two"},
    {"most_iterations", &StartRow::most_iterations, "", "the largest number of iterations that was tried"},
    {"from_own_result_pct", &StartRow::from_own_result_pct, "%",
     "distance at the joints from the deformer's own result after these iterations; empty: not finite"},
    {"own_change_pct", &StartRow::own_change_pct, "%",
     "how far the own result moves at the joints in the second half of its iterations; empty: not finite"},
    {"inverted_tets", &StartRow::inverted_tets, "", "inverted tets after these iterations"},
    {"own_inverted_tets", &StartRow::own_inverted_tets, "", "inverted tets in the own result"},
    {"reason", &StartRow::reason, "", "why a broken start is not applicable"},
    {"cpu_s", &StartRow::cpu_s, "s", "processor time"}};

StartRow run_broken_start(const StabilityCell& cell, int most_iterations)
{
    const double start_s = process_cpu_s();
    StartRow row = row_of(cell);
    row.most_iterations = most_iterations;
    const pbs::Positions own = result_of(cell, most_iterations, false), half = result_of(cell, most_iterations / 2, false);
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

std::string start_table(const std::vector<StartRow>& rows)
{
    std::vector<std::string> order;
    std::map<std::string, std::map<StartOutcome, int>> counts;
    for (const StartRow& row : rows) {
        const std::string setting = row.setting.empty() ? "" : fmt::format("{} {:g}", row.setting, row.setting_value.value_or(0.0));
        const std::string key = fmt::format("{:<7} {:<20} {:<9} {:<25}", row.body, row.model, row.pose, setting);
        if (!counts.count(key)) order.push_back(key);
        ++counts[key][row.outcome];
    }
    std::string text = fmt::format("{:<7} {:<20} {:<9} {:<25}", "body", "model", "pose", "setting");
    for (const auto& [outcome, name] : analysis::EnumNames<StartOutcome>::table) text += fmt::format(" {:>14}", name);
    for (const std::string& key : order) {
        text += "\n" + key;
        for (const auto& [outcome, name] : analysis::EnumNames<StartOutcome>::table) text += fmt::format(" {:>14}", counts[key][outcome]);
    }
    return text + "\n";
}

std::string start_criteria_text(int most_iterations)
{
    return fmt::format(
        "\n## Broken initial shapes of the deformers that minimise an energy\n\n"
        "A deformer begins at a broken shape and runs 1, 2, 4, ... up to {} iterations. Its own result is that of {} iterations from its\n"
        "normal initial guess. Distances are root mean squares over the vertices at the joints, over their mean distance to the bones.\n"
        "The first that applies:\n\n"
        "| outcome | when |\n|---|---|\n"
        "| not_finite | a position of a result is not finite |\n"
        "| diverged | after the most iterations a vertex is farther than {:g} D from its place in the own result |\n"
        "| reached | after the most iterations the distance from the own result is at most {:g} %, and the own result moved by no more "
        "in the second half of its iterations |\n"
        "| not_reached | none of these: another equilibrium, too few iterations, or an own result that has not settled |\n"
        "| not_applicable | the method has no initial shape; `reason` states why |\n",
        most_iterations, most_iterations, analysis::StabilityBounds{}.farthest, reached_within_pct);
}

}  // namespace experiments
