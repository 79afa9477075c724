// Error against run time: which method is nearest to the references for the time that a frame may take. README.md
// describes the poses, the comparison and the records.
//
//   pbskin reproduce work_precision                          two bodies, three minutes
//   pbskin reproduce work_precision --full                   five bodies, the choice of settings, two clips: 15 minutes
//   pbskin reproduce work_precision --external mine.toml     with deformers of your own
#include "analysis/records/record_files.hpp"
#include "experiments/studies/shared/kept_references.hpp"
#include "experiments/studies/study.hpp"
#include "experiments/studies/work_precision/conclusions.hpp"
#include "experiments/studies/work_precision/measuring.hpp"

#include <algorithm>

namespace experiments {
namespace {

// The reference of each pose again, so that the folder has all that the tables are computed from.
analysis::CsvTable own_errors(const ComparisonCase& comparison)
{
    const pbs::Character character = pbs::make_character(comparison.poses.front().scene.character);
    analysis::CsvTable own(own_error_columns, "references.csv");
    for (const ReferencePose& pose : comparison.poses)
        for (const KeptReference& reference :
             read_references(pose.name, character, bones_in(pose, character.skeleton)).members) {
            const double own_pct = reference.own_error_pct();
            own.add_row({pose.name, pose.of.body, pose.stratum, reference.member.name, reference.outcome,
                         std::isfinite(own_pct) ? std::optional(own_pct) : std::nullopt});
        }
    return own;
}

std::string measure_and_record(const ComparisonCase& comparison, const std::string& folder)
{
    const Measurements measurements = measure(comparison);
    const auto path = [&](const char* name) { return analysis::path_in(folder, name); };
    if (comparison.what == Measured::played)
        measurements.played.write(path("played.csv"));
    else
        table_of(point_columns, measurements.points)
            .write(path(comparison.what == Measured::training ? "training.csv" : "points.csv"));
    if (comparison.what == Measured::evaluation) own_errors(comparison).write(path("references.csv"));
    return measurements.breakdown;
}

bool is_measured(const ReferencePose& pose, const ComparisonCase& comparison)
{
    if (pose.of.body != comparison.body) return false;
    switch (comparison.what) {
        case Measured::training:
            return pose.stratum == Stratum::training;
        case Measured::evaluation:
            return pose.stratum == Stratum::movement || pose.stratum == Stratum::fold;
        case Measured::played:
            return pose.stratum == Stratum::played && pose.of.motion == comparison.clip;
    }
    return false;
}

// 1. The runs: one per body, and per clip. The default form has the settings of the tables' times alone.
StudyPlan plan_of(bool full, const std::vector<ComparedMethod>& external)
{
    const std::vector<ReferencePose> poses = reference_poses();
    const std::vector<double>& shown_ms = comparison_times().tables_ms;
    return plan_of_cases("work_precision", full, [&](const StudyCase& in_file, StudyPlan& plan) {
        ComparisonCase comparison{.name = in_file.name, .body = in_file.value<std::string>("body")};
        require_kept_tets(comparison.body);
        comparison.what = option_of<Measured>(in_file.value<std::string>("what"));
        comparison.clip = in_file.value<std::string>("clip", "");
        for (const ReferencePose& pose : poses)
            if (is_measured(pose, comparison)) comparison.poses.push_back(pose);
        for (const ChosenSetting& chosen : kept_settings())
            if (comparison.what == Measured::played || !full ? std::ranges::count(shown_ms, chosen.budget_ms) > 0
                                                             : comparison.what == Measured::evaluation)
                comparison.settings.push_back(chosen);
        if (comparison.what == Measured::evaluation) comparison.external = external;
        plan.runs.push_back(work_run(in_file.name, comparison, in_file.cost_s, measure_and_record));
    });
}

StudyPlan plan(bool full)
{
    return plan_of(full, {});
}

StudyPlan plan_with(bool full, const std::string& external_file)
{
    return plan_of(full, external_methods(external_file));
}

// 2. The tables over all poses.
bool conclude(const FinishedRuns& finished)
{
    if (const analysis::CsvTable training = finished.table(point_columns.names(), "training.csv"); training.rows() > 0)
        finished.write("settings.csv", chosen_columns, chosen_settings(training));
    const analysis::CsvTable own = finished.table(own_error_columns, "references.csv"),
                             points = finished.table(point_columns.names(), "points.csv"),
                             played = finished.table(played_columns, "played.csv");
    const Comparison comparison = concluded(points, own, kept_settings());
    finished.write("references.csv", own);
    finished.write("errors.csv", comparison.errors);
    finished.write("methods.csv", comparison.methods);
    finished.write("pairs.csv", comparison.pairs);
    finished.write("decisions.csv", comparison.decisions);
    finished.write("curves.csv", comparison.curves);
    finished.write("profiles.csv", comparison.profiles);
    finished.write("starts.csv", comparison.starts);
    if (played.rows() > 0) finished.write("motion.csv", concluded_motion(played, kept_settings()));
    return true;
}

}  // namespace

Study work_precision_study()
{
    return {"work_precision", plan, quick_and_full, conclude, true, plan_with};
}

}  // namespace experiments
