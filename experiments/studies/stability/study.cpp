// C08: is the method unconditionally stable, large time steps included? Each cell of the map disturbs a body, then holds it still, and has
// one of five outcomes by the same bounds for every method (analysis/stability_outcome.hpp).
//
//   pbs, pbs_jiggle   a limb of 400 vertices, bent by 90 degrees in ten steps; one factor at a time to its extremes, in f32 and f64.
//                     Without jiggle the time step does not enter: those cells are a row of their own, pbs_no_memory, and no figures.
//                     What is broken or moved at the start is gone there after one step: all that can fail is that step
//   pbs_maps          time step x k_stretch; iterations x twist
//   pbs_human, ...    characters landing from a jump
//   controls          Eq. 12-20 as printed, and teleports beyond the numbers' range: what instability looks like
//   xpbd              the same limb with a material, also in small steps
//   fem_static        linear, corotational and stable neo-Hookean in equilibrium
//   fem_in_time       the last two by generalised-alpha
// A broken start of the finite elements in equilibrium is where Newton's method sets out, in the last pose and without a load path; in time
// they are not asked. The linear ones have no start: a control.
//
// The judged share is that of the cells run but the controls, all of them, without an interval: one that runs away is enough against
// "unconditionally". The bind constraint holds what no longer has a right shape, so the shares inverted and still moving stand beside it.
// Writes DIR/stability/RUN/cells.csv and measurements.csv, and cells.csv, the maps, outcomes.md, criteria.md. It fails where an outcome
// occurs in no cell, or where the sign as printed does not run away: then the map could not tell stable from unstable.
#include "analysis/records/atomic_file.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/shared/real_bodies.hpp"
#include "experiments/studies/stability/cell_table.hpp"
#include "experiments/studies/stability/stability_body.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

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
    table_of(cell_columns, rows).write((fs::path(folder) / "cells.csv").string());
    const analysis::CsvTable shares = stability_measurements(measured);
    if (shares.rows() > 0) shares.write((fs::path(folder) / "measurements.csv").string());
    return {};
}

StudyRun stability_run(const std::string& name, const Cells& cells, double cost_s)
{
    return work_run<StabilityCase>(name, {cells}, cost_s, run_and_record);
}

void add_character(StudyPlan& plan, const std::string& body, bool full)
{
    try {
        plan.runs.push_back(stability_run("pbs_" + body, pbs_character_cells(body, full), full ? 20.0 : 9.0));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({body, error.what()});
    }
}

// --quick: the default character alone.
void add_characters(StudyPlan& plan, bool full)
{
    std::vector<analysis::LeftOut> left_out;
    for (const std::string& body : installed_bodies(left_out))
        if (full || body == "human") add_character(plan, body, full);
    for (const analysis::LeftOut& body : left_out)
        if (full || body.scene == "human") plan.left_out.push_back(body);
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
    finished.write("map_time_step_k_stretch.csv", map_csv(cells, "time step", "k_stretch"));
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
