// C08: is the method unconditionally stable, large time steps included? Each cell of the map disturbs a body, then
// holds it still, and has one of five outcomes by the same bounds for every method
// (analysis/metrics/stability_outcome.hpp). README.md describes the runs, the records, the threshold of rest, and why
// the study itself may fail.
//
// Without jiggle the time step has no effect; those cells have the model pbs_no_memory and are not judged. A broken or
// moved initial state has no effect after one step, so that only this step can fail. The finite elements in equilibrium
// take a broken initial state as the initial guess of Newton's method in the last pose, without a load path. The finite
// elements in time have no such cells.
//
// The verdict follows from the share of cells at rest at the end. The bind constraint bounds a body that has lost its
// shape, so the shares of diverged and inverted bodies and of those that end as if undisturbed are reported as well.
#include "analysis/records/record_files.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/stability/stability_cells.hpp"
#include "experiments/studies/study.hpp"

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

RECORD_SETTINGS_AND(StabilityCase,
                    .derived("scenes",
                             [](const StabilityCase& stability_case) { return scenes_of(stability_case.cells); })
                        .constant("seed", stability_seed)
                        .constant("criteria", analysis::criteria_text() + endings_text()),
                    cells)

RECORD_SETTINGS_AND(
    BrokenStartsCase,
    .derived("scenes", [](const BrokenStartsCase& broken_starts_case) { return scenes_of(broken_starts_case.cells); })
        .constant("seed", stability_seed)
        .derived("criteria",
                 [](const BrokenStartsCase& broken_starts_case) {
                     return start_criteria_text(broken_starts_case.most_iterations);
                 }),
    cells, most_iterations)

std::string run_and_record(const StabilityCase& stability_case, const std::string& folder)
{
    std::vector<MeasuredCell> measured;
    std::vector<CellRow> rows;
    for (const StabilityCell& cell : stability_case.cells) {
        measured.push_back({cell, run_cell(cell)});
        rows.push_back(cell_row(measured.back()));
    }
    table_of(cell_columns, rows).write(analysis::path_in(folder, "cells.csv"));
    const analysis::CsvTable shares = stability_measurements(measured);
    if (shares.rows() > 0) shares.write(analysis::path_in(folder, "measurements.csv"));
    return {};
}

std::string start_and_record(const BrokenStartsCase& broken_starts_case, const std::string& folder)
{
    std::vector<StartRow> rows;
    for (const StabilityCell& cell : broken_starts_case.cells)
        rows.push_back(run_broken_start(cell, broken_starts_case.most_iterations));
    for (const StartRow& row : starts_not_applicable()) rows.push_back(row);
    table_of(start_columns, rows).write(analysis::path_in(folder, "starts.csv"));
    return {};
}

StudyPlan plan(bool full)
{
    return plan_of_cases("stability", full, [](const StudyCase& study_case, StudyPlan& plan) {
        const Cells cells =
            stability_cells(study_case.value<std::string>("cells"), study_case.value("body", StabilityCell().body));
        if (study_case.has("most_iterations"))
            plan.runs.push_back(work_run<BrokenStartsCase>(study_case.name,
                                                           {cells, study_case.value<int>("most_iterations")},
                                                           study_case.cost_s, start_and_record));
        else
            plan.runs.push_back(work_run<StabilityCase>(study_case.name, {cells}, study_case.cost_s, run_and_record));
    });
}

bool conclude(const FinishedRuns& finished)
{
    const std::vector<CellRow> cells = finished.rows(cell_columns, "cells.csv");
    finished.write("cells.csv", cell_columns, cells);
    finished.write("map_time_step_k_stretch.csv", map_csv(cells, "time_step", "k_stretch"));
    finished.write("map_iterations_twist.csv", map_csv(cells, "iterations", "twist"));
    const std::vector<StartRow> starts = finished.rows(start_columns, "starts.csv");
    std::string criteria = analysis::criteria_text() + endings_text();
    if (!starts.empty()) {
        finished.write("starts.csv", start_columns, starts);
        criteria += start_criteria_text(starts.front().most_iterations);
    }
    finished.write("criteria.md", criteria);
    const std::string missing = blind_spots(cells);
    if (!missing.empty()) spdlog::error("pbskin: the map of stability cannot tell stable from unstable:\n{}", missing);
    return missing.empty();
}

}  // namespace

Study stability_study()
{
    return {"stability", plan, quick_and_full, conclude};
}

}  // namespace experiments
