// C08: is the method unconditionally stable, large time steps included? Each cell of the map disturbs a body, then holds it still, and has
// one of five outcomes by the same bounds for every method (analysis/stability_outcome.hpp).
//
//   pbs, pbs_jiggle   a limb of 400 vertices, bent by 90 degrees in ten steps; one factor at a time to its extremes, in f32 and f64.
//                     Without jiggle the time step has no effect; those cells have the model pbs_no_memory and are not judged. A broken
//                     or moved initial state is gone after one step, so that only this step can fail
//   pbs_maps          time step x k_stretch; iterations x twist
//   pbs_human, ...    characters landing from a jump
//   controls          Eq. 12-20 as printed, and teleports beyond the range of the numbers: here instability must be seen
//   xpbd              the same limb with a material, also in small steps
//   other_deformers   the same limb with the methods that minimise the energy of flesh, and with delta mush
//   fem_static        linear, corotational and stable neo-Hookean in equilibrium
//   fem_in_time       the last two by generalised-alpha
// A broken initial state of the finite elements in equilibrium is the initial guess of Newton's method in the last pose, without a load
// path. It is not tried in time. The linear elements need no initial guess and are a control.
//
// Judged is the share of diverged cells among all cells but the controls, without an interval: one diverged cell refutes "unconditionally".
// The bind constraint bounds a body that has lost its shape, so the shares of inverted and of moving bodies are reported as well.
// Writes DIR/stability/RUN/cells.csv and measurements.csv, and cells.csv, the maps, outcomes.md and criteria.md. The study fails where an
// outcome occurs in no cell, or where the printed sign does not diverge: then the map could not tell stable from unstable.
#include "analysis/records/folder_files.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/shared/real_bodies.hpp"
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

nlohmann::json scenes_of(const StabilityCase& of)
{
    nlohmann::json scenes = nlohmann::json::object();
    for (const StabilityCell& cell : of.cells)
        if (!scenes.contains(cell.body)) scenes[cell.body] = stability_scene(cell.body).resolved;
    return scenes;
}

nlohmann::json to_json(const StabilityCase& of)
{
    static const auto fields = OptionFields<StabilityCase>("stability")
                                   .record("cells", &StabilityCase::cells)
                                   .derived("scenes", scenes_of)
                                   .constant("seed", stability_seed)
                                   .constant("criteria", analysis::criteria_text() + endings_text())
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
    plan.runs.push_back(stability_run("controls", negative_controls(full), 2.0));
    plan.runs.push_back(stability_run("xpbd", xpbd_cells(full), full ? 80.0 : 14.0));
    plan.runs.push_back(stability_run("other_deformers", other_cells(full), full ? 30.0 : 5.0));
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
    finished.write("outcomes.md", "```\n" + outcome_table(cells, true) + "```\n");
    finished.write("criteria.md", analysis::criteria_text() + endings_text());
    const std::string missing = blind_spots(cells);
    return {outcome_table(cells, false) + missing, missing.empty()};
}

}  // namespace

Study stability_study()
{
    return {"stability", plan, quick_and_full, conclude};
}

}  // namespace experiments
