// Error against run time: which deformer is nearest to the reference for the time that a frame may take, and which single change improves
// PBS most in equal time. README.md describes the poses, the rules of the comparison and the records.
//
//   pbskin reproduce work_precision                          minutes
//   pbskin reproduce work_precision --full                   three hours
//   pbskin reproduce work_precision --external mine.toml     with deformers of your own
#include "experiments/studies/study.hpp"

#include "analysis/records/record_files.hpp"
#include "experiments/studies/work_precision/diagram.hpp"
#include "experiments/studies/work_precision/gains.hpp"
#include "experiments/studies/work_precision/measured_points.hpp"

namespace experiments {
namespace {

std::string measure_and_record(const WorkPrecisionCase& of, const std::string& folder)
{
    const MeasuredPoints points = measure_points(of, solutions_of_run(folder));
    table_of(columns_for(points.rows), points.rows).write(analysis::path_in(folder, "points.csv"));
    analysis::write_text_atomically(analysis::path_in(folder, "shapes.cbor"), points.shapes.text());
    table_of(family_columns, points.members).write(analysis::path_in(folder, "members.csv"));
    if (of.range.changes) table_of(change_columns, points.changes).write(analysis::path_in(folder, "changes.csv"));
    return points.breakdown;
}

// 1. The cases, in the order of cases.toml. In full: all settings, meshes of other sizes, a bound on the error of each reference,
// and on the evaluated poses the other references of the family.
StudyPlan plan_of(bool full, const std::vector<DeformerSpec>& external)
{
    return plan_of_cases("work_precision", full, [&](const StudyCase& in_file, StudyPlan& plan) {
        WorkPrecisionCase of{.of = in_file.key(), .scene = in_file.scene(), .frame = in_file.value<int>("frame"), .external = external};
        of.half = option_of<Half>(in_file.value<std::string>("half"));
        of.range.in_short = !full;
        of.range.quadratic = full;
        of.range.refined = in_file.value("refined", false);
        of.range.changes = in_file.value("changes", false);
        of.range.quadratic_up_to = in_file.value<int>("quadratic_up_to");
        of.range.other_vertices = in_file.value<std::vector<int>>("other_vertices");
        of.range.without_fem = in_file.value<std::vector<int>>("without_fem", {});
        of.rounds = {.seconds = full ? 10.0 : 1.0, .fewest = full ? 5 : 3, .most = 31};
        of.newton_rounds = {.seconds = full ? 5.0 : 0.0, .fewest = 1, .most = 9};
        of.reference_is_refined = in_file.value("reference_is_refined", full);
        if (full && of.half == Half::evaluation) {
            of.members = family();
            of.members.erase(of.members.begin());
        }
        plan.runs.push_back(work_run(in_file.name, of, in_file.cost_s, measure_and_record));
    });
}

StudyPlan plan(bool full)
{
    return plan_of(full, {});
}

StudyPlan plan_with(bool full, const std::string& external_file)
{
    return plan_of(full, external_entries(external_file));
}

// 2. The tables over all cases.
bool conclude(const FinishedRuns& finished)
{
    if (finished.none()) return false;
    std::vector<CaseRecords> cases;
    std::vector<CaseRows> rows;
    for (const std::string& folder : finished.folders) {
        const auto read = [&](const char* file) { return analysis::read_csv(analysis::path_in(folder, file)); };
        rows.push_back(rows_of(point_columns, read("points.csv")));
        const auto shapes = RecordedShapes::read(analysis::read_text(analysis::path_in(folder, "shapes.cbor")));
        cases.push_back({rows.back(), rows_of(family_columns, read("members.csv")), std::make_shared<RecordedShapes>(shapes)});
    }
    const std::vector<ChosenSetting> chosen = choose_settings(rows);
    const std::vector<Diagram> diagrams = diagrams_of(cases, chosen);
    std::vector<Omission> omissions = omissions_of(rows);
    for (const Omission& omission : omissions_of_means(rows, diagrams)) omissions.push_back(omission);
    finished.write("settings.csv", chosen_columns, chosen);
    finished.write("fronts.csv", fronts_table(diagrams));
    const NearestAnswers answers = nearest_classes(diagrams, diagrams_of(cases, default_settings(rows)));
    finished.write("nearest.csv", nearest_columns, answers.answers);
    finished.write("nearest_pairs.csv", nearest_pair_columns, answers.pairs);
    finished.write("data_profiles.csv", data_profile_columns, data_profiles(diagrams));
    finished.write("omissions.csv", omission_columns, omissions);

    const std::vector<PointRow> changes = finished.rows(change_columns, "changes.csv");
    const std::vector<EqualTimeRow> at_budgets = at_equal_time(changes);
    finished.write("gains.csv", gain_columns, gains_of(at_budgets));
    finished.write("curves.csv", curve_columns, mean_curves(changes, at_budgets));
    return true;
}

}  // namespace

Study work_precision_study()
{
    return {"work_precision", plan, in_short, conclude, true, plan_with};
}

}  // namespace experiments
