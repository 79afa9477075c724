// C10: milliseconds of a frame on one core, LBS, bind, stretch, volume and the whole, on meshes made to Table 1's numbers of vertices, 10
// ms steps, 24 iterations, CMU's clip 01_01; the size at which real time ends. Orders by turns, medians and quartiles. Judged is the plain
// order in f64 by wall time, LBS included; the other variants, processor time and the surface that is drawn stand beside it.
//
//   man, frankie, lady   at 1654, 2645, 2108, 3190, 1829 vertices, in place of the paper's Man, ManHQ, bunny, bunnyHQ, Lady
//   human                at some of the same sizes, and a ladder of sizes, the largest by cutting every tet into eight
//
// One run at once. Writes DIR/timing/BODY_VERTICES/timing.csv and measurements.csv; DIR/timing/timing.csv and timing.md.
#include "analysis/records/atomic_file.hpp"
#include "analysis/measurement.hpp"
#include "analysis/records/provenance.hpp"
#include "experiments/scene/motion_case.hpp"
#include "experiments/studies/shared/real_bodies.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/studies/timing/timing_report.hpp"
#include "experiments/studies/timing/timing_table.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

constexpr double round_s_a_vertex = 24e-6;
constexpr int fewest_rounds = 3, most_rounds = 61;
constexpr double set_up_s = 1.0;  // half of what meshing takes: tets are kept from one run of the program to the next

struct TimedCase {
    std::string body, model = {};
    int vertices = 0, refinements = 0;
    double k_jiggle = 0.9, seconds = 2.0;
    bool stands_in = false;

    std::string name() const
    {
        return refinements ? fmt::format("{}_{}_refined_{}", body, vertices, refinements) : fmt::format("{}_{}", body, vertices);
    }
};

Scene scene_of(const TimedCase& timed)
{
    Scene scene = read_scene("human_01_01", {fmt::format(R"(character.body="{}")", timed.body),
                                             fmt::format("character.vertices={}", timed.vertices), "motion.duration_s=4.0"});
    scene.character.refinements = timed.refinements;
    return scene;
}

// So many that they take some `seconds` of one core, whatever else the machine does: a round is two frames of three variants, timed twice.
Rounds rounds_of(int vertices, double seconds)
{
    const int rounds = std::clamp(static_cast<int>(seconds / (round_s_a_vertex * vertices)), fewest_rounds, most_rounds);
    return {.seconds = 0.0, .fewest = rounds, .most = rounds};
}

std::string time_and_record(const TimedCase& timed, const std::string& folder)
{
    const Scene scene = scene_of(timed);
    const pbs::Character character = pbs::make_character(scene.character);
    const pbs::Motion motion = make_motion(scene.motion, character.skeleton, scene.file);
    TimedMesh mesh{.name = timed.name(), .body = timed.body, .model = timed.model, .stands_in = timed.stands_in};
    mesh.vertices = static_cast<int>(character.mesh.rest.rows());
    mesh.edges = static_cast<int>(pbs::edges_of(character.mesh.tets).rows());
    mesh.tets = static_cast<int>(character.mesh.tets.rows());
    mesh.cpu_model = analysis::collect_provenance(1).cpu_model;
    mesh.surface_vertices = character.surface ? static_cast<int>(character.surface->tet.size()) : 0;
    mesh.timings = time_frames(character, motion, {.k_jiggle = timed.k_jiggle}, rounds_of(mesh.vertices, timed.seconds));
    timing_table(mesh).write((fs::path(folder) / "timing.csv").string());
    const auto measured = timing_measurements(mesh);
    if (!measured.empty()) analysis::measurement_table(measured).write((fs::path(folder) / "measurements.csv").string());
    return "";
}

StudyRun timed_run(const TimedCase& timed, double before_s)
{
    return {.name = timed.name(),
            .cost_s = timed.seconds + before_s,
            .work = [timed](const std::string& folder) { return time_and_record(timed, folder); },
            .settings = {{"scene", scene_of(timed).resolved},
                         {"model", timed.model},
                         {"refinements", timed.refinements},
                         {"k_jiggle", timed.k_jiggle},
                         {"stands_in", timed.stands_in},
                         {"iterations", timed_iterations},
                         {"cpu_model", analysis::collect_provenance(1).cpu_model},
                         {"frames_a_turn", TimedFrames{}.frames_a_turn},
                         {"seconds", timed.seconds},
                         {"round_s_a_vertex", round_s_a_vertex},
                         {"rounds", {fewest_rounds, most_rounds}}}};
}

void add_run(StudyPlan& plan, const TimedCase& timed, double before_s)
{
    try {
        plan.runs.push_back(timed_run(timed, before_s));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({timed.name(), error.what()});
    }
}

std::string body_of(const std::string& model)
{
    return model.starts_with("Man") ? "man" : model.starts_with("bunny") ? "frankie" : "lady";
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    const std::vector<std::string> installed = installed_bodies(plan.left_out);
    const auto is_installed = [&](const std::string& body) { return std::count(installed.begin(), installed.end(), body) > 0; };
    const double seconds = full ? 4.0 : 1.5;
    for (const TableOneRow& row : table_1()) {
        TimedCase timed{
            .body = body_of(row.model), .model = row.model, .vertices = row.vertices, .k_jiggle = row.jiggling, .seconds = seconds};
        if (is_installed(timed.body)) add_run(plan, timed, set_up_s);
        const bool stands_in = full || row.model == "Man" || row.model == "bunnyHQ";
        timed.body = "human";
        timed.stands_in = true;
        if (is_installed(timed.body) && stands_in) add_run(plan, timed, set_up_s);
    }
    if (!is_installed("human")) return plan;
    for (const int vertices : full ? std::vector<int>{1200, 2400, 4800, 9600, 20000} : std::vector<int>{1200, 4800, 20000})
        add_run(plan, {.body = "human", .vertices = vertices, .seconds = seconds}, set_up_s + vertices / 4000.0);
    if (full) add_run(plan, {.body = "human", .vertices = 2400, .refinements = 2, .seconds = seconds}, 16.0);
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    if (finished.none()) return {"timing: nothing was timed\n", false};
    const analysis::CsvTable table = finished.gathered("timing.csv");
    finished.write("timing.csv", table);
    finished.write("timing.md", timing_markdown(table));
    return {timing_text(table), true};
}

}  // namespace

Study timing_study()
{
    return {"timing", plan, quick_and_full, conclude, true};
}

}  // namespace experiments
