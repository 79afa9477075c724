// C08: is the method unconditionally stable, large time steps included? Each cell of the map disturbs a body, then holds it still, and has
// one of five outcomes by the same bounds for every method (analysis/metrics/stability_outcome.hpp).
//
//   pbs, pbs_jiggle   a limb of 400 vertices, bent by 90 degrees in ten steps; one factor at a time to its extremes, in f32 and f64.
//                     Without jiggle the time step has no effect; those cells have the model pbs_no_memory and are not judged. A broken
//                     or moved initial state has no effect after one step, so that only this step can fail
//   pbs_maps          time step x k_stretch; iterations x twist
//   pbs_human, ...    characters landing from a jump
//   controls          Eq. 12-20 as printed, and teleports beyond the range of the numbers: here instability must be seen
//   xpbd              the same limb with a material, also in small steps
//   other_deformers   the same limb with the methods that minimise the energy of flesh, with both delta mushes and with pbs_author
//   broken_starts     these methods from broken initial shapes: whether each finds its own result again (broken_start.hpp)
//   fem_static        linear, corotational and stable neo-Hookean in equilibrium
//   fem_in_time       the last two by generalised-alpha
// The finite elements in equilibrium take a broken initial state as the initial guess of Newton's method in the last pose, without a load
// path. The finite elements in time have no such cells. The linear elements need no initial guess and are a control.
//
// The verdict follows from the share of diverged cells among the cells as published, without an interval: one diverged cell refutes
// "unconditionally".
// The bind constraint bounds a body that has lost its shape, so the shares of inverted and of moving bodies are reported as well.
// Writes DIR/stability/RUN/cells.csv and measurements.csv, and cells.csv, the maps, starts.csv, outcomes.md and criteria.md. The study
// fails where an outcome occurs in no cell, or where the printed sign does not diverge: then the map could not tell stable from unstable.
#include "analysis/records/record_files.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/shared/real_bodies.hpp"
#include "experiments/studies/stability/broken_start.hpp"
#include "experiments/studies/stability/cell_table.hpp"
#include "experiments/studies/stability/stability_body.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "experiments/studies/study.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace experiments {
namespace {

using Cells = std::vector<StabilityCell>;

struct StabilityCase {
    Cells cells;
};

struct BrokenStartsCase {
    Cells cells;
    int most_iterations = 0;
};

nlohmann::json scenes_of(const Cells& cells)
{
    nlohmann::json scenes = nlohmann::json::object();
    for (const StabilityCell& cell : cells)
        if (!scenes.contains(cell.body)) scenes[cell.body] = stability_scene(cell.body).resolved;
    return scenes;
}

nlohmann::json to_json(const StabilityCase& of)
{
    static const auto fields = OptionFields<StabilityCase>("stability")
                                   .record("cells", &StabilityCase::cells)
                                   .derived("scenes", [](const StabilityCase& of) { return scenes_of(of.cells); })
                                   .constant("seed", stability_seed)
                                   .constant("criteria", analysis::criteria_text() + endings_text())
                                   .complete();
    return fields.json(of);
}

nlohmann::json to_json(const BrokenStartsCase& of)
{
    static const auto fields = OptionFields<BrokenStartsCase>("broken_starts")
                                   .record("cells", &BrokenStartsCase::cells)
                                   .record("most_iterations", &BrokenStartsCase::most_iterations)
                                   .derived("scenes", [](const BrokenStartsCase& of) { return scenes_of(of.cells); })
                                   .constant("seed", stability_seed)
                                   .derived("criteria", [](const BrokenStartsCase& of) { return start_criteria_text(of.most_iterations); })
                                   .complete();
    return fields.json(of);
}

std::string run_and_record(const StabilityCase& of, const std::string& folder)
{
    std::vector<MeasuredCell> measured;
    std::vector<CellRow> rows;
    for (const StabilityCell& cell : of.cells) {
        measured.push_back({cell, run_cell(cell)});
        rows.push_back(cell_row(measured.back()));
    }
    table_of(cell_columns, rows).write(analysis::path_in(folder, "cells.csv"));
    const analysis::CsvTable shares = stability_measurements(measured);
    if (shares.rows() > 0) shares.write(analysis::path_in(folder, "measurements.csv"));
    return {};
}

std::string start_and_record(const BrokenStartsCase& of, const std::string& folder)
{
    std::vector<StartRow> rows;
    for (const StabilityCell& cell : of.cells) rows.push_back(run_broken_start(cell, of.most_iterations));
    for (const StartRow& row : starts_not_applicable()) rows.push_back(row);
    table_of(start_columns, rows).write(analysis::path_in(folder, "starts.csv"));
    return {};
}

StudyRun stability_run(const std::string& name, const Cells& cells, double cost_s)
{
    return work_run<StabilityCase>(name, {cells}, cost_s, run_and_record);
}

// Without --full only the default character is run.
void add_characters(StudyPlan& plan, bool full)
{
    const auto is_run = [full](const std::string& body) { return full || body == "human"; };
    std::vector<analysis::LeftOut> left_out;
    for_each_installed_body(left_out, [&](const std::string& body) {
        if (is_run(body)) plan.runs.push_back(stability_run("pbs_" + body, pbs_character_cells(body, full), full ? 20.0 : 9.0));
    });
    for (const analysis::LeftOut& body : left_out)
        if (is_run(body.scene)) plan.left_out.push_back(body);
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    plan.runs.push_back(stability_run("pbs", pbs_cells(false, full), full ? 8.0 : 2.0));
    plan.runs.push_back(stability_run("pbs_jiggle", pbs_cells(true, full), full ? 95.0 : 21.0));
    plan.runs.push_back(stability_run("pbs_maps", pbs_map_cells(full), full ? 105.0 : 18.0));
    add_characters(plan, full);
    plan.runs.push_back(stability_run("controls", negative_controls(), 2.0));
    plan.runs.push_back(stability_run("xpbd", xpbd_cells(full), full ? 80.0 : 14.0));
    plan.runs.push_back(stability_run("other_deformers", other_cells(full), full ? 18.0 : 7.0));
    plan.runs.push_back(
        work_run<BrokenStartsCase>("broken_starts", {start_cells(full), full ? 4096 : 1024}, full ? 60.0 : 13.0, start_and_record));
    plan.runs.push_back(stability_run("fem_static", fem_static_cells(full), full ? 208.0 : 40.0));
    plan.runs.push_back(stability_run("fem_in_time", fem_dynamic_cells(full), full ? 350.0 : 22.0));
    std::string counts;
    std::size_t all = 0;
    for (const StudyRun& run : plan.runs) {
        const std::size_t count = run.settings.at("cells").size();
        counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", run.name, count);
        all += count;
    }
    spdlog::info("{} cells: {}", all, counts);
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    const std::vector<CellRow> cells = finished.rows(cell_columns, "cells.csv");
    finished.write("cells.csv", cell_columns, cells);
    finished.write("map_time_step_k_stretch.csv", map_csv(cells, "time_step", "k_stretch"));
    finished.write("map_iterations_twist.csv", map_csv(cells, "iterations", "twist"));
    const std::vector<StartRow> starts = finished.rows(start_columns, "starts.csv");
    std::string criteria = analysis::criteria_text() + endings_text(), outcomes = "```\n" + outcome_table(cells, true) + "```\n";
    if (!starts.empty()) {
        finished.write("starts.csv", start_columns, starts);
        criteria += start_criteria_text(starts.front().most_iterations);
        outcomes += "\n```\n" + start_table(starts) + "```\n";
    }
    finished.write("outcomes.md", outcomes);
    finished.write("criteria.md", criteria);
    const std::string missing = blind_spots(cells);
    return {outcome_table(cells, false) + (starts.empty() ? "" : "\n" + start_table(starts)) + missing, missing.empty()};
}

}  // namespace

Study stability_study()
{
    return {"stability", plan, quick_and_full, conclude};
}

}  // namespace experiments
