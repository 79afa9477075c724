#include "experiments/studies/ensemble/ensemble.hpp"

#include "experiments/deformers/registry.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/shared/posed_character.hpp"

#include "analysis/metrics/frame_metrics.hpp"

#include <algorithm>

namespace experiments {
namespace {

using analysis::CaseKey;
using analysis::Columns;
using analysis::within;

struct DeformedShape {
    std::string deformer;
    pbs::Positions positions;  // [m], #V x 3
};

// Those that are finite; the others are named in `breakdown`.
std::vector<DeformedShape> deformed(const EnsembleCase& of, const pbs::Character& character, const pbs::Motion& motion,
                                    const pbs::Pose& pose, std::string& breakdown)
{
    std::vector<DeformedShape> shapes;
    for (const DeformerSpec& spec : of.deformers) {
        const std::unique_ptr<Deformer> deformer = make_deformer(spec);
        deformer->reset(character);
        if (deformer->advance(pose, motion.time_step_s).outcome == pbs::Outcome::finished)
            shapes.push_back({spec.label, deformer->positions()});
        else
            breakdown += spec.label + " did not finish. ";
    }
    return shapes;
}

MemberRow member_row(const EnsembleCase& of, const EnsembleMember& member, const PosedReference& reference,
                     const analysis::MeshMetrics& metrics)
{
    MemberRow row;
    row.of = of.of;
    row.member = member;
    const NestedSolution& finest = reference.solutions().front();
    row.outcome = reference.is_reached() ? "reached" : finest.finished ? "inverted" : "not_converged";
    row.masked_share_pct = reference.masked_share_pct();
    row.lowest_det_f = finest.lowest_det_f;
    row.inverted_tets = finest.inverted_tets;
    row.j_min = finest.j_min;
    row.worst_tet = finest.worst_tet;
    row.newton_steps = finest.newton_steps;
    row.projected = finest.projected;
    for (const NestedSolution& solution : reference.solutions()) row.solve_s += solution.seconds;
    if (!reference.is_reached()) return row;
    row.element_order = reference.reference().element_order;
    row.refinements = reference.reference().refinements;
    row.volume_change_pct = metrics.measure(reference.reference().positions).volume_change_pct;
    if (!reference.order()) return row;
    row.error_bound_pct = reference.bound().joint_pct;
    row.error_bound_l2_pct = reference.bound().l2_pct;
    row.observed_order = reference.order()->observed;
    row.reliable = reference.order()->reliable;
    return row;
}

// Collects, for each pair of shapes, how each reference of the family orders the pair.
class Ordering {
public:
    explicit Ordering(const std::vector<DeformedShape>& shapes) : shapes_(shapes), orders_(shapes.size() * shapes.size()) {}

    void add(const PosedReference& reference)
    {
        for (std::size_t a = 0; a < shapes_.size(); ++a)
            for (std::size_t b = a + 1; b < shapes_.size(); ++b)
                orders_[place(a, b)].push_back(
                    reference.is_reached()
                        ? analysis::order_of(
                              {reference.error_of(shapes_[a].positions).joint_pct, reference.error_of(shapes_[b].positions).joint_pct,
                               reference.distance(shapes_[a].positions, shapes_[b].positions).joint_pct, reference.bound().joint_pct})
                        : analysis::PairOrder::undecided);
        if (!reference.is_reached()) {
            ++not_reached_;
            return;
        }
        errors_pct_.emplace_back();
        for (const DeformedShape& shape : shapes_) errors_pct_.back().push_back(reference.error_of(shape.positions).joint_pct);
    }

    std::vector<PairRow> pairs(const CaseKey& of) const
    {
        std::vector<PairRow> rows;
        for (std::size_t a = 0; a < shapes_.size(); ++a)
            for (std::size_t b = a + 1; b < shapes_.size(); ++b) {
                const std::vector<analysis::PairOrder>& orders = orders_[place(a, b)];
                PairRow row{.of = of, .first = shapes_[a].deformer, .second = shapes_[b].deformer};
                if (!errors_pct_.empty()) row.difference_pct = errors_pct_.front()[b] - errors_pct_.front()[a];
                for (const std::vector<double>& errors : errors_pct_)
                    row.largest_difference_pct = std::max(row.largest_difference_pct, std::abs(errors[b] - errors[a]));
                row.members = static_cast<int>(orders.size());
                row.not_reached = not_reached_;
                row.first_is_closer = static_cast<int>(std::ranges::count(orders, analysis::PairOrder::first_is_closer));
                row.second_is_closer = static_cast<int>(std::ranges::count(orders, analysis::PairOrder::second_is_closer));
                row.decision = analysis::decide(orders);
                rows.push_back(row);
            }
        return rows;
    }

private:
    std::size_t place(std::size_t a, std::size_t b) const { return a * shapes_.size() + b; }

