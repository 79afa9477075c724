// Which single change improves PBS most at equal time?
//
//   limb twist 90, bend 60 (--full: also twist 150, bend 90)      o=======o~~~~~~~o)
//   --full: human crouch, standing, in the air, landing           CMU's clip 01_01
//
// Writes DIR/improvements/CASE/points.csv and, over all cases, equal_time.csv, gains.csv, curves.csv and improvements.md. Quick: some
// seconds; --full: half an hour of processor time.
#include "analysis/records/record_files.hpp"
#include "experiments/studies/improvements/gains_page.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace experiments {
namespace {

std::string measure_and_record(const ChangesCase& of, const std::string& folder)
{
    const MeasuredChanges measured = measure_changes(of);
    table_of(change_columns, measured.rows).write(analysis::path_in(folder, "points.csv"));
    return measured.breakdown;
}

Rounds rounds_of(bool full)
{
    return {.seconds = full ? 8.0 : 2.0, .fewest = 5, .most = 31};
}

// In the quick form each change has few settings.
RangeOfChanges range_of(bool full)
{
    if (full) return {};
    return {.iterations = {1, 4, 8, 24, 48, 96},
            .k_bind_to_blended = {0.02, 0.1},
            .region_tets = {64, 256},
            .k_stretch = {0.5},
            .k_bind = {0.5}};
}

// 5 degrees per frame, which is the step that is timed.
StudyRun limb_run(const std::string& motion, int angle_deg, bool full, double cost_s)
{
    ChangesCase of;
    of.of = {.body = "limb", .motion = motion, .angle_deg = angle_deg};
    of.scene =
        read_scene("limb_" + motion, {fmt::format("motion.angle_deg={}", angle_deg), fmt::format("motion.frames={}", angle_deg / 5 + 1)});
    of.frame = angle_deg / 5;
    of.range = range_of(full);
    of.refined_reference = full;
    of.rounds = rounds_of(full);
    return work_run(case_name(of.of), of, cost_s, measure_and_record);
}

// pbs::InputError if the body is not installed.
StudyRun human_run(const std::string& pose, int frame, double cost_s)
{
    ChangesCase of;
    of.of = {.body = "human", .motion = "01_01", .pose = pose};
    of.scene = read_scene("human_01_01", {});
    of.frame = frame;
    of.refined_reference = true;
    of.rounds = rounds_of(true);
    return work_run(case_name(of.of), of, cost_s, measure_and_record);
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    plan.runs.push_back(limb_run("twist", 90, full, full ? 60.0 : 6.0));
    plan.runs.push_back(limb_run("bend", 60, full, full ? 80.0 : 7.0));
    if (!full) return plan;
    plan.runs.push_back(limb_run("twist", 150, full, 70.0));
    plan.runs.push_back(limb_run("bend", 90, full, 900.0));
    try {
        plan.runs.push_back(human_run("crouch", clip_frames::crouch, 140.0));
        plan.runs.push_back(human_run("standing", clip_frames::standing, 180.0));
        plan.runs.push_back(human_run("in_the_air", clip_frames::in_the_air, 90.0));
        plan.runs.push_back(human_run("landing", clip_frames::landing, 110.0));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({"human", error.what()});
    }
    return plan;
}

// A point of a curve in the figure: the mean over the poses of a body at one number of iterations. The setting is the one that was chosen
// for most of these poses at the budget of 96 iterations.
struct CurveRow {
    std::string body, change, setting;
    int iterations = 0, poses = 0;
    double ms = 0.0, error_pct = 0.0;
};
const analysis::Columns<CurveRow> curve_columns = {
    {"body", &CurveRow::body, "", "name of the body"},
    {"change", &CurveRow::change, "", "pbs, which is the baseline, or the name of a change"},
    {"setting", &CurveRow::setting, "", "of its parameter: the one chosen for most poses at the time of 96 iterations"},
    {"iterations", &CurveRow::iterations, "", "of Algorithm 1"},
    {"poses", &CurveRow::poses, "", "number of poses in the mean"},
    {"mean_ms", &CurveRow::ms, "ms", "mean of the median times per frame"},
    {"error_joint_pct", &CurveRow::error_pct, "%", "mean error at the joints outside the overlap"}};

using BodyAndChange = std::pair<std::string, std::string>;
std::map<BodyAndChange, std::string> usual_settings(const std::vector<EqualTimeRow>& rows)
{
    const bool has_bodies = std::ranges::any_of(rows, [](const EqualTimeRow& row) { return row.group != all_poses; });
    std::map<BodyAndChange, std::map<std::string, int>> times;
    std::map<BodyAndChange, std::string> usual;
    for (const EqualTimeRow& row : rows) {
        usual[{row.of.body, baseline}] = "";
        if (row.budget_iterations == 96 && (row.group == all_poses) != has_bodies) ++times[{row.of.body, row.change}][row.setting];
    }
    for (const auto& [key, settings] : times)
        usual[key] = std::ranges::max_element(settings, {}, [](const auto& setting) { return setting.second; })->first;
    return usual;
}

std::vector<CurveRow> curves_of(const std::vector<ChangePoint>& points, const std::vector<EqualTimeRow>& rows)
{
    std::vector<CurveRow> curves;
    const std::map<BodyAndChange, std::string> usual = usual_settings(rows);
    for (const ChangePoint& point : points) {
        const auto setting = usual.find({point.of.body, point.change});
        if (setting == usual.end() || setting->second != point.setting || !point.error_joint_pct) continue;
        auto curve = std::ranges::find_if(curves, [&](const CurveRow& row) {
            return row.body == point.of.body && row.change == point.change && row.iterations == point.iterations;
        });
        if (curve == curves.end()) {
            curves.push_back({point.of.body, point.change, point.setting, point.iterations});
            curve = curves.end() - 1;
        }
        ++curve->poses;
        curve->ms += (point.ms.median - curve->ms) / curve->poses;
        curve->error_pct += (*point.error_joint_pct - curve->error_pct) / curve->poses;
    }
    return curves;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    if (finished.none()) return {"", false};
    const std::vector<ChangePoint> points = finished.rows(change_columns, "points.csv");
    const std::vector<EqualTimeRow> rows = at_equal_time(points);
    const std::vector<GainRow> gains = gains_of(rows);
    finished.write("equal_time.csv", equal_time_columns, rows);
    finished.write("gains.csv", gain_columns, gains);
    finished.write("curves.csv", curve_columns, curves_of(points, rows));
    const std::string page = gains_page(gains);
    finished.write("improvements.md", page);
    return {page, true};
}

}  // namespace

Study improvements_study()
{
    return {"improvements", plan, quick_and_full, conclude, true};
}

}  // namespace experiments
