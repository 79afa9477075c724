// C10: milliseconds per frame on one core for LBS, bind, stretch, volume and the whole frame, on meshes made to Table 1's numbers of
// vertices, with steps of 10 ms, 24 iterations and CMU's clip 01_01; and the size at which real time ends. The plain order in f64 is
// judged, by wall time with LBS. The other variants, processor time and the embedded surface are timed for comparison.
//
//   man, frankie, lady   at 1654, 2645, 2108, 3190, 1829 vertices, in place of the paper's Man, ManHQ, bunny, bunnyHQ, Lady
//   human                at the same sizes (in the quick form at two of them), and a ladder of sizes, the largest by cutting every tet
//                        into eight
//
// One run is timed at once. Writes DIR/timing/BODY_VERTICES/timing.csv and measurements.csv; DIR/timing/timing.csv and timing.md.
#include "analysis/records/provenance.hpp"
#include "analysis/records/record_files.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/shared/bodies.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/studies/timing/timing_records.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

constexpr double round_s_per_vertex = 24e-6;
constexpr int fewest_rounds = 3, most_rounds = 61;
constexpr double set_up_s = 1.0;  // half of the time for meshing: tets are kept from one run of the program to the next

// So many rounds that they take about `seconds` of one core, whatever else the machine does. A round is two frames of three variants, each
// timed twice.
Rounds rounds_for(int vertices, double seconds)
{
    const int rounds = std::clamp(static_cast<int>(seconds / (round_s_per_vertex * vertices)), fewest_rounds, most_rounds);
    return {.seconds = 0.0, .fewest = rounds, .most = rounds};
}

Scene scene_of(const std::string& body, int vertices, int refinements)
{
    Scene scene = read_scene("human_01_01", {fmt::format(R"(character.body="{}")", body), fmt::format("character.vertices={}", vertices),
                                             "motion.duration_s=4.0"});
    scene.character.refinements = refinements;
    return scene;
}

std::string time_and_record(const TimedCase& of, const std::string& folder)
{
    const pbs::Character character = pbs::make_character(of.scene.character);
    const pbs::Motion motion = make_motion(of.scene.motion, character.skeleton, of.scene.file);
    TimedMesh mesh{.name = of.name(), .body = of.scene.character.body, .model = of.model, .stands_in = of.stands_in};
    mesh.vertices = static_cast<int>(character.mesh.rest.rows());
    mesh.edges = static_cast<int>(pbs::edges_of(character.mesh.tets).rows());
    mesh.tets = static_cast<int>(character.mesh.tets.rows());
    mesh.cpu_model = analysis::collect_provenance(1).cpu_model;
    mesh.surface_vertices = character.surface ? static_cast<int>(character.surface->tet.size()) : 0;
    const auto rows = timing_rows(mesh, time_frames(character, motion, {.k_jiggle = of.k_jiggle}, rounds_for(mesh.vertices, of.seconds)));
    table_of(timing_columns, rows).write(analysis::path_in(folder, "timing.csv"));
    const auto measured = timing_measurements(rows);
    if (!measured.empty()) analysis::measurement_table(measured).write(analysis::path_in(folder, "measurements.csv"));
    return "";
}

std::string body_of(const std::string& model)
{
    return model.starts_with("Man") ? "man" : model.starts_with("bunny") ? "frankie" : "lady";
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    const std::vector<std::string> installed = installed_bodies(plan.left_out);
    const double seconds = full ? 4.0 : 1.5;
    const auto add = [&](TimedCase of, const std::string& body, int vertices, int refinements, double before_s) {
        if (std::find(installed.begin(), installed.end(), body) == installed.end()) return;
        of.seconds = seconds;
        try {
            of.scene = scene_of(body, vertices, refinements);
            plan.runs.push_back(work_run(of.name(), of, seconds + before_s, time_and_record));
        } catch (const pbs::InputError& error) {
            plan.left_out.push_back({fmt::format("{}_{}", body, vertices), error.what()});
        }
    };
    for (const TableOneRow& row : table_1()) {
        TimedCase of{.scene = {}, .model = row.model, .k_jiggle = row.jiggling};
        add(of, body_of(row.model), row.vertices, 0, set_up_s);
        of.stands_in = true;
        if (full || row.model == "Man" || row.model == "bunnyHQ") add(of, "human", row.vertices, 0, set_up_s);
    }
    for (const int vertices : full ? std::vector<int>{1200, 2400, 4800, 9600, 20000} : std::vector<int>{1200, 4800, 20000})
        add({}, "human", vertices, 0, set_up_s + vertices / 4000.0);
    if (full) add({}, "human", 2400, 2, 16.0);
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    if (finished.none()) return {"timing: nothing was timed\n", false};
    const std::vector<TimingRow> rows = finished.rows(timing_columns, "timing.csv");
    finished.write("timing.csv", timing_columns, rows);
    finished.write("timing.md", timing_markdown(rows));
    return {timing_text(rows), true};
}

}  // namespace

std::string TimedCase::name() const
{
    const pbs::CharacterSource& character = scene.character;
    const std::string name = fmt::format("{}_{}", character.body, character.vertices);
    return character.refinements ? fmt::format("{}_refined_{}", name, character.refinements) : name;
}

nlohmann::json to_json(const TimedCase& of)
{
    static const auto fields = OptionFields<TimedCase>("timing")
                                   .record("scene", &TimedCase::scene)
                                   .derived("refinements", [](const TimedCase& of) { return of.scene.character.refinements; })
                                   .record("model", &TimedCase::model)
                                   .record("stands_in", &TimedCase::stands_in)
                                   .record("k_jiggle", &TimedCase::k_jiggle)
                                   .record("seconds", &TimedCase::seconds)
                                   .constant("iterations", timed_iterations)
                                   .constant("frames_a_turn", TimedFrames{}.frames_per_turn)
                                   .constant("round_s_a_vertex", round_s_per_vertex)
                                   .constant("rounds", {fewest_rounds, most_rounds})
                                   .constant("cpu_model", analysis::collect_provenance(1).cpu_model)
                                   .complete();
    return fields.json(of);
}

Study timing_study()
{
    return {"timing", plan, quick_and_full, conclude, true};
}

}  // namespace experiments
