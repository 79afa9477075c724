// C17: are characters of other resolutions and topologies accommodated without set-up? The text of one scene is run on every body and on a
// ladder of sizes, each meshed anew. Only character.body and character.vertices change. A body that fails is tried with further keys.
//
//   human at 1,200, 2,400 and 4,800 vertices; man, lady, frankie where installed; ring, a body with a handle
//
// Writes DIR/setup/BODY/measurements.csv, changed_keys.csv, trials.csv and run/ (the folder of a run), and setup.csv.
#include "analysis/records/report_table.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/studies/setup/body_setup.hpp"
#include "experiments/studies/study.hpp"

#include <algorithm>

namespace experiments {
namespace {

// A measured value with its interval, for the terminal.
struct ValueRow {
    std::string of, quantity;
    double value = 0.0, low = 0.0, high = 0.0;
    std::string unit;
};
const analysis::Columns<ValueRow> value_columns = {{"of", &ValueRow::of, "", "body, motion and size"},
                                                   {"quantity", &ValueRow::quantity, "", "what was measured"},
                                                   {"value", &ValueRow::value, "", "its value"},
                                                   {"low", &ValueRow::low, "", "lower end of its interval"},
                                                   {"high", &ValueRow::high, "", "upper end of its interval"},
                                                   {"unit", &ValueRow::unit, "", "1: none"}};

StudyPlan plan(bool full)
{
    return plan_of_cases("setup", full, [](const StudyCase& of, StudyPlan& plan) {
        const BodySetup setup{of.value<std::string>("body"), of.value("vertices", 0)};
        plan.runs.push_back(work_run<SetupCase>(of.name, {setup, of.value<double>("rate_hz")}, of.cost_s, set_up_and_record));
    });
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    std::vector<ValueRow> rows;
    std::vector<analysis::Measurement> all;
    for (const std::string& file : finished.files("measurements.csv")) {
        std::vector<analysis::Measurement> own = analysis::measurements(file);
        std::ranges::sort(own, {}, &analysis::Measurement::quantity);
        for (const auto& one : own) rows.push_back({text_of(one.of), one.quantity, one.value, one.low, one.high, one.unit});
        all.insert(all.end(), own.begin(), own.end());
    }
    finished.write("setup.csv", analysis::measurement_table(all));
    const std::string text = text_table(table_of(value_columns, rows), {{"body", "of"},
                                                                        {"quantity", "quantity"},
                                                                        {"value", "value", "{:.4g}", 1.0, "none"},
                                                                        {"low", "low", "{:.4g}"},
                                                                        {"high", "high", "{:.4g}"},
                                                                        {"unit", "unit"}});
    return {text, !finished.none()};
}

}  // namespace

Study setup_study()
{
    return {"setup", plan, quick_and_full, conclude};
}

}  // namespace experiments
