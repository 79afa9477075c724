// Is the error of PBS that of its solver, of its model or of the reference's discretisation (ensemble.hpp)? README.md
// describes the poses and records.
//
//   pbskin reproduce ensemble            two poses, 20 minutes on one core
//   pbskin reproduce ensemble --full     three poses, an hour
#include "analysis/records/record_files.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/ensemble/ensemble.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/study.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace experiments {

using analysis::Columns;
using analysis::within;

const Columns<OwnTetsRow> own_tets_columns =
    within(&OwnTetsRow::of, pose_columns()) + MEMBER_COLUMNS(OwnTetsRow, bound_pct, linear_distance_pct);

const Columns<PartsRow> part_columns =
    within(&PartsRow::of, pose_columns()) + MEMBER_COLUMNS(PartsRow, k_stretch, iterations, error_joint_pct, solver_pct,
                                                           model_pct, discretisation_pct, not_converged_pct,
                                                           error_l2_pct, error_linf_m, whole_joint_pct,
                                                           masked_share_pct, observed_order, order_is_reliable);

const Columns<AttachmentRow> attachment_columns =
    within(&AttachmentRow::of, pose_columns()) + MEMBER_COLUMNS(AttachmentRow, reference, model, attachment,
                                                                spring_factor, core_radius, difference_pct, k_stretch,
                                                                model_pct, finished);

RECORD_SETTINGS(EnsembleCase, of, scene, frame, flesh, effort, pbs, other_flesh, k_stretch, iterations,
                converged_iterations)

std::vector<DeformerSpec> other_attachments(const DeformerSpec& reference)
{
    std::vector<DeformerSpec> others;
    const auto add = [&](const char* label, FemAttachment attachment, double spring_factor, double core_radius,
                         bool is_linear = false) {
        DeformerSpec& other = others.emplace_back(reference);
        other.name = other.label = label;
        auto& options = options_of<FemOptions>(other);
        options.element_order = 2;
        options.nested_start = !is_linear;
        options.attachment = attachment;
        options.spring_factor = spring_factor;
        options.core_radius = core_radius;
        if (!is_linear) return;
        options.model = reference_fem::Model::linear;
        options.most_newton_steps = 0;
    };
    const auto& own = options_of<FemOptions>(reference);
    add("smooth_q_100", FemAttachment::smooth, 100.0, own.core_radius);
    add("smooth_core_0.5", FemAttachment::smooth, own.spring_factor, 0.5);
    add("embedded", FemAttachment::embedded, 0.0, 0.0);  // 0: the attachment's own
    add("bind", FemAttachment::bind, 0.0, 0.0);
    add("linear_smooth", FemAttachment::smooth, own.spring_factor, own.core_radius, true);
    add("linear_embedded", FemAttachment::embedded, 0.0, 0.0, true);
    return others;
}

namespace {

OwnTetsRow own_tets_row(const EnsembleCase& ensemble_case, const PosedReference& reference)
{
    OwnTetsRow row{.of = ensemble_case.of};
    if (const double bound_pct = reference.bound_on_own_tets().joint_pct; std::isfinite(bound_pct))
        row.bound_pct = bound_pct;
    const NestedSolution *linear = nullptr, *quadratic = nullptr;
    for (const NestedSolution& solution : reference.solutions())
        if (solution.finished && solution.refinements == 0 && solution.other_tets == 0 && !solution.along_the_bones)
            (solution.element_order == 1 ? linear : quadratic) = &solution;
    if (linear && quadratic)
        row.linear_distance_pct = reference.distance(linear->positions, quadratic->positions).joint_pct;
    return row;
}

pbs::PbsOptions in_double(const DeformerSpec& spec, double k_stretch, int iterations)
{
    pbs::PbsOptions options = options_of<pbs::PbsOptions>(spec);
    options.precision = pbs::Precision::f64;
    options.k_stretch = k_stretch;
    options.iterations = iterations;
    options.jiggle.reset();
    return options;
}

// The parts of PBS's error relative to one reference.
class Splitting {
public:
    Splitting(const EnsembleCase& ensemble_case, const PosedCharacter& base, const PosedReference& reference)
        : of_(ensemble_case),
          base_(base),
          reference_(reference),
          reference_shape_{reference.reference().positions, true}
    {
    }

