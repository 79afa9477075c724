// C17: are characters of other resolutions and topologies accommodated without set-up? The text of one scene is run on every body and on a
// ladder of sizes, each meshed anew. Only character.body and character.vertices change. A body that fails is tried with further keys.
//
//   human at 1,200, 2,400 and 4,800 vertices; man, lady, frankie where installed; ring, a body with a handle
//
// Writes DIR/setup/BODY/measurements.csv, changed_keys.csv, trials.csv and run/ (the folder of a run), and setup.csv.
#include "analysis/records/report_table.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/studies/setup/body_setup.hpp"
#include "experiments/studies/shared/real_bodies.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

StudyRun setup_run(const BodySetup& setup, double rate_hz, double cost_s)
{
    const std::string name = setup.vertices > 0 ? fmt::format("{}_{}", setup.body, setup.vertices) : setup.body;
    return work_run<SetupCase>(name, {setup, rate_hz}, cost_s, set_up_and_record);
}

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
    StudyPlan plan;
    std::vector<BodySetup> setups;
    for (const std::string& body : installed_bodies(plan.left_out))
        if (body == "human")
            setups.insert(setups.end(), {{body, 1200}, {body, 2400}, {body, 4800}});
        else
            setups.push_back({body});
    setups.push_back({"ring"});
    for (const BodySetup& setup : setups) {
        try {
            plan.runs.push_back(setup_run(setup, full ? 100.0 : 5.0, full ? 9.0 : 5.5));
        } catch (const pbs::InputError& error) {  // the clip is missing
            plan.left_out.push_back({setup.body, error.what()});
        }
    }
    return plan;
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
