// Error against run time: which deformer is nearest to the reference for the time that a frame may take, and which single change improves
// PBS most in equal time.
//
//   limb twist  90 and 150 deg                      o=======o~~~~~~~o)   (settings are chosen on the first of each pair,
//   limb bend   60 deg (--full: and 90)             o=======o             and shown on the second)
//   human       crouch (--full: standing, crouch, in the air, landing and the poses at 1/5 to 4/5 of 01_01; crouch and in the air also on
//               tets cut into eight; and the crouch of every other installed body)
//
//   pbskin reproduce work_precision                          minutes
//   pbskin reproduce work_precision --full                   two and a half hours
//   pbskin reproduce work_precision --external mine.toml     with deformers of your own
//
// Writes DIR/work_precision/CASE/{points,members,changes}.csv and, over all cases, points.csv, settings.csv, fronts.csv, crossings.csv,
// best_within.csv, data_profiles.csv, omissions.csv; of the changes to PBS equal_time.csv, gains.csv and curves.csv.
#include "experiments/studies/study.hpp"

#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/bodies.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/work_precision/diagram_tables.hpp"
#include "experiments/studies/work_precision/gains.hpp"
#include "experiments/studies/work_precision/measured_points.hpp"

#include <fmt/format.h>

namespace experiments {
namespace {

std::string measure_and_record(const WorkPrecisionCase& of, const std::string& folder)
{
    const MeasuredPoints points = measure_points(of);
    table_of(columns_for(points.rows), points.rows).write(analysis::path_in(folder, "points.csv"));
    table_of(family_columns, points.members).write(analysis::path_in(folder, "members.csv"));
    if (of.range.changes) table_of(change_columns, points.changes).write(analysis::path_in(folder, "changes.csv"));
    return points.breakdown;
}

struct PlannedPose {
    std::string body = {}, motion = {}, pose = {};  // pose: in a clip
    int angle_deg = 0;                              // of a sweep
    int frame = 0;                                  // of 01_01 at 100 Hz
    bool refined = false;                           // also solved on the tets cut into eight
    bool changes = false;                           // the changes to PBS are measured too
    double cost_s = 0.0, quick_cost_s = 0.0;        // in full and in the quick form; 0: not in the quick form
};

// 1. The poses. The limb is one body, twisted or bent. The human has four poses by name, and four that are not chosen: at 1/5, 2/5, 3/5 and
// 4/5 of the clip. The order decides which poses train (point_row.hpp).
std::vector<PlannedPose> limb_poses()
{
    return {{.body = "limb", .motion = "twist", .angle_deg = 90, .changes = true, .cost_s = 110.0, .quick_cost_s = 20.0},
            {.body = "limb", .motion = "twist", .angle_deg = 150, .changes = true, .cost_s = 150.0, .quick_cost_s = 60.0},
            {.body = "limb", .motion = "bend", .angle_deg = 60, .changes = true, .cost_s = 130.0, .quick_cost_s = 20.0},
            {.body = "limb", .motion = "bend", .angle_deg = 90, .changes = true, .cost_s = 950.0}};
}

std::vector<PlannedPose> human_poses()
{
    std::vector<PlannedPose> poses = {
        {.pose = "standing", .frame = clip_frames::standing, .changes = true},
        {.pose = "crouch", .frame = clip_frames::crouch, .refined = true, .changes = true, .quick_cost_s = 45.0},
        {.pose = "in_the_air", .frame = clip_frames::in_the_air, .refined = true, .changes = true},
        {.pose = "landing", .frame = clip_frames::landing, .changes = true}};
    const Scene scene = read_scene("human_01_01", {});
    const pbs::Motion motion = make_motion(scene.motion, pbs::make_character(scene.character).skeleton, scene.file);
    const int last = static_cast<int>(motion.steps.size()) / motion.steps_per_frame - 1;
    for (const int fifths : {1, 2, 3, 4}) poses.push_back({.pose = fmt::format("{}_5_of_the_clip", fifths), .frame = last * fifths / 5});
    for (PlannedPose& pose : poses) pose.body = "human", pose.motion = "01_01", pose.cost_s = 200.0;
    return poses;
}

std::vector<PlannedPose> poses_of(const std::string& body)
{
    if (body == "human") return human_poses();
    return {{.body = body, .motion = "01_01", .pose = "crouch", .frame = clip_frames::crouch, .cost_s = 300.0}};
}

// 2. The extent. In full: all rungs and settings, meshes of other sizes, a bound on the error of each reference, and on the evaluated poses
// the other references of the family. In the fine creases of a bend Newton's method takes minutes per frame on a finer mesh, so that it has
// no finite elements there. The changes to PBS are compared in the quick form in two poses of the limb.
void set_extent(WorkPrecisionCase& of, const PlannedPose& pose, bool full)
{
    const bool is_limb = pose.angle_deg > 0;
    of.range.in_short = !full;
    of.range.quadratic = full;
    of.range.refined = full && pose.refined;
    of.range.changes = pose.changes && (full || (is_limb && of.half == Half::training));
    of.range.quadratic_up_to = is_limb ? 600 : 1000;
    of.range.other_vertices = {600};
    if (full) of.range.other_vertices = is_limb ? std::vector{300, 600} : std::vector{600, 1000, 4650};
    if (full && is_limb) (pose.motion == "twist" ? of.range.other_vertices : of.range.without_fem).push_back(5000);
    of.rounds = {.seconds = full ? 10.0 : 1.0, .fewest = full ? 5 : 3, .most = 31};
    of.newton_rounds = {.seconds = full ? 5.0 : 0.0, .fewest = 1, .most = 9};
    of.converged_iterations = full ? 8000 : 2000;
    of.reference_is_refined = full || (is_limb && of.half == Half::evaluation);
    if (!full || of.half == Half::training) return;
    of.members = family();
    of.members.erase(of.members.begin());
}

StudyRun run_of(const PlannedPose& pose, Half half, bool full, const std::vector<DeformerSpec>& external)
{
    WorkPrecisionCase of;
    of.external = external;
    of.half = half;
    of.of = {.body = pose.body, .motion = pose.motion, .pose = pose.pose};
    of.frame = pose.frame;
    if (pose.angle_deg > 0) {  // 5 degrees per frame, which is the step that is timed
        of.of.angle_deg = pose.angle_deg;
        of.frame = pose.angle_deg / 5;
        of.scene = read_scene("limb_" + pose.motion,
                              {fmt::format("motion.angle_deg={}", pose.angle_deg), fmt::format("motion.frames={}", of.frame + 1)});
    } else {
        of.scene = read_scene("human_01_01", {"character.body=" + pose.body});
    }
    set_extent(of, pose, full);
    return work_run(case_name(of.of), of, full ? pose.cost_s : pose.quick_cost_s, measure_and_record);
}

StudyPlan plan_of(bool full, const std::vector<DeformerSpec>& external)
{
    std::vector<PlannedPose> poses = limb_poses();
    std::vector<analysis::LeftOut> left_out;
    for_each_installed_body(left_out, [&](const std::string& body) {
        for (const PlannedPose& pose : poses_of(body)) poses.push_back(pose);
    });
    std::vector<std::string> bodies;
    for (const PlannedPose& pose : poses) bodies.push_back(pose.body);
    const std::vector<Half> halves = halves_of(bodies);
    StudyPlan plan;
    for (std::size_t i = 0; i < poses.size(); ++i)
        if (full || poses[i].quick_cost_s > 0.0) plan.runs.push_back(run_of(poses[i], halves[i], full, external));
    for (const analysis::LeftOut& body : left_out)
        if (full || body.scene == "human") plan.left_out.push_back(body);
    return plan;
}

StudyPlan plan(bool full)
{
    return plan_of(full, {});
}

StudyPlan plan_with(bool full, const std::string& external_file)
{
    return plan_of(full, external_entries(external_file));
}

// 3. The tables over all cases, and for the terminal who is nearest within each time, and what the changes to PBS gain.
std::string nearest_text(const std::vector<Diagram>& diagrams)
{
    std::string text;
    for (const Comparison comparison : comparisons) {
        std::vector<Diagram> shown;  // the last mean or evaluated pose
        for (const Diagram& diagram : diagrams)
            if (diagram.comparison == comparison && diagram.half == Half::evaluation) shown = {diagram};
        std::vector<BudgetRow> nearest = best_within(shown);
        std::erase_if(nearest, [](const BudgetRow& row) { return row.rank > 1; });
        text += text_table(
                    table_of(budget_columns, nearest),
                    analysis::report_columns("comparison case budget_ms group deformer iterations tuned ms_median:.2g error_joint_pct:.1f "
                                             "decision undecided_against")) +
                "\n";
    }
    return text;
}

std::string gains_text(std::vector<GainRow> gains)
{
    std::erase_if(gains, [](const GainRow& gain) { return gain.group != all_poses; });
    if (gains.empty()) return "";
    return text_table(
        table_of(gain_columns, gains),
        analysis::report_columns("budget_iterations change than poses error_pct:.2f than_error_pct:.2f gain_pct:.2f gain_low_pct:.2f "
                                 "gain_high_pct:.2f reference_error_pct:.2f decision settings"));
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    if (finished.none()) return {"", false};
    std::vector<CaseRecords> cases;
    std::vector<CaseRows> rows;
    std::vector<PointRow> points;
    for (const std::string& folder : finished.folders) {
        const auto read = [&](const char* file) { return analysis::read_csv(analysis::path_in(folder, file)); };
        rows.push_back(rows_of(point_columns, read("points.csv")));
        cases.push_back({rows.back(), rows_of(family_columns, read("members.csv"))});
        points.insert(points.end(), rows.back().begin(), rows.back().end());
    }
    const std::vector<ChosenSetting> chosen = choose_settings(rows);
    const std::vector<Diagram> diagrams = diagrams_of(cases, chosen);
    std::vector<Omission> omissions = omissions_of(rows);
    for (const Omission& omission : omissions_of_means(rows, diagrams)) omissions.push_back(omission);
    finished.write("points.csv", columns_for(points), points);
    finished.write("settings.csv", chosen_columns, chosen);
    finished.write("fronts.csv", fronts_table(diagrams));
    finished.write("crossings.csv", crossings_table(diagrams));
    finished.write("best_within.csv", budget_columns, best_within(diagrams));
    finished.write("data_profiles.csv", data_profile_columns, data_profiles(diagrams));
    finished.write("omissions.csv", omission_columns, omissions);

    const std::vector<PointRow> changes = finished.rows(change_columns, "changes.csv");
    const std::vector<EqualTimeRow> at_budgets = at_equal_time(changes);
    const std::vector<GainRow> gains = gains_of(at_budgets);
    finished.write("equal_time.csv", equal_time_columns, at_budgets);
    finished.write("gains.csv", gain_columns, gains);
    finished.write("curves.csv", curve_columns, mean_curves(changes, at_budgets));
    return {nearest_text(diagrams) + gains_text(gains), true};
}

}  // namespace

Study work_precision_study()
{
    return {"work_precision", plan, in_short, conclude, true, plan_with};
}

}  // namespace experiments
