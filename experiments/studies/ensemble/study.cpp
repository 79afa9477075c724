// Which deformer is closer to elastic flesh, whatever reference of a family is taken, and is the error of PBS that of its solver, of its
// model or of the reference's discretisation (ensemble.hpp)? README.md describes the poses and records.
//
//   pbskin reproduce ensemble            20 minutes on one core
//   pbskin reproduce ensemble --full     eight hours
#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/records/record_files.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/run/metrics_table.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/ensemble/ensemble.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/study.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace experiments {

using analysis::Columns;
using analysis::within;

const Columns<MemberRow> member_columns =
    within(&MemberRow::of, pose_columns()) + within(&MemberRow::member, family_member_columns()) +
    MEMBER_COLUMNS(MemberRow, outcome, element_order, refinements, error_bound_pct, error_bound_l2_pct, spread_pct, observed_order,
                   reliable, masked_share_pct, volume_change_pct, lowest_det_f) +
    Columns<MemberRow>{{"inverted", &MemberRow::inverted_tets}} +
    MEMBER_COLUMNS(MemberRow, j_min, worst_tet, newton_steps, projected, solve_s);

const Columns<ErrorRow> error_columns =
    within(&ErrorRow::of, pose_columns()) +
    MEMBER_COLUMNS(ErrorRow, member, deformer, error_joint_pct, error_l2_pct, whole_joint_pct, volume_change_pct) +
    within(&ErrorRow::skin, skin_error_columns());

const Columns<PairOrderRow> pair_order_columns =
    within(&PairOrderRow::of, pose_columns()) +
    MEMBER_COLUMNS(PairOrderRow, member, first, second, settings, first_error_pct, second_error_pct, distance_pct, error_bound_pct, order);

const Columns<PairRow> pair_columns =
    within(&PairRow::of, pose_columns()) + MEMBER_COLUMNS(PairRow, first, second, difference_pct, largest_difference_pct, members,
                                                          not_reached, first_is_closer, second_is_closer, decision);

const Columns<PartsRow> part_columns =
    within(&PartsRow::of, pose_columns()) + MEMBER_COLUMNS(PartsRow, k_stretch, iterations, error_joint_pct, solver_pct, model_pct,
                                                           discretisation_pct, not_converged_pct, error_l2_pct, error_linf_m,
                                                           whole_joint_pct, masked_share_pct, observed_order, order_is_reliable);

const Columns<AttachmentRow> attachment_columns =
    within(&AttachmentRow::of, pose_columns()) +
    MEMBER_COLUMNS(AttachmentRow, reference, model, attachment, spring_factor, core_radius, difference_pct, k_stretch, model_pct, finished);

RECORD_SETTINGS(EnsembleCase, of, scene, frame, flesh, members, effort, deformers, tuned, pbs, other_flesh, k_stretch, iterations,
                converged_iterations)

