// C03, C12: how fast the solver converges, from where, and towards what. Every run iterates the paper's constraints far past its 24 from
// four starts (convergence/starts.hpp) and looks at residuals, volume and the error against the reference on the same tets.
//
//   limb_twist, limb_bend   90 and 170 deg, 90 deg; three orders, two precisions, other tessellations of the same size
//   human, ...              poses of the clip 01_01, every real body that is installed, at Table 1's sizes
//   ladder_twist, _bend     the limb from 500 vertices to 8,000 in three orders (--full: to 100,000 in one); the reference on the same tets
//                           to 5,000 vertices (--full: 10,000; the bend 2,500), left out above: rates.csv says so of each mesh
//
// Writes DIR/convergence/RUN/residuals.csv, rates.csv, towards.csv, measurements.csv, and convergence.md of all runs.
#include "analysis/records/atomic_file.hpp"
#include "analysis/measurement.hpp"
#include "experiments/studies/shared/table_1.hpp"
#include "experiments/studies/shared/real_bodies.hpp"
#include "experiments/studies/convergence/convergence_figures.hpp"
#include "experiments/studies/convergence/convergence_records.hpp"
#include "experiments/deformers/pbs/pbs_option_names.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

namespace experiments {
namespace {

namespace fs = std::filesystem;

const std::vector<ProjectionSetting> every_setting = {
    {pbs::Order::ordered, pbs::Precision::f32}, {pbs::Order::grouped, pbs::Precision::f32}, {pbs::Order::plain, pbs::Precision::f32},
    {pbs::Order::ordered, pbs::Precision::f64}, {pbs::Order::grouped, pbs::Precision::f64}, {pbs::Order::plain, pbs::Precision::f64}};
const std::vector<ProjectionSetting> orders = {every_setting[0], every_setting[1], every_setting[2]};
const std::vector<ProjectionSetting> few_settings = {every_setting[0], every_setting[1], every_setting[2],
                                                     every_setting[3]};  // the orders, and the first one in double

std::string measure_and_record(const ConvergenceCase& of, const std::string& folder)
{
    const ConvergenceResult result = measure_convergence(of);
    const auto path = [&](const char* name) { return (fs::path(folder) / name).string(); };
    residual_table(result).write(path("residuals.csv"));
    table_of(rate_columns, rate_rows(result)).write(path("rates.csv"));
    towards_table(result).write(path("towards.csv"));
    analysis::measurement_table(convergence_figures(result)).write(path("measurements.csv"));
    return result.breakdown;
}

const std::vector<NamedFrame> twists = {{18, "twist 90", {.motion = "twist", .angle_deg = 90.0}, true},
                                        {34, "twist 170", {.motion = "twist", .angle_deg = 170.0}, true}},
                              bends = {{18, "bend 90", {.motion = "bend", .angle_deg = 90.0}}};  // 5 degrees a frame

StudyRun limb_run(const std::string& scene, const std::vector<NamedFrame>& frames, bool full, double cost_s)
{
    ConvergenceCase of;
    of.scene = read_scene(scene, {});
    of.frames = frames;
    of.k_stretch = {0.2, 0.9};
    of.settings = full ? every_setting : few_settings;
    of.other_vertices = full ? std::vector<int>{1650, 1700, 1860, 1900} : std::vector<int>{1650, 1900};
    of.truth = "snh_p1";
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
    of.truth = "snh_p1";
    of.truth_to = scene == "limb_bend" ? 2500 : full ? 10000 : 5000;  // beyond, the folded crease takes Newton minutes
    return work_run(name, of, cost_s, measure_and_record);
}

// vertices 0: the body's own default, in the neighbourhood of Table 1's.
StudyRun body_run(const std::string& body, int vertices, bool full, double cost_s)
{
    ConvergenceCase of;
    of.scene = read_scene("human_01_01", {"character.body=" + body, fmt::format("character.vertices={}", vertices),
                                          R"(deformers.use=["pbs","snh_p1"])", R"(reference.name="snh_p1")"});
    of.frames = {{164, "01_01 crouch", {.motion = "01_01", .pose = "crouch"}},
                 {708, "01_01 landing", {.motion = "01_01", .pose = "landing"}}};
    if (full)
        of.frames = {{100, "01_01 at 1 s", {.motion = "01_01", .time_s = 1.0}},
                     {164, "01_01 crouch", {.motion = "01_01", .pose = "crouch"}},
                     {400, "01_01 at 4 s", {.motion = "01_01", .time_s = 4.0}},
                     {672, "01_01 in the air", {.motion = "01_01", .pose = "in_the_air"}},
                     {708, "01_01 landing", {.motion = "01_01", .pose = "landing"}},
                     {1000, "01_01 at 10 s", {.motion = "01_01", .time_s = 10.0}}};
    of.k_stretch = {0.2};
    of.settings = full ? few_settings : std::vector<ProjectionSetting>{every_setting[0], every_setting[2]};
    of.truth = "snh_p1";
    return work_run(vertices > 0 ? fmt::format("{}_{}", body, vertices) : body, of, cost_s, measure_and_record);
}

// --full: Man and the bunny's stand-in at the sizes of ManHQ and bunnyHQ, too.
void add_body(StudyPlan& plan, const std::string& body, bool full)
{
    plan.runs.push_back(body_run(body, 0, full, full ? 13.5 : 5.0));
    for (const TableOneRow& row : table_1())
        if (full && row.model == (body == "man" ? "ManHQ" : body == "frankie" ? "bunnyHQ" : ""))
            plan.runs.push_back(body_run(body, row.vertices, full, body == "man" ? 30.0 : 60.0));
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    plan.runs.push_back(limb_run("limb_twist", twists, full, full ? 18.0 : 10.0));
    plan.runs.push_back(limb_run("limb_bend", bends, full, full ? 10.0 : 6.0));
    plan.runs.push_back(ladder_run("ladder_twist", "limb_twist", {twists.front()}, full, full ? 65.0 : 15.0));
    plan.runs.push_back(ladder_run("ladder_bend", "limb_bend", bends, full, full ? 60.0 : 16.0));
    for (const std::string& body : installed_bodies(plan.left_out)) try {
            add_body(plan, body, full);
        } catch (const pbs::InputError& error) {  // the clip is not there
            plan.left_out.push_back({body, error.what()});
        }
    return plan;
}

// From each start, in the default order: residual, iterations and error, a line a pose; -: no rate could be fitted, no reference.
StudyConclusion conclude(const FinishedRuns& finished)
{
    std::string text = fmt::format("{:8} {:16} {:>8} {:>9} {:15} {:>9} {:>12} {:>12} {:>9} {:>9} {:>9}\n", "body", "pose", "vertices",
                                   "k_stretch", "start", "rate", "to residual", "to volume", "error 24", "least at", "error end");
    const auto count = [](const Reached& reached) { return fmt::format("{}{}", reached.within ? "" : "> ", reached.iterations); };
    const auto known = [](double value, const char* form) { return std::isfinite(value) ? fmt::format(fmt::runtime(form), value) : "-"; };
    for (const std::string& run : finished.folders) {
        const bool is_ladder = fs::path(run).filename().string().starts_with("ladder");
        for (const RateRow& row : rows_of(rate_columns, analysis::read_csv((fs::path(run) / "rates.csv").string()))) {
            const PathCase& of = row.of;
            if (of.order != "ordered" || of.precision != "f32") continue;
            if (is_ladder ? of.start != name_of(SolverStart::lbs) : !of.own_mesh) continue;
            text += fmt::format("{:8} {:16} {:8} {:9} {:15} {:>9} {:>12} {:>12} {:>9} {:>9} {:>9}\n", of.body, of.pose, of.vertices,
                                of.k_stretch, of.start, known(row.rate.rate.estimate, "{:.4f}"), count(row.residual), count(row.volume),
                                known(row.paper.error_joint_pct, "{:.1f}"),
                                std::isfinite(row.paper.error_joint_pct) ? std::to_string(row.nearest.iteration) : "-",
                                known(row.last.error_joint_pct, "{:.1f}"));
        }
    }
    finished.write("convergence.md", "```\n" + text + "```\n");
    return {text, !finished.none()};
}

}  // namespace

Study convergence_study()
{
    return {"convergence", plan, quick_and_full, conclude};
}

}  // namespace experiments
