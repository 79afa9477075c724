// The readings of the paper (ambiguity/reading.hpp): how much each changes the volume, the jiggling, and the verdicts of C01 and C02. Those
// two alone are judged again: they are what one sweep or clip decides; the figures of other claims are of cases of their own.
//
//   limb_twist, limb_bend   the scenes' sweeps, each step by itself
//   human                   the clip 01_01, five frames a second, each step by itself
//   human_moving            what remembers the last step: every step of six seconds of the clip (--full: of all of it)
//
// Writes DIR/ambiguity/RUN/ambiguity.csv, and ambiguity.csv and ambiguity.md of all of them.
#include "analysis/atomic_file.hpp"
#include "experiments/ambiguity/ambiguity_table.hpp"
#include "experiments/deformers/option_names.hpp"
#include "experiments/error_split/posed_character.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <filesystem>
#include <map>

namespace experiments {
namespace {

namespace fs = std::filesystem;

std::string read_and_record(const Scene& scene, const std::vector<Reading>& readings, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(scene.character);
    const std::vector<bool> zone = pbs::jiggle_zone(character.binding);
    std::map<std::string, ReadMotion> baselines;
    AmbiguityTable table;
    std::string breakdown;
    for (const Reading& reading : readings) {
        ReadMotion moved = move(character, scene, reading);
        if (!moved.finite) breakdown += reading.name + " is not finite. ";
        if (reading.place.empty())
            baselines.emplace(reading.name, std::move(moved));
        else
            table.add(scene, reading, baselines.at(reading.baseline), moved, baselines.at(own_reading), zone);
    }
    table.table().write((fs::path(folder) / "ambiguity.csv").string());
    return breakdown;
}

StudyRun ambiguity_run(const std::string& name, Scene scene, bool moving, double cost_s)
{
    scene.name = name;
    const pbs::PbsOptions own = spec_of(scene, "pbs").pbs;
    const std::vector<Reading> readings = moving ? readings_of_motion(own) : readings_of_a_step(own);
    nlohmann::json settings;
    for (const Reading& reading : readings) settings.push_back(to_json(reading));
    return {.name = name,
            .cost_s = cost_s,
            .work = [=](const std::string& folder) { return read_and_record(scene, readings, folder); },
            .settings = {{"scene", resolved_with_deformers(scene)}, {"readings", settings}}};
}

}  // namespace

StudyPlan plan_ambiguity_study(bool full)
{
    StudyPlan plan;
    plan.runs.push_back(ambiguity_run("limb_twist", read_scene("limb_twist", {}), false, 1.0));
    plan.runs.push_back(ambiguity_run("limb_bend", read_scene("limb_bend", {}), false, 1.0));
    try {
        const std::vector<std::string> five_a_second = {"motion.rate_hz=5.0", "output.frames=[]", "output.frame_names=[]"};
        std::vector<std::string> moving = five_a_second;
        if (!full) moving.insert(moving.end(), {"motion.start_s=1.0", "motion.duration_s=6.0"});
        plan.runs.push_back(ambiguity_run("human", read_scene("human_01_01", five_a_second), false, 3.5));
        plan.runs.push_back(ambiguity_run("human_moving", read_scene("human_01_01", moving), true, full ? 45.0 : 10.0));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({"human", error.what()});
    }
    return plan;
}

StudyConclusion conclude_ambiguity_study(const std::string& folder, const StudyPlan&, const std::vector<std::string>& finished)
{
    analysis::CsvTable all{{}};
    for (const std::string& run : finished) all.append(analysis::read_csv((fs::path(run) / "ambiguity.csv").string()));
    all.write((fs::path(folder) / "ambiguity.csv").string());
    const std::string table = finished.empty() ? "" : ambiguity_markdown({all});
    analysis::write_text_atomically((fs::path(folder) / "ambiguity.md").string(), table);
    return {table, !finished.empty()};
}

}  // namespace experiments