std::vector<DeformerSpec> other_attachments(const DeformerSpec& reference)
{
    std::vector<DeformerSpec> others;
    const auto add = [&](const char* label, FemAttachment attachment, double spring_factor, double core_radius, bool is_linear = false) {
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

struct DeformedShape {
    std::string deformer;
    pbs::Positions positions;                  // [m], #V x 3
    std::optional<pbs::Positions> tuned = {};  // with the settings of the training poses, where these are others
};

MemberRow member_row(const EnsembleCase& of, const EnsembleMember& member, const PosedReference& reference,
                     const analysis::MeshMetrics& metrics)
{
    MemberRow row;
    row.of = of.of;
    row.member = member;
    const NestedSolution& shown = reference.is_reached() ? reference.reference() : reference.solutions().front();
    row.outcome = reference.is_reached() ? "reached" : shown.finished ? "inverted" : "not_converged";
    row.masked_share_pct = reference.masked_share_pct();
    row.lowest_det_f = shown.lowest_det_f;
    row.inverted_tets = shown.inverted_tets;
    row.j_min = shown.j_min;
    row.worst_tet = shown.worst_tet;
    row.newton_steps = shown.newton_steps;
    row.projected = shown.projected;
    for (const NestedSolution& solution : reference.solutions()) row.solve_s += solution.seconds;
    if (!reference.is_reached()) return row;
    row.element_order = shown.element_order;
    if (shown.other_tets == 0) row.refinements = shown.refinements;
    row.volume_change_pct = metrics.measure(shown.positions).volume_change_pct;
    if (const analysis::ErrorNorms bound = reference.bound(); std::isfinite(bound.joint_pct)) {
        row.error_bound_pct = bound.joint_pct;
        row.error_bound_l2_pct = bound.l2_pct;
    }
    if (std::isfinite(reference.spread().joint_pct)) row.spread_pct = reference.spread().joint_pct;
    if (!reference.order()) return row;
    row.observed_order = reference.order()->observed;
    row.reliable = reference.order()->reliable;
    return row;
}

// The orders that a member of the family gives a pair of shapes, in the default and in other settings.
void add_orders(const EnsembleCase& of, const MemberRow& member, const PosedReference& reference, const DeformedShape& first,
                const DeformedShape& second, std::vector<PairOrderRow>& orders)
{
    for (const SettingsOf settings : {SettingsOf::defaults, SettingsOf::training_poses}) {
        const bool is_tuned = settings == SettingsOf::training_poses;
        if (is_tuned && !first.tuned && !second.tuned) continue;
        PairOrderRow& row = orders.emplace_back(PairOrderRow{
            .of = of.of, .member = member.member.name, .first = first.deformer, .second = second.deformer, .settings = settings});
        row.error_bound_pct = member.error_bound_pct;
        if (!reference.is_reached()) continue;
        const pbs::Positions &one = is_tuned && first.tuned ? *first.tuned : first.positions,
                             &other = is_tuned && second.tuned ? *second.tuned : second.positions;
        row.first_error_pct = reference.error_of(one).joint_pct;
        row.second_error_pct = reference.error_of(other).joint_pct;
        row.distance_pct = reference.distance(one, other).joint_pct;
        row.order = analysis::order_of({row.first_error_pct, row.second_error_pct, row.distance_pct, row.error_bound_pct});
    }
}

// orders: of one pair.
PairRow decided(const std::vector<PairOrderRow>& orders)
{
    PairRow row{.of = orders.front().of, .first = orders.front().first, .second = orders.front().second};
    std::vector<analysis::PairOrder> all;
    for (const PairOrderRow& one : orders) {
        all.push_back(one.order);
        if (one.settings != SettingsOf::defaults) continue;
        ++row.members;
        row.first_is_closer += one.order == analysis::PairOrder::first_is_closer;
        row.second_is_closer += one.order == analysis::PairOrder::second_is_closer;
        row.not_reached += !one.distance_pct;
        if (!one.distance_pct) continue;
        const double difference_pct = *one.second_error_pct - *one.first_error_pct;
        if (!row.difference_pct) row.difference_pct = difference_pct;
        row.largest_difference_pct = std::max(row.largest_difference_pct, std::abs(difference_pct));
    }
    row.decision = analysis::decide(all);
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
    Splitting(const EnsembleCase& of, const PosedCharacter& base, const PosedReference& reference)
        : of_(of), base_(base), reference_(reference), reference_shape_{reference.reference().positions, true}
    {
    }

    void add_to(EnsembleRecords& records) const
    {
        std::vector<Shape> others;
        for (const DeformerSpec& other : of_.other_flesh) others.push_back(base_.shapes(other).front());
        for (const double k_stretch : of_.k_stretch) {
            const pbs::PbsOptions whole = in_double(of_.pbs, k_stretch, of_.converged_iterations);
            std::vector<pbs::PbsOptions> all = {whole, in_double(of_.pbs, k_stretch, of_.converged_iterations / 2)};
            for (const int iterations : of_.iterations) all.push_back(in_double(of_.pbs, k_stretch, iterations));
            const std::vector<Shapes> shapes = base_.shapes(all);
            const Shape &converged = shapes[0].front(), &half_way = shapes[1].front();
            for (std::size_t n = 2; n < shapes.size(); ++n) {
                PartsRow row = parts_of(shapes[n].front(), converged);
                row.k_stretch = k_stretch;
                row.iterations = all[n].iterations;
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

    AttachmentRow attachment(double k_stretch, const Shape& converged, const DeformerSpec& flesh, const Shape& shape) const
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
    analysis::ErrorNorms distance(const Shape& one, const Shape& other) const
    {
        constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
        if (!one.finished || !other.finished) return {nothing, nothing, nothing};
        return reference_.distance(one.positions, other.positions);
    }

    const EnsembleCase& of_;
    const PosedCharacter& base_;
    const PosedReference& reference_;
    Shape reference_shape_;
};

std::string measure_and_record(const EnsembleCase& of, const std::string& folder)
{
    const EnsembleRecords records = measure_ensemble(of, solutions_of_run(folder));
    const auto path = [&](const char* name) { return analysis::path_in(folder, name); };
    table_of(member_columns, records.members).write(path("members.csv"));
    table_of(error_columns, records.errors).write(path("errors.csv"));
    table_of(pair_order_columns, records.orders).write(path("pair_orders.csv"));
    table_of(pair_columns, records.pairs).write(path("pairs.csv"));
    table_of(part_columns, records.parts).write(path("parts.csv"));
    table_of(attachment_columns, records.attachments).write(path("attachments.csv"));
    return records.breakdown;
}

StudyPlan plan(bool full)
{
    const nlohmann::json tuned = cases_document("ensemble").at("tuned");
    return plan_of_cases("ensemble", full, [&](const StudyCase& in_file, StudyPlan& plan) {
        EnsembleCase of{.of = in_file.key(), .scene = in_file.scene(), .frame = in_file.value<int>("frame")};
        of.members = family();
        of.flesh = reference_flesh(of.scene);
        of.pbs = spec_of(of.scene, "pbs");
        options_of<pbs::PbsOptions>(of.pbs).jiggle.reset();
        DeformerSpec elastic = of.flesh;
        elastic.name = elastic.label = "fem_linear";
        auto& small_strain = options_of<FemOptions>(elastic);
        small_strain.model = reference_fem::Model::linear;
        small_strain.most_newton_steps = 0;
        for (const char* kind : {"lbs", "dqs", "delta_mush", "xpbd"}) of.deformers.push_back(default_spec(kind));
        of.deformers.insert(of.deformers.end(), {of.pbs, elastic});
        for (const nlohmann::json& one : tuned) {
            std::vector<std::string> overrides = one.at("keys");
            overrides.push_back("deformers.use=[\"" + one.at("deformer").get<std::string>() + "\"]");
            overrides.push_back("reference.name=");
            of.tuned.push_back(in_file.scene(overrides).deformers.front());
            if (of.tuned.back().kind == of.pbs.kind) options_of<pbs::PbsOptions>(of.tuned.back()).jiggle.reset();
        }
        if (in_file.has("parts")) {
            of.other_flesh = other_attachments(of.flesh);
            of.k_stretch = {0.05, 0.2, 0.9};
            of.iterations = {1, 4, 24, 96, 384};
            of.converged_iterations = full ? 32000 : 8000;
        }
        plan.runs.push_back(work_run(in_file.name, of, in_file.cost_s, measure_and_record));
    });
}

bool conclude(const FinishedRuns& finished)
{
    if (finished.none()) return false;
    finished.write("pairs.csv", pair_columns, finished.rows(pair_columns, "pairs.csv"));
    finished.write("members.csv", member_columns, finished.rows(member_columns, "members.csv"));
    return true;
}

}  // namespace

EnsembleRecords measure_ensemble(const EnsembleCase& of, const std::string& solutions)
{
    const PosedCharacter body(of.scene, {of.frame});
    const pbs::TetMesh& mesh = body.character().mesh;
    const analysis::MeshMetrics metrics(mesh.rest, mesh.tets);
    const analysis::SkinErrorMetrics skin_metrics(mesh.rest, mesh.tets);
    EnsembleRecords records;
    std::vector<DeformedShape> shapes;
    for (const DeformerSpec& spec : of.deformers) {
        const Shape shape = body.shapes(spec).front();
        if (shape.finished)
            shapes.push_back({spec.label, shape.positions});
        else
            records.breakdown += spec.label + " did not finish. ";
    }
    for (const DeformerSpec& spec : of.tuned) {
        const Shape shape = body.shapes(spec).front();
        if (const auto own = std::ranges::find(shapes, spec.label, &DeformedShape::deformer); own != shapes.end() && shape.finished)
            own->tuned = shape.positions;
        else
            records.breakdown += spec.label + " with the settings of the training poses did not finish. ";
    }
    std::map<std::pair<std::size_t, std::size_t>, std::vector<PairOrderRow>> orders;  // of each pair of shapes, one per member
    std::map<double, PosedReference> firsts;  // with each Poisson's ratio, whose bound holds for flesh that is held in other ways too
    for (const EnsembleMember& member : of.members) {
        const auto like = firsts.find(member.poisson);
        PosedReference solved(body.character(), flesh_of(of.flesh, member), body.pose(0), of.scene.motion.time_step_s,
                              like == firsts.end() ? of.effort : ReferenceEffort::own_tets, solutions,
                              firsts.empty() ? nullptr : &firsts.begin()->second);
        if (like != firsts.end()) solved.take_bound_of(like->second);
        const PosedReference& reference = like == firsts.end() ? firsts.emplace(member.poisson, solved).first->second : solved;
        records.members.push_back(member_row(of, member, reference, metrics));
        for (std::size_t a = 0; a < shapes.size(); ++a)
            for (std::size_t b = a + 1; b < shapes.size(); ++b)
                add_orders(of, records.members.back(), reference, shapes[a], shapes[b], orders[{a, b}]);
        if (!reference.is_reached()) continue;
        for (const DeformedShape& shape : shapes) {
            const analysis::ErrorNorms error = reference.error_of(shape.positions);
            records.errors.push_back({of.of, member.name, shape.deformer, error.joint_pct, error.l2_pct,
                                      reference.error_on_whole_body(shape.positions).joint_pct,
                                      metrics.measure(shape.positions).volume_change_pct,
                                      skin_metrics.measure(shape.positions, reference.reference().positions, reference.masked())});
        }
        if (records.members.size() == 1 && !of.k_stretch.empty()) Splitting(of, body, reference).add_to(records);
    }
    for (const auto& [pair, of_pair] : orders) {
        records.pairs.push_back(decided(of_pair));
        records.orders.insert(records.orders.end(), of_pair.begin(), of_pair.end());
    }
    return records;
}

Study ensemble_study()
{
    return {"ensemble", plan, full_in_short, conclude};
}

}  // namespace experiments