    const std::vector<DeformedShape>& shapes_;
    std::vector<std::vector<analysis::PairOrder>> orders_;  // of each pair, one per member
    std::vector<std::vector<double>> errors_pct_;           // of the shapes, one list per member that was reached
    int not_reached_ = 0;                                   // members
};

}  // namespace

const Columns<MemberRow> member_columns =
    within(&MemberRow::of, pose_columns()) + within(&MemberRow::member, family_member_columns()) +
    Columns<MemberRow>{
        {"outcome", &MemberRow::outcome, "", "reached; inverted: det F <= 0 somewhere in each solution; not_converged"},
        {"element_order", &MemberRow::element_order, "", "of the finest solution with det F > 0, which is the reference"},
        {"refinements", &MemberRow::refinements, "", "how often its tets are cut into eight"},
        {"error_bound_pct", &MemberRow::error_bound_pct, "%", "bound of its distance from the limit, at the joints outside the mask"},
        {"error_bound_l2_pct", &MemberRow::error_bound_l2_pct, "%", "bound of its distance from the limit, outside the mask"},
        {"observed_order", &MemberRow::observed_order, "", "of convergence of linear elements, with the finest solution as the limit"},
        {"reliable", &MemberRow::reliable, "", "the observed order is credible, and the safety factor 1.25 instead of 3"},
        {"masked_share_pct", &MemberRow::masked_share_pct, "%", "share of the volume that is left out because the body overlaps itself"},
        {"volume_change_pct", &MemberRow::volume_change_pct, "%", "of the reference"},
        {"lowest_det_f", &MemberRow::lowest_det_f, "", "of the finest solution, at the quadrature points of its elements"},
        {"inverted", &MemberRow::inverted_tets, "", "the body's tets that it inverts by their vertices alone; they are left out"},
        {"j_min", &MemberRow::j_min, "", "the smallest volume ratio of such a tet"},
        {"worst_tet", &MemberRow::worst_tet, "", "that tet"},
        {"newton_steps", &MemberRow::newton_steps, "", "of the finest solution, from the one with fewer nodes"},
        {"projected", &MemberRow::projected, "",
         "those with a projected Hessian, as it was not positive definite or the step before met negative curvature"},
        {"solve_s", &MemberRow::solve_s, "s", "wall time of all solutions"}};

const Columns<ErrorRow> error_columns =
    within(&ErrorRow::of, pose_columns()) +
    Columns<ErrorRow>{{"member", &ErrorRow::member, "", "name of the member"},
                      {"deformer", &ErrorRow::deformer, "", "name of the deformer"},
                      {"error_joint_pct", &ErrorRow::error_joint_pct, "%", "error over the blended vertices outside the mask"},
                      {"error_l2_pct", &ErrorRow::error_l2_pct, "%", "error over all vertices outside the mask"},
                      {"whole_joint_pct", &ErrorRow::whole_joint_pct, "%", "error over all blended vertices"},
                      {"volume_change_pct", &ErrorRow::volume_change_pct, "%", "signed change of the volume"}};

const Columns<PairRow> pair_columns =
    within(&PairRow::of, pose_columns()) +
    Columns<PairRow>{
        {"first", &PairRow::first, "", "name of a deformer"},
        {"second", &PairRow::second, "", "name of the other one"},
        {"difference_pct", &PairRow::difference_pct, "%", "error of the second minus that of the first, against the first member reached"},
        {"largest_difference_pct", &PairRow::largest_difference_pct, "%", "the largest difference of any member, without its sign"},
        {"members", &PairRow::members, "", "number of members"},
        {"not_reached", &PairRow::not_reached, "", "members that were not reached, which decide nothing"},
        {"first_is_closer", &PairRow::first_is_closer, "", "members for which the first is closer by more than their own error allows"},
        {"second_is_closer", &PairRow::second_is_closer, "", "members for which the second is"},
        {"decision", &PairRow::decision, "", "decided, reference_error (a member does not decide or was not reached) or models_disagree"}};

nlohmann::json to_json(const EnsembleCase& of)
{
    static const auto fields = OptionFields<EnsembleCase>("ensemble")
                                   .record("of", &EnsembleCase::of)
                                   .record("scene", &EnsembleCase::scene)
                                   .record("frame", &EnsembleCase::frame)
                                   .record("flesh", &EnsembleCase::flesh)
                                   .record("members", &EnsembleCase::members)
                                   .record("deformers", &EnsembleCase::deformers)
                                   .complete();
    return fields.json(of);
}

EnsembleRecords measure_ensemble(const EnsembleCase& of)
{
    const pbs::Character character = pbs::make_character(of.scene.character);
    const pbs::Motion motion = make_motion(of.scene.motion, character.skeleton, of.scene.file);
    const pbs::Pose& pose = motion.steps.at(static_cast<std::size_t>(of.frame) * motion.steps_per_frame);
    const analysis::MeshMetrics metrics(character.mesh.rest, character.mesh.tets);
    EnsembleRecords records;
    const std::vector<DeformedShape> shapes = deformed(of, character, motion, pose, records.breakdown);
    Ordering ordering(shapes);
    for (const EnsembleMember& member : of.members) {
        const PosedReference reference(character, flesh_of(of.flesh, member), pose, motion.time_step_s);
        records.members.push_back(member_row(of, member, reference, metrics));
        ordering.add(reference);
        if (!reference.is_reached()) continue;
        for (const DeformedShape& shape : shapes) {
            const analysis::ErrorNorms error = reference.error_of(shape.positions);
            records.errors.push_back({of.of, member.name, shape.deformer, error.joint_pct, error.l2_pct,
                                      reference.error_on_whole_body(shape.positions).joint_pct,
                                      metrics.measure(shape.positions).volume_change_pct});
        }
    }
    records.pairs = ordering.pairs(of.of);
    return records;
}

}  // namespace experiments
