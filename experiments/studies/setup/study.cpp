// C17: are characters of other resolutions and topologies accommodated without set-up? The text of one scene over every body and a ladder
// of sizes, character.body and character.vertices alone changed; each meshed anew. What does not run so is tried with further keys.
//
//   human at 1,200, 2,400 and 4,800 vertices; man, lady, frankie where installed; ring, a body with a handle
//
// Writes DIR/setup/BODY/measurements.csv, changed_keys.csv, trials.csv and run/ (a run's directory), and setup.csv.
#include "analysis/measurement.hpp"
#include "experiments/studies/shared/real_bodies.hpp"
#include "experiments/studies/setup/body_setup.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>

namespace experiments {
namespace {

namespace fs = std::filesystem;

StudyRun setup_run(const BodySetup& setup, double rate_hz, double cost_s)
{
    const std::string name = setup.vertices > 0 ? fmt::format("{}_{}", setup.body, setup.vertices) : setup.body;
    return work_run<SetupCase>(name, {setup, rate_hz}, cost_s, set_up_and_record);
}

// Of one run, by quantity.
std::map<std::string, analysis::Measurement> figures_of(const std::string& run)
{
    std::map<std::string, analysis::Measurement> figures;
    for (const auto& measured : analysis::measurements((fs::path(run) / "measurements.csv").string()))
        figures[measured.quantity] = measured;
    return figures;
}

std::string line_of(const std::map<std::string, analysis::Measurement>& figures)
{
    const auto& keys = figures.at("keys_changed");
    const auto& share = figures.at("share_of_sound_frames");
    if (!figures.contains("mean_volume_change_pct"))
        return fmt::format("{:<36} did not run with any of the further keys\n", text_of(keys.of));
    const auto& mean = figures.at("mean_volume_change_pct");
    return fmt::format("{:<36} {:>5.0f} {:>9.1f} [{:>5.1f}, {:>5.1f}] {:>8.2f} [{:>5.2f}, {:>5.2f}] {:>10.2f} {:>9.1f}\n", text_of(keys.of),
                       keys.value, 100.0 * share.value, 100.0 * share.low, 100.0 * share.high, mean.value, mean.low, mean.high,
                       figures.at("largest_volume_change_pct").value, figures.at("set_up_s").value);
}

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
    for (const BodySetup& setup : setups) try {
            plan.runs.push_back(setup_run(setup, full ? 100.0 : 5.0, full ? 9.0 : 5.5));
        } catch (const pbs::InputError& error) {  // the clip is not there
            plan.left_out.push_back({setup.body, error.what()});
        }
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    std::string text = fmt::format("{:<36} {:>5} {:>26} {:>24} {:>10} {:>9}\n", "body", "keys", "good frames [%]", "mean volume [%]",
                                   "worst [%]", "set-up [s]");
    std::vector<analysis::Measurement> all;
    for (const std::string& run : finished.folders) {
        const auto figures = figures_of(run);
        text += line_of(figures);
        for (const auto& [quantity, measured] : figures) all.push_back(measured);
    }
    finished.write("setup.csv", analysis::measurement_table(all));
    return {text, !finished.none()};
}

}  // namespace

Study setup_study()
{
    return {"setup", plan, quick_and_full, conclude};
}

}  // namespace experiments
