// C17: are characters of other resolutions and topologies accommodated without set-up? The text of one scene is run on
// every body and on a ladder of sizes, each meshed anew. Only character.body and character.vertices change. A body that
// fails is tried with further keys.
//
//   human at 1,200, 2,400 and 4,800 vertices; man, lady, frankie where installed; ring, a body with a handle;
//   as a control, an open surface and a body without bones; for comparison, the bodies under the author's later code
//
// Writes DIR/setup/BODY/measurements.csv, changed_keys.csv, trials.csv and run/ (the folder of a run), and setup.csv.
#include "analysis/records/record_files.hpp"
#include "analysis/records/tables.hpp"
#include "analysis/statistics/statistics.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/characters/body_cache.hpp"
#include "experiments/clips/clip.hpp"
#include "experiments/run/run.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/setup/body_setup.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;
using analysis::Measurement;

// The ring has bones for three of the clip's joints.
std::vector<std::string> shared_overrides(double rate_hz, const std::string& deformer)
{
    return {"motion.allow_partial=true",
            fmt::format("motion.rate_hz={:.1f}", rate_hz),
            fmt::format(R"(deformers.use=["{}"])", deformer),
            R"(reference.name="")",
            "output.frames=[]",
            "output.frame_names=[]"};
}

analysis::CaseKey key_of(const BodySetup& setup)
{
    return {.body = setup.body,
            .motion = "01_01",
            .deformer = is_unsuitable(setup.body) ? "pbs_unsuitable" : setup.deformer};
}

std::vector<Measurement> measured_in(const fs::path& run_folder, const BodySetup& setup,
                                     const std::vector<std::string>& changed)
{
    const analysis::CsvTable metrics = analysis::read_csv((run_folder / "metrics.csv").string());
    return analysis::from_record((run_folder / "run.json").string(), [&](const nlohmann::json& run) {
        analysis::CaseKey key = key_of(setup);
        key.vertices = run.at("character").at("vertices").get<double>();
        return setup_measurements(key, metrics, run, changed);
    });
}

}  // namespace

const analysis::Columns<TrialRow> trial_columns = MEMBER_COLUMNS(TrialRow, trial, further_keys, failure);

const analysis::Columns<std::string> key_columns = {{"key", std::identity{}}};

Scene shared_scene(double rate_hz, const std::string& deformer)
{
    return read_scene("human_01_01", shared_overrides(rate_hz, deformer));
}

Scene scene_of(const BodySetup& setup, double rate_hz)
{
    std::vector<std::string> overrides = shared_overrides(rate_hz, setup.deformer);
    overrides.push_back("character.body=" + setup.body);
    overrides.push_back("character.vertices=" + std::to_string(setup.vertices));
    overrides.insert(overrides.end(), setup.further.begin(), setup.further.end());
    return read_scene("human_01_01", overrides);
}

RECORD_SETTINGS(BodySetup, body, vertices, further, deformer)

RECORD_SETTINGS_AND(SetupCase,
                    .derived("scene",
                             [](const SetupCase& setup_case) {
                                 // the others are made by the run
                                 const bool has_scene = !is_unsuitable(setup_case.setup.body);
                                 return has_scene ? to_json(scene_of(setup_case.setup, setup_case.rate_hz))
                                                  : nlohmann::json();
                             })
                        .derived("compared_with",
                                 [](const SetupCase& setup_case) {
                                     return shared_scene(setup_case.rate_hz, setup_case.setup.deformer).resolved;
                                 })
                        .constant("further_keys", further_keys()),
                    setup, rate_hz)

std::vector<std::string> keys_changed(const nlohmann::json& shared, const nlohmann::json& own)
{
    std::vector<std::string> changed = differing_paths(shared, own);
    std::erase_if(changed, [](const auto& key) { return key == "character.body" || key == "character.vertices"; });
    return changed;
}

const std::vector<std::vector<std::string>>& further_keys()
{
    static const std::vector<std::vector<std::string>> keys = {{},
                                                               {R"(skinning.weights="rigid")"},
                                                               {R"(pbs.precision="f64")"},
                                                               {R"(pbs.precision="f64")", "pbs.k_volume=0.5"}};
    return keys;
}

bool is_unsuitable(const std::string& body)
{
    return body == "open_surface" || body == "without_bones";
}

