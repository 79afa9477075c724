// Error against run time: which deformer is nearest to the reference for the time that a frame may take.
//
//   limb twist  90 deg (--full: and 150)     o=======o~~~~~~~o)
//   limb bend   60 deg (--full: and 90)      o=======o
//   human       crouch (--full: crouch and in the air, both also on tets cut into eight; standing, landing and the poses at 1/5 to 4/5 of
//               01_01; and the crouch of every other installed body)
//
// Writes DIR/work_precision/CASE/points.csv and, over all cases, points.csv, fronts.csv, crossings.csv, equal_cost.csv, work_precision.md.
#include "analysis/records/folder_files.hpp"
#include "experiments/scene/motion_case.hpp"
#include "experiments/studies/shared/real_bodies.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/studies/work_precision/diagram_tables.hpp"
#include "experiments/studies/work_precision/findings.hpp"
#include "experiments/studies/work_precision/measured_points.hpp"

#include <fmt/format.h>

namespace experiments {
namespace {

std::string measure_and_record(const WorkPrecisionCase& of, const std::string& folder)
{
    const MeasuredPoints points = measure_points(of);
    table_of(point_columns, points.rows).write(analysis::path_in(folder, "points.csv"));
    return points.breakdown;
}

// 5 degrees per frame, which is the step that is timed.
StudyRun limb_run(const std::string& motion, int angle_deg, bool full, double cost_s)
{
    const std::string scene = "limb_" + motion;
    WorkPrecisionCase of;
    of.of = {.body = "limb", .motion = motion, .angle_deg = angle_deg};
    of.scene = read_scene(scene, {fmt::format("motion.angle_deg={}", angle_deg), fmt::format("motion.frames={}", angle_deg / 5 + 1)});
    of.frame = angle_deg / 5;
    of.range.quadratic_corotational = full;
    of.range.coarser_vertices = {300, 400, 500, 600};
    if (full && motion == "twist")
        of.range.finer_vertices = {5000};  // in the fine creases of a bend Newton's method takes minutes per frame
    of.rounds = {.seconds = full ? 10.0 : 3.0, .fewest = 5, .most = 31};
    of.newton_rounds = {.seconds = full ? 10.0 : 0.0, .fewest = full ? 3 : 1, .most = 9};
    return work_run(case_name(of.of), of, cost_s, measure_and_record);
}

struct BodyPose {
    std::string name;
    int frame = 0;         // of 01_01 at 100 Hz
    bool refined = false;  // also solved on the tets cut into eight
};
// Four poses by name, and four that are not chosen: at 1/5, 2/5, 3/5 and 4/5 of the clip.
std::vector<BodyPose> human_poses(bool full)
{
    if (!full) return {{"crouch", 164}};
    std::vector<BodyPose> poses = {{"standing", 0}, {"crouch", 164, true}, {"in_the_air", 672, true}, {"landing", 708}};
    const Scene scene = read_scene("human_01_01", {});
    const pbs::Motion motion = make_motion(scene.motion, pbs::make_character(scene.character).skeleton, scene.file);
    const int last = static_cast<int>(motion.steps.size()) / motion.steps_per_frame - 1;
    for (const int fifths : {1, 2, 3, 4}) poses.push_back({fmt::format("{}_5_of_the_clip", fifths), last * fifths / 5});
    return poses;
}

StudyRun body_run(const std::string& body, const BodyPose& pose, bool full, double cost_s)
{
    WorkPrecisionCase of;
    of.of = {.body = body, .motion = "01_01", .pose = pose.name};
    of.scene = read_scene("human_01_01", {"character.body=" + body});
    of.frame = pose.frame;
    of.range.quadratic_corotational = false;
    of.range.quadratic_up_to = 1200;
    of.range.refined = pose.refined;
    of.range.coarser_vertices = full ? std::vector<int>{500, 600, 700, 800, 900, 1000, 1200} : std::vector<int>{800, 1200};
    if (full) of.range.finer_vertices = {4650};
    of.rounds = {.seconds = full ? 10.0 : 3.0, .fewest = 5, .most = 31};
    of.newton_rounds = {.seconds = full ? 10.0 : 0.0, .fewest = 1, .most = 9};
    return work_run(case_name(of.of), of, cost_s, measure_and_record);
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    plan.runs.push_back(limb_run("twist", 90, full, full ? 70.0 : 28.0));
    plan.runs.push_back(limb_run("bend", 60, full, full ? 65.0 : 31.0));
    if (full) {
        plan.runs.push_back(limb_run("twist", 150, full, 80.0));
        plan.runs.push_back(limb_run("bend", 90, full, 440.0));
    }
    std::vector<analysis::LeftOut> left_out;
    for_each_installed_body(left_out, [&](const std::string& body) {
        if (body == "human")
            for (const BodyPose& pose : human_poses(full)) plan.runs.push_back(body_run(body, pose, full, full ? 145.0 : 50.0));
        else if (full)
            plan.runs.push_back(body_run(body, {"crouch", 164}, full, 350.0));
    });
    for (const analysis::LeftOut& body : left_out)
        if (full || body.scene == "human") plan.left_out.push_back(body);
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    std::vector<std::vector<PointRow>> points;
    for (const std::string& file : finished.files("points.csv")) points.push_back(rows_of(point_columns, analysis::read_csv(file)));
    if (points.empty()) return {"", false};
    finished.write("points.csv", point_columns, finished.rows(point_columns, "points.csv"));
    const std::vector<Diagram> diagrams = diagrams_of(points);
    finished.write("fronts.csv", fronts_table(diagrams));
    finished.write("crossings.csv", crossings_table(diagrams));
    finished.write("equal_cost.csv", budget_columns, equal_cost(diagrams));
    std::string text =
        best_text(diagrams) +
        "     error: distance to the reference at the joints, outside the overlap, % of the mean bone distance; *: not above "
        "the reference's own error (bound)\n";
    std::string page;
    for (const Diagram& diagram : diagrams) {
        page += fmt::format("## {}\n\n```\n{}```\n\n", diagram.name, front_text(diagram));
        for (const std::string& line : findings(diagram)) page += "- " + line + "\n";
        page += "\n";
    }
    finished.write("work_precision.md", page);
    return {text, !finished.none()};
}

}  // namespace

Study work_precision_study()
{
    return {"work_precision", plan, in_short, conclude, true};
}

}  // namespace experiments
