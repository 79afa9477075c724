// Which single change improves PBS most at equal time?
//
//   limb twist 90, bend 60 (--full: also twist 150, bend 90)      o=======o~~~~~~~o)
//   --full: human crouch, standing, in the air, landing           CMU's clip 01_01
//
// Writes DIR/improvements/CASE/points.csv and, over all cases, equal_time.csv, gains.csv, curves.csv and improvements.md. Quick: some
// seconds; --full: some minutes of processor time.
#include "analysis/records/folder_files.hpp"
#include "analysis/report_table.hpp"
#include "experiments/studies/improvements/equal_time.hpp"
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
StudyRun limb_run(const std::string& motion, int angle_deg, bool full, bool refined_reference, double cost_s)
{
    ChangesCase of;
    of.of = {.body = "limb", .motion = motion, .angle_deg = angle_deg};
    of.scene =
        read_scene("limb_" + motion, {fmt::format("motion.angle_deg={}", angle_deg), fmt::format("motion.frames={}", angle_deg / 5 + 1)});
    of.frame = angle_deg / 5;
    of.range = range_of(full);
    of.refined_reference = refined_reference;
    of.rounds = rounds_of(full);
    return work_run(case_name(of), of, cost_s, measure_and_record);
}

// pbs::InputError if the body is not installed.
StudyRun human_run(const std::string& pose, int frame, bool refined_reference, double cost_s)
{
    ChangesCase of;
    of.of = {.body = "human", .motion = "01_01", .pose = pose};
    of.scene = read_scene("human_01_01", {});
    of.frame = frame;
    of.refined_reference = refined_reference;
    of.rounds = rounds_of(true);
    return work_run(case_name(of), of, cost_s, measure_and_record);
}

// References on refined tets only where they take about a minute: not in the creases of the bend by 90 degrees and of the crouch.
StudyPlan plan(bool full)
{
    StudyPlan plan;
    plan.runs.push_back(limb_run("twist", 90, full, full, full ? 60.0 : 6.0));
    plan.runs.push_back(limb_run("bend", 60, full, full, full ? 80.0 : 7.0));
    if (!full) return plan;
    plan.runs.push_back(limb_run("twist", 150, full, true, 70.0));
    plan.runs.push_back(limb_run("bend", 90, full, false, 40.0));
    try {
        plan.runs.push_back(human_run("crouch", 164, false, 20.0));
        plan.runs.push_back(human_run("standing", 0, false, 20.0));
        plan.runs.push_back(human_run("in_the_air", 672, true, 90.0));
        plan.runs.push_back(human_run("landing", 708, true, 110.0));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({"human", error.what()});
    }
    return plan;
}

// What the figure draws: the mean over the poses of a body at each number of iterations, with the setting that was chosen for most of its
// poses at the budget of 96 iterations.
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

std::string spoken(std::string name)
{
    std::ranges::replace(name, '_', ' ');
    return name;
}

std::string remark_on(const GainRow& gain)
{
    switch (gain.decision) {
        case GainDecision::decided:
            return "decided";
        case GainDecision::few_poses:
            return gain.poses < fewest_poses ? fmt::format("undecided: fewer than {} poses", fewest_poses)
                                             : "undecided: the interval over the poses includes zero";
        case GainDecision::reference_error:
            break;
    }
    return gain.reference_error_pct
               ? fmt::format("undecided: the reference's own error may change it by {:.2g} points", *gain.reference_error_pct)
               : "undecided: the reference's own error is not known";
}

std::string interval_of(const GainRow& gain)
{
    return gain.gain_low_pct ? fmt::format("{:.2f} ({:.2f} to {:.2f})", gain.gain_pct, *gain.gain_low_pct, *gain.gain_high_pct)
                             : fmt::format("{:.2f}", gain.gain_pct);
}

std::string of_the_control(const std::vector<GainRow>& gains)
{
    const auto own = std::ranges::find(gains, control, &GainRow::change);
    return own == gains.end() ? ""
                              : fmt::format(" Other values of k_stretch or k_bind, which change nothing else, gain {} [{}].",
                                            interval_of(*own), remark_on(*own));
}

// The answer at one budget. gains: of this budget, the largest first, then the comparison of the first one with the second.
std::string answer(const std::vector<GainRow>& gains)
{
    const auto versus = std::ranges::find_if(gains, [](const GainRow& gain) { return gain.than != baseline; });
    if (versus == gains.end()) return "";
    const auto best = std::ranges::find(gains, versus->change, &GainRow::change);
    if (best->gain_pct <= 0.0)
        return fmt::format(
            "No single change reduces the mean error over {} poses, {:.2f} %. The best one, {}, gains {} percentage points "
            "[{}].{}\n",
            best->poses, best->than_error_pct, spoken(best->change), interval_of(*best), remark_on(*best), of_the_control(gains));
    return fmt::format(
        "The change that helps most is {}: over {} poses the mean error at the joints is {:.2f} % instead of {:.2f} %, a gain of {} "
        "percentage points [{}]. Relative to the second one, {}, it gains {} [{}].{}\n",
        spoken(best->change), best->poses, best->error_pct, best->than_error_pct, interval_of(*best), remark_on(*best),
        spoken(versus->than), interval_of(*versus), remark_on(*versus), of_the_control(gains));
}

std::string page_of(const std::vector<GainRow>& gains)
{
    std::string page;
    for (std::size_t first = 0; first < gains.size();) {
        std::vector<GainRow> own;  // of one group at one budget, which follow each other
        for (; first < gains.size() && (own.empty() || (gains[first].group == own.front().group &&
                                                        gains[first].budget_iterations == own.front().budget_iterations));
             ++first)
            own.push_back(gains[first]);
        const std::string poses = own.front().group == all_poses ? "all poses" : "the poses of the body " + own.front().group;
        page += fmt::format("## In the time of {} iterations of PBS, {}\n\n{}\n", own.front().budget_iterations, poses, answer(own));
        std::erase_if(own, [](const GainRow& gain) { return gain.than != baseline; });
        page += markdown_table(table_of(gain_columns, own), {{"change", "change"},
                                                             {"poses", "poses"},
                                                             {"iterations", "iterations", "{:.1f}"},
                                                             {"error [%]", "error_pct", "{:.2f}"},
                                                             {"of PBS [%]", "than_error_pct", "{:.2f}"},
                                                             {"gain [points]", "gain_pct", "{:.2f}"},
                                                             {"from", "gain_low_pct", "{:.2f}"},
                                                             {"to", "gain_high_pct", "{:.2f}"},
                                                             {"reference's error [points]", "reference_error_pct", "{:.2f}"},
                                                             {"decision", "decision"},
                                                             {"volume change [%]", "volume_abs_pct", "{:.2f}"},
                                                             {"settings", "settings"}}) +
                "\n";
    }
    return page;
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
    const std::string page = page_of(gains);
    finished.write("improvements.md", page);
    return {page, true};
}

}  // namespace

Study improvements_study()
{
    return {"improvements", plan, quick_and_full, conclude, true};
}

}  // namespace experiments
