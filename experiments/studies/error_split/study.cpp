// The error of PBS against the reference, split into solver, model and discretisation (error_split/error_split.hpp).
//
//   limb_twist   90 deg (--full: 30 to 150)           o=======o~~~~~~~o)
//   limb_bend    60 deg (--full: 30 to 110)           o=======o
//   human_01_01  a crouch, in the air (--full)        MakeHuman's body
//
// Writes DIR/error_split/CASE/parts.csv and attachments.csv, and error_split.md.
#include "analysis/records/record_files.hpp"
#include "analysis/records/report_table.hpp"
#include "experiments/studies/error_split/error_split.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace experiments {
namespace {

std::string split_and_record(const ErrorSplitCase& of, const std::string& folder)
{
    const ErrorSplit split = split_error(of);
    table_of(part_columns, split.parts).write(analysis::path_in(folder, "parts.csv"));
    table_of(attachment_columns, split.attachments).write(analysis::path_in(folder, "attachments.csv"));
    return split.breakdown;
}

StudyRun split_run(const std::string& name, const std::string& scene, const std::vector<std::string>& overrides,
                   const std::vector<int>& frames, bool full, double cost_s)
{
    ErrorSplitCase of;
    of.scene = read_scene(scene, overrides);
    of.frames = frames;
    of.pbs = spec_of(of.scene, "pbs");
    of.reference = reference_flesh(of.scene);
    of.others = other_attachments(of.reference);
    of.k_stretch = {0.05, 0.2, 0.9};
    of.iterations = {1, 4, 24, 96, 384};
    if (full) of.converged_iterations = 32000;
    return work_run(name, of, cost_s, split_and_record);
}

StudyPlan plan(bool full)
{
    StudyPlan plan;
    const std::vector<std::string> twist = {"motion.angle_deg=180", "motion.frames=19"},
                                   bend = {"motion.angle_deg=120", "motion.frames=13"};
    // 10 degrees per frame
    plan.runs.push_back(split_run("limb_twist", "limb_twist", twist, full ? std::vector<int>{3, 6, 9, 12, 15} : std::vector<int>{9}, full,
                                  full ? 1800.0 : 190.0));
    plan.runs.push_back(
        split_run("limb_bend", "limb_bend", bend, full ? std::vector<int>{3, 6, 9, 11} : std::vector<int>{6}, full, full ? 1800.0 : 215.0));
    if (!full) return plan;
    try {
        plan.runs.push_back(split_run("human_01_01", "human_01_01", {}, {clip_frames::crouch, clip_frames::in_the_air}, full, 600.0));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({"human_01_01", error.what()});
    }
    return plan;
}

// The parts at the paper's 24 iterations, and how far PBS is from flesh that is held by the bind constraint.
struct PartsAndBind {
    ErrorParts parts;
    std::optional<double> bind_pct;
};

StudyConclusion conclude(const FinishedRuns& finished)
{
    static const analysis::Columns<PartsAndBind> report_columns =
        analysis::within(&PartsAndBind::parts, part_columns) +
        analysis::Columns<PartsAndBind>{{"bind_pct", &PartsAndBind::bind_pct, "%", "distance of PBS's converged shape from that flesh"}};
    std::vector<PartsAndBind> rows;
    const auto attachments = finished.rows(attachment_columns, "attachments.csv");
    for (const ErrorParts& part : finished.rows(part_columns, "parts.csv")) {
        if (part.iterations != 24) continue;
        const auto is_bind = [&](const AttachmentShare& other) {
            return other.attachment == "bind" && other.scene == part.scene && other.frame == part.frame &&
                   other.k_stretch == part.k_stretch;
        };
        const auto bind = std::ranges::find_if(attachments, is_bind);
        rows.push_back({part, bind == attachments.end() ? std::nullopt : std::optional(bind->model_pct)});
    }
    const std::string table = markdown_table(table_of(report_columns, rows),
                                             {{"scene", "scene"},
                                              {"angle", "angle_deg", "{:.0f}"},
                                              {"k_stretch", "k_stretch"},
                                              {"masked [% of the volume]", "masked_share_pct", "{:.1f}"},
                                              {"error of PBS 24 [% of the bone distance]", "error_joint_pct", "{:.1f}", 1.0, "\u2013"},
                                              {"on the whole body", "whole_joint_pct", "{:.1f}", 1.0, "\u2013"},
                                              {"solver", "solver_pct", "{:.1f}", 1.0, "\u2013"},
                                              {"model", "model_pct", "{:.1f}", 1.0, "\u2013"},
                                              {"discretisation (bound)", "discretisation_pct", "{:.2f}", 1.0, "\u2013"},
                                              {"observed order", "observed_order", "{:.2f}", 1.0, "\u2013"},
                                              {"flesh held by bind constraints", "bind_pct", "{:.1f}", 1.0, "\u2013"}});
    finished.write("error_split.md", table);
    return {table, !finished.none()};
}

}  // namespace

Study error_split_study()
{
    return {"error_split", plan, full_in_short, conclude};
}

}  // namespace experiments