    void add_to(EnsembleRecords& records) const
    {
        std::vector<Shape> others;
        for (const DeformerSpec& other : of_.other_flesh) others.push_back(base_.shapes(other).front());
        for (const double k_stretch : of_.k_stretch) {
            const pbs::PbsOptions whole = in_double(of_.pbs, k_stretch, of_.converged_iterations);
            std::vector<pbs::PbsOptions> options_of_runs = {
                whole, in_double(of_.pbs, k_stretch, of_.converged_iterations / 2)};
            for (const int iterations : of_.iterations)
                options_of_runs.push_back(in_double(of_.pbs, k_stretch, iterations));
            const std::vector<Shapes> shapes = base_.shapes(options_of_runs);
            const Shape &converged = shapes[0].front(), &half_way = shapes[1].front();
            for (std::size_t n = 2; n < shapes.size(); ++n) {
                PartsRow row = parts_of(shapes[n].front(), converged);
                row.k_stretch = k_stretch;
                row.iterations = options_of_runs[n].iterations;
                row.not_converged_pct = distance(converged, half_way).joint_pct;
                records.parts.push_back(row);
            }
            records.attachments.push_back(attachment(k_stretch, converged, of_.flesh, reference_shape_));
            for (std::size_t other = 0; other < others.size(); ++other)
                records.attachments.push_back(attachment(k_stretch, converged, of_.other_flesh[other], others[other]));
        }
    }

private:
    PartsRow parts_of(const Shape& shape, const Shape& converged) const
    {
        const analysis::ErrorNorms total = distance(shape, reference_shape_);
        PartsRow row{.of = of_.of};
        row.error_joint_pct = total.joint_pct;
        row.solver_pct = distance(shape, converged).joint_pct;
        row.model_pct = distance(converged, reference_shape_).joint_pct;
        row.discretisation_pct = reference_.bound().joint_pct;
        row.error_l2_pct = total.l2_pct;
        row.error_linf_m = total.linf_m;
        row.whole_joint_pct = base_.distance(shape, reference_shape_).joint_pct;
        row.masked_share_pct = reference_.masked_share_pct();
        if (!reference_.order()) return row;
        row.observed_order = reference_.order()->observed;
        row.order_is_reliable = reference_.order()->reliable;
        return row;
    }

    AttachmentRow attachment(double k_stretch, const Shape& converged, const DeformerSpec& flesh,
                             const Shape& shape) const
    {
        const auto& fem = options_of<FemOptions>(flesh);
        AttachmentRow row{of_.of, flesh.label, name_of(fem.model), name_of(fem.attachment)};
        if (fem.has_spring_factor()) row.spring_factor = fem.used_spring_factor();
        if (fem.has_capsules()) row.core_radius = fem.used_core_radius();
        row.difference_pct = distance(shape, reference_shape_).joint_pct;
        row.k_stretch = k_stretch;
        row.model_pct = distance(converged, shape).joint_pct;
        row.finished = shape.finished;
        return row;
    }

    // Outside the tips of creases. Not a number where one of them did not finish.
    analysis::ErrorNorms distance(const Shape& shape, const Shape& other) const
    {
        constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
        if (!shape.finished || !other.finished) return {nothing, nothing, nothing};
        return reference_.distance(shape.positions, other.positions);
    }

    const EnsembleCase& of_;
    const PosedCharacter& base_;
    const PosedReference& reference_;
    Shape reference_shape_;
};

std::string measure_and_record(const EnsembleCase& ensemble_case, const std::string& folder)
{
    const EnsembleRecords records = measure_ensemble(ensemble_case, solutions_of_run(folder));
    const auto path = [&](const char* name) { return analysis::path_in(folder, name); };
    table_of(own_tets_columns, records.own_tets).write(path("own_tets.csv"));
    table_of(part_columns, records.parts).write(path("parts.csv"));
    table_of(attachment_columns, records.attachments).write(path("attachments.csv"));
    return "";
}

StudyPlan plan(bool full)
{
    return plan_of_cases("ensemble", full, [&](const StudyCase& in_file, StudyPlan& plan) {
        EnsembleCase ensemble_case{.of = in_file.key(), .scene = in_file.scene(), .frame = in_file.value<int>("frame")};
        ensemble_case.flesh = reference_flesh(ensemble_case.scene);
        ensemble_case.pbs = spec_of(ensemble_case.scene, "pbs");
        options_of<pbs::PbsOptions>(ensemble_case.pbs).jiggle.reset();
        ensemble_case.other_flesh = other_attachments(ensemble_case.flesh);
        ensemble_case.k_stretch = {0.05, 0.2, 0.9};
        ensemble_case.iterations = {1, 4, 24, 96, 384};
        ensemble_case.converged_iterations = full ? 32000 : 8000;
        plan.runs.push_back(work_run(in_file.name, ensemble_case, in_file.cost_s, measure_and_record));
    });
}

bool conclude(const FinishedRuns& finished)
{
    finished.write("own_tets.csv", own_tets_columns, finished.rows(own_tets_columns, "own_tets.csv"));
    return true;
}

}  // namespace

EnsembleRecords measure_ensemble(const EnsembleCase& ensemble_case, const std::string& solutions)
{
    const PosedCharacter body(ensemble_case.scene, {ensemble_case.frame});
    const PosedReference reference(body.character(), ensemble_case.flesh, body.pose(0),
                                   ensemble_case.scene.motion.time_step_s, ensemble_case.effort, solutions);
    EnsembleRecords records;
    if (!reference.is_reached()) return records;
    records.own_tets.push_back(own_tets_row(ensemble_case, reference));
    if (!ensemble_case.k_stretch.empty()) Splitting(ensemble_case, body, reference).add_to(records);
    return records;
}

Study ensemble_study()
{
    return {"ensemble", plan, full_in_short, conclude};
}

}  // namespace experiments
