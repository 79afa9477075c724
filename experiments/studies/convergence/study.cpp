// C03, C12: how fast the solver converges, from which initial guess, and towards what. Every run iterates the paper's constraints far past
// its 24 iterations from four initial guesses (convergence/convergence_case.hpp) and measures residuals, volume and the error to the
// reference (shared/posed_reference.hpp).
//
//   limb_twist, limb_bend   90 and 170 deg, 60 and 90 deg; three orders, two precisions, other tessellations of the same size
//   human, ...              poses of the clip 01_01, every real body that is installed, at the sizes of Table 1
//   ladder_twist, _bend     the limb from 500 vertices to 8,000 in three orders (--full: to 100,000 in one), with the reference up to
//                           2,500 vertices. rates.csv states which meshes have no reference
//
// The reference of a pose takes minutes, so the quick form has it only at twist 90, bend 60, in the human's crouch and on the ladder. It
// has no solution on finer tets there, and therefore no bound.
//
// Writes DIR/convergence/RUN/residuals.csv, rates.csv, towards.csv, measurements.csv.
#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/studies/convergence/convergence_case.hpp"
#include "experiments/studies/shared/bodies.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/study.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace experiments {
namespace {

const std::vector<ProjectionSetting> every_setting = {
    {pbs::Order::ordered, pbs::Precision::f32}, {pbs::Order::grouped, pbs::Precision::f32}, {pbs::Order::plain, pbs::Precision::f32},
    {pbs::Order::ordered, pbs::Precision::f64}, {pbs::Order::grouped, pbs::Precision::f64}, {pbs::Order::plain, pbs::Precision::f64}};
const std::vector<ProjectionSetting> orders = {every_setting[0], every_setting[1], every_setting[2]};
const std::vector<ProjectionSetting> few_settings = {every_setting[0], every_setting[1], every_setting[2],
                                                     every_setting[3]};  // the orders, and the first one in double

std::string measure_and_record(const ConvergenceCase& of, const std::string& folder)
{
    const ConvergenceResult result = measure_convergence(of);
    const auto path = [&](const char* name) { return analysis::path_in(folder, name); };
    const std::vector<LookRow> looks = look_rows(result);
    table_of(residual_columns, looks).write(path("residuals.csv"));
    table_of(rate_columns, rate_rows(result)).write(path("rates.csv"));
    table_of(towards_columns, towards_rows(looks)).write(path("towards.csv"));
    analysis::measurement_table(convergence_values(result)).write(path("measurements.csv"));
    return result.breakdown;
}

// 5 degrees per frame.
NamedFrame twisted_by(int angle_deg, bool compared)
{
    return {angle_deg / 5, fmt::format("twist_{}", angle_deg), {.motion = "twist", .angle_deg = angle_deg}, true, compared};
}

NamedFrame bent_by(int angle_deg, bool compared)
{
    return {angle_deg / 5, fmt::format("bend_{}", angle_deg), {.motion = "bend", .angle_deg = angle_deg}, false, compared};
}

StudyRun limb_run(const std::string& scene, const std::vector<NamedFrame>& frames, bool full, double cost_s)
{
    ConvergenceCase of;
    of.scene = read_scene(scene, {});
    of.frames = frames;
    of.k_stretch = {0.2, 0.9};
    of.settings = full ? every_setting : few_settings;
    of.other_vertices = full ? std::vector<int>{1650, 1700, 1860, 1900} : std::vector<int>{1650, 1900};
    of.reference = reference_flesh(of.scene);
    of.refines_reference = full;
    return work_run(scene, of, cost_s, measure_and_record);
}

StudyRun ladder_run(const std::string& name, const std::string& scene, const std::vector<NamedFrame>& frames, bool full, double cost_s)
{
    ConvergenceCase of;
    of.scene = read_scene(scene, {"character.vertices=500"});
    of.frames = frames;
    of.k_stretch = {0.2};
    of.settings = orders;
    of.every_setting_to = 8000;
    of.other_vertices = {1000, 2000, 4000, 8000};
    if (full) of.other_vertices.insert(of.other_vertices.end(), {16000, 32000, 64000, 100000});
    of.ladder = true;
    of.reference = reference_flesh(of.scene);
    of.refines_reference = full;
    of.reference_to = 2500;  // on larger meshes a pose takes minutes
    return work_run(name, of, cost_s, measure_and_record);
}

// vertices 0: the body's own default, which is close to the sizes of Table 1.
StudyRun body_run(const std::string& body, int vertices, bool full, double cost_s)
{
    ConvergenceCase of;
    of.scene = read_scene("human_01_01", {"character.body=" + body, fmt::format("character.vertices={}", vertices)});
    const bool compares = vertices == 0 && (full || body == "human"), everywhere = compares && full && body == "human";
    of.frames = {{clip_frames::crouch, "01_01_crouch", {.motion = "01_01", .pose = "crouch"}, false, compares},
                 {clip_frames::landing, "01_01_landing", {.motion = "01_01", .pose = "landing"}, false, everywhere}};
    if (full)
        of.frames = {{100, "01_01_at_1_s", {.motion = "01_01", .time_s = 1.0}, false, everywhere},
                     {clip_frames::crouch, "01_01_crouch", {.motion = "01_01", .pose = "crouch"}, false, compares},
                     {400, "01_01_at_4_s", {.motion = "01_01", .time_s = 4.0}, false, everywhere},
                     {clip_frames::in_the_air, "01_01_in_the_air", {.motion = "01_01", .pose = "in_the_air"}, false, everywhere},
                     {clip_frames::landing, "01_01_landing", {.motion = "01_01", .pose = "landing"}, false, everywhere},
                     {1000, "01_01_at_10_s", {.motion = "01_01", .time_s = 10.0}, false, everywhere}};
    of.k_stretch = {0.2};
    of.settings = full ? few_settings : std::vector<ProjectionSetting>{every_setting[0], every_setting[2]};
    of.reference = reference_flesh(of.scene);
    of.refines_reference = full;
    return work_run(vertices > 0 ? fmt::format("{}_{}", body, vertices) : body, of, cost_s, measure_and_record);
}

// With --full, Man and the body in place of the bunny also have the sizes of ManHQ and bunnyHQ.
void add_body(StudyPlan& plan, const std::string& body, bool full)
{
    const double references_s = body == "human" ? (full ? 700.0 : 20.0) : full ? 200.0 : 0.0;
    plan.runs.push_back(body_run(body, 0, full, references_s + (full ? 13.5 : 5.0)));
    for (const TableOneRow& row : table_1())
        if (full && row.model == (body == "man" ? "ManHQ" : body == "frankie" ? "bunnyHQ" : ""))
            plan.runs.push_back(body_run(body, row.vertices, full, body == "man" ? 30.0 : 60.0));
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    plan.runs.push_back(limb_run("limb_twist", {twisted_by(90, true), twisted_by(170, full)}, full, full ? 200.0 : 15.0));
    plan.runs.push_back(limb_run("limb_bend", {bent_by(60, true), bent_by(90, full)}, full, full ? 230.0 : 20.0));
    plan.runs.push_back(ladder_run("ladder_twist", "limb_twist", {twisted_by(90, true)}, full, full ? 180.0 : 25.0));
    plan.runs.push_back(ladder_run("ladder_bend", "limb_bend", {bent_by(90, true)}, full, full ? 400.0 : 25.0));
    for_each_installed_body(plan.left_out, [&](const std::string& body) { add_body(plan, body, full); });
    return plan;
}

// One row per pose and initial guess, in the default order; of a ladder the LBS guess on each mesh.
StudyConclusion conclude(const FinishedRuns& finished)
{
    std::vector<RateRow> shown;
    for (const std::string& file : finished.files("rates.csv")) {
        const bool is_ladder = std::filesystem::path(file).parent_path().filename().string().starts_with("ladder");
        for (const RateRow& row : rows_of(rate_columns, analysis::read_csv(file))) {
            const bool is_shown = is_ladder ? row.of.start == name_of(SolverStart::lbs) : row.of.own_mesh;
            if (is_shown && row.of.order == "ordered" && row.of.precision == "f32") shown.push_back(row);
        }
    }
    return {text_table(table_of(rate_columns, shown),
                       analysis::report_columns("body pose vertices k_stretch start rate_per_iteration:.4f iterations_to_residual "
                                                "residual_reached iterations_to_volume volume_reached masked_share_pct:.1f "
                                                "reference_bound_pct:.2f error_24_pct:.1f least_error_iteration last_error_pct:.1f")),
            !finished.none()};
}

// C03, C12: the paths in one pose, on the scene's mesh and in its order. C12 is judged on characters alone. The first reading's k_stretch
// names the case of all of them.
std::vector<ReadingValues> read_paths(const StudyCase& of, const std::vector<Overrides>& readings)
{
    std::vector<ReadingValues> all;
    std::optional<double> k_stretch;
    for (const Overrides& reading : readings) {
        ConvergenceCase read;
        read.scene = of.scene(reading);
        read.frames = {{of.value<int>("frame"), of.name, of.key()}};
        read.most_iterations = of.value<int>("iterations");
        const auto& options = options_of<pbs::PbsOptions>(spec_of(read.scene, "pbs"));
        read.k_stretch = {options.k_stretch};
        read.settings = {{options.order, options.precision}};
        ConvergenceResult result = measure_convergence(read);
        if (!k_stretch) k_stretch = options.k_stretch;
        result.all.front().k_stretch = *k_stretch;
        all.push_back({convergence_values(result), !result.breakdown.empty()});
        if (!result.all.front().character) all.back().left_out = all_but("C12", {}, "judged on characters alone");
    }
    return all;
}

}  // namespace

Study convergence_study()
{
    return {"convergence", plan, quick_and_full, conclude, false, nullptr, read_paths};
}

}  // namespace experiments
