// The time to an equal answer: every order, precision and sequence of the constraints (equal_quality/order_rows.hpp).
//
//   limb_twist_150           the limb                             o=======o~~~~~~~o)
//   tapered_limb_twist_165   a regular grid of 2,025 vertices     (======______)
//   human_crouch             MakeHuman's body in CMU's 01_01
//
// Writes DIR/equal_quality/CASE/orders.csv and targets.csv; summary.csv, answers.csv and equal_quality.md over all cases.
#include "analysis/records/record_files.hpp"
#include "experiments/studies/equal_quality/order_report.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/geometry/input_error.hpp"

namespace experiments {
namespace {

std::string measure_and_record(const EqualQualityCase& of, const std::string& folder)
{
    const std::vector<MeasuredOrder> measured = measure_orders(of);
    table_of(order_columns, order_rows(of.of, measured)).write(analysis::path_in(folder, "orders.csv"));
    table_of(target_columns, target_rows(of.of, measured)).write(analysis::path_in(folder, "targets.csv"));
    for (const MeasuredOrder& one : measured)
        if (!one.path.finite) return one.order + " in the sequence " + one.sequence + " ceased to be finite";
    return {};
}

EqualQualityCase case_of(const analysis::CaseKey& of, Scene scene, int frame, bool full)
{
    EqualQualityCase own;
    own.of = of;
    own.scene = std::move(scene);
    own.frame = frame;
    own.random = {1, 2, 3, 4, 5};
    own.most_iterations = full ? 16000 : 4000;
    own.rounds = {.seconds = full ? 20.0 : 4.0, .fewest = 5, .most = 61};
    return own;
}

StudyPlan plan(bool full)
{
    const double cost_s = full ? 150.0 : 45.0;
    StudyPlan plan;
    plan.runs.push_back(work_run("limb_twist_150",
                                 case_of({.body = "limb", .motion = "twist", .angle_deg = 150.0},
                                         read_scene("limb_twist", {"motion.angle_deg=150", "motion.frames=2"}), 1, full),
                                 cost_s, measure_and_record));
    EqualQualityCase tapered = case_of({.body = "tapered_limb", .motion = "twist", .angle_deg = 165.0},
                                       read_scene("limb_twist", {"motion.angle_deg=165", "motion.frames=2"}), 1, full);
    tapered.is_tapered = true;
    plan.runs.push_back(work_run("tapered_limb_twist_165", tapered, cost_s, measure_and_record));
    try {
        plan.runs.push_back(work_run(
            "human_crouch",
            case_of({.body = "human", .motion = "01_01", .pose = "crouch"}, read_scene("human_01_01", {}), clip_frames::crouch, full),
            cost_s, measure_and_record));
    } catch (const pbs::InputError& error) {
        plan.left_out.push_back({"human_crouch", error.what()});
    }
    return plan;
}

StudyConclusion conclude(const FinishedRuns& finished)
{
    const std::vector<OrderSummary> orders = summaries(finished.rows(order_columns, "orders.csv"));
    const std::vector<EqualAnswer> answers = equal_answers(finished.rows(target_columns, "targets.csv"));
    finished.write("summary.csv", summary_columns, orders);
    finished.write("answers.csv", answer_columns, answers);
    const std::string text = order_report(orders, answers);
    finished.write("equal_quality.md", text);
    return {text, !finished.none()};
}

}  // namespace

Study equal_quality_study()
{
    return {"equal_quality", plan, full_in_short, conclude, true};
}

}  // namespace experiments