BodySetup with_files(const BodySetup& setup, const std::string& folder)
{
    if (!is_unsuitable(setup.body)) return setup;
    const bool is_open = setup.body == "open_surface";
    const std::string mesh = analysis::path_in(folder, setup.body + ".vtk");
    analysis::write_text_atomically(
        mesh, std::string("# vtk DataFile Version 3.0\na pyramid\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                          "POINTS 5 double\n-1 -1 -1 1 -1 -1 1 -1 1 -1 -1 1 0 1 0\n") +
                  (is_open ? "CELLS 4 16\n3 0 1 4 3 1 2 4 3 2 3 4 3 3 0 4\nCELL_TYPES 4\n5 5 5 5\n"
                           : "CELLS 2 10\n4 0 1 2 4 4 0 2 3 4\nCELL_TYPES 2\n10 10\n"));
    BodySetup own{"", setup.vertices, {"character.mesh=" + mesh}, setup.deformer};
    if (is_open) {  // CMU's unit of length
        own.further.push_back("character.skeleton=" + pbs::find_clip("01_01.bvh", ""));
        own.further.push_back(fmt::format("character.skeleton_scale={}", 0.0254 / 0.45));
    }
    return own;
}

std::vector<TriedSetup> tried_setups(const BodySetup& setup, const Trial& trial)
{
    std::vector<TriedSetup> tried;
    for (const std::vector<std::string>& further : further_keys()) {
        BodySetup own = setup;
        own.further.insert(own.further.end(), further.begin(), further.end());
        try {
            tried.push_back({own, trial(own)});
        } catch (const pbs::InputError& error) {
            tried.push_back({own, error.what()});
        }
        if (tried.back().failure.empty()) break;
    }
    return tried;
}

std::vector<Measurement> setup_measurements(const analysis::CaseKey& key, const analysis::CsvTable& metrics,
                                            const nlohmann::json& run, const std::vector<std::string>& changed)
{
    const std::vector<double> change_pct = metrics.numbers("volume_change_pct"),
                              inverted = metrics.numbers("inverted_tets");
    std::vector<bool> good;
    double largest_pct = 0.0;
    for (std::size_t frame = 0; frame < change_pct.size(); ++frame) {
        good.push_back(std::isfinite(change_pct[frame]) && inverted[frame] == 0.0);
        if (!(std::abs(change_pct[frame]) <= std::abs(largest_pct))) largest_pct = change_pct[frame];
    }
    analysis::BootstrapOptions options;
    options.autocorrelation_time = analysis::integrated_autocorrelation_time(change_pct);
    const analysis::Interval share = analysis::bootstrap_share(good, options),
                             mean = analysis::bootstrap_mean(change_pct);
    const nlohmann::json& seconds = run.at("cost").at("cpu_seconds");
    const double set_up_s =
        seconds.at("character").get<double>() + seconds.at("motion").get<double>() + seconds.at("set_up").get<double>();
    const double keys = static_cast<double>(changed.size());
    return {{"C17", "keys_changed", key, keys, keys, keys, "1"},
            {"C17", "share_of_sound_frames", key, share.estimate, share.low, share.high, "1"},
            {"C17", "mean_volume_change_pct", key, mean.estimate, mean.low, mean.high, "%"},
            {"C17", "largest_volume_change_pct", key, largest_pct, largest_pct, largest_pct, "%"},
            {"C17", "set_up_s", key, set_up_s, set_up_s, set_up_s, "s"}};
}

std::vector<Measurement> not_set_up(const analysis::CaseKey& key)
{
    const double none = analysis::not_known;
    return {{"C17", "keys_changed", key, none, none, none, "1"},
            {"C17", "share_of_sound_frames", key, 0.0, 0.0, 0.0, "1"}};
}

namespace {

// Runs the body in `folder`/run and writes measurements.csv, changed_keys.csv and trials.csv. Every trial meshes anew,
// unless its tets come with the program. Returns the failure of the last trial, if any.
std::string set_up_and_record(const SetupCase& setup_case, const std::string& folder)
{
    const auto& [setup, rate_hz] = setup_case;
    const fs::path run_folder = fs::path(folder) / "run";
    pbs::make_meshes_anew();
    const auto run = [&](const BodySetup& own) {
        return run_scene(scene_of(own, setup_case.rate_hz), run_folder.string()).failure();
    };
    const BodySetup own = with_files(setup, folder);
    const std::vector<TriedSetup> tried = tried_setups(own, run);

    const BodySetup& last = tried.back().setup;
    const bool runs = tried.back().failure.empty();
    const auto path = [&](const char* name) { return (fs::path(folder) / name).string(); };
    const auto is_of_the_body = [&](const std::string& key) {
        return std::ranges::any_of(own.further,
                                   [&](const std::string& setting) { return setting.starts_with(key + "="); });
    };
    std::vector<std::string> changed;
    if (runs) changed = keys_changed(shared_scene(rate_hz, setup.deformer).resolved, scene_of(last, rate_hz).resolved);
    std::erase_if(changed, is_of_the_body);
    analysis::measurement_table(runs ? measured_in(run_folder, setup, changed) : not_set_up(key_of(setup)))
        .write(path("measurements.csv"));
    table_of(key_columns, changed).write(path("changed_keys.csv"));
    std::vector<TrialRow> trials;
    for (std::size_t i = 0; i < tried.size(); ++i) {
        std::string failure = tried[i].failure;
        // it may name a file
        if (const auto at = failure.find(folder); at != std::string::npos) failure.erase(at, folder.size() + 1);
        trials.push_back({int(i), fmt::format("{}", fmt::join(further_keys()[i], " ")), failure});
    }
    table_of(trial_columns, trials).write(path("trials.csv"));
    return is_unsuitable(setup.body) ? "" : tried.back().failure;
}

StudyPlan plan(bool full)
{
    return plan_of_cases("setup", full, [](const StudyCase& study_case, StudyPlan& plan) {
        const BodySetup setup{study_case.value<std::string>("body"),
                              study_case.value("vertices", 0),
                              {},
                              study_case.value<std::string>("deformer", "pbs")};
        plan.runs.push_back(work_run<SetupCase>(study_case.name, {setup, study_case.value<double>("rate_hz")},
                                                study_case.cost_s, set_up_and_record));
    });
}

bool conclude(const FinishedRuns& finished)
{
    std::vector<Measurement> rows;
    for (const std::string& file : finished.files("measurements.csv")) {
        std::vector<Measurement> own = analysis::measurements(file);
        std::ranges::sort(own, {}, &Measurement::quantity);
        rows.insert(rows.end(), own.begin(), own.end());
    }
    finished.write("setup.csv", analysis::measurement_table(rows));
    return true;
}

}  // namespace

Study setup_study()
{
    return {"setup", plan, quick_and_full, conclude};
}

}  // namespace experiments
