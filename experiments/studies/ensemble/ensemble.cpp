#include "experiments/studies/ensemble/ensemble.hpp"

#include "analysis/frame_metrics.hpp"
#include "experiments/deformers/fem/fem_option_names.hpp"
#include "experiments/deformers/pbs/pbs_option_names.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/scene/motion_case.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/shared/pose_columns.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "pbs/geometry/tet_volume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

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

const analysis::Columns<ErrorParts> part_columns = {
    {"scene", &ErrorParts::scene, "", "name of the scene"},
    {"frame", &ErrorParts::frame, "", "frame of the scene's motion, from 0"},
    {"angle_deg", &ErrorParts::angle_deg, "deg", "angle of a sweep; nan for clips"},
    {"k_stretch", &ErrorParts::k_stretch, "", "stiffness of the stretch constraints"},
    {"iterations", &ErrorParts::iterations, "", "iterations of PBS"},
    {"error_joint_pct", &ErrorParts::error_joint_pct, "%", "distance of PBS from the reference, at the joints outside the mask"},
    {"solver_pct", &ErrorParts::solver_pct, "%", "distance of PBS from its own converged shape"},
    {"model_pct", &ErrorParts::model_pct, "%", "distance of PBS's converged shape from the reference"},
    {"discretisation_pct", &ErrorParts::discretisation_pct, "%",
     "bound of the reference's distance from its limit on ever finer tets; nan: a nested solution is missing"},
    {"not_converged_pct", &ErrorParts::not_converged_pct, "%", "distance of PBS's converged shape from that after half of the iterations"},
    {"pbs_refinement_pct", &ErrorParts::pbs_refinement_pct, "%", "distance of PBS's converged shape from that on refined tets"},
    {"error_l2_pct", &ErrorParts::error_l2_pct, "%", "distance of PBS from the reference, over all vertices outside the mask"},
    {"error_linf_m", &ErrorParts::error_linf_m, "m", "largest distance of a vertex of PBS from the reference outside the mask"},
    {"whole_joint_pct", &ErrorParts::whole_joint_pct, "%", "distance of PBS from the reference at the joints of the whole body"},
    {"masked_share_pct", &ErrorParts::masked_share_pct, "%", "share of the volume that is left out because the reference overlaps itself"},
    {"observed_order", &ErrorParts::observed_order, "", "of convergence of the reference's linear elements; empty: not known"},
    {"order_is_reliable", &ErrorParts::order_is_reliable, "",
     "the order is credible, and the bound has the safety factor 1.25 instead of 3"}};

const analysis::Columns<AttachmentShare> attachment_columns = {
    {"scene", &AttachmentShare::scene, "", "name of the scene"},
    {"frame", &AttachmentShare::frame, "", "frame of the scene's motion, from 0"},
    {"angle_deg", &AttachmentShare::angle_deg, "deg", "angle of a sweep; nan for clips"},
    {"reference", &AttachmentShare::reference, "", "label of the flesh; the reference's own comes first"},
    {"model", &AttachmentShare::model, "", "its law"},
    {"attachment", &AttachmentShare::attachment, "", "how it is held by the bones"},
    {"spring_factor", &AttachmentShare::spring_factor, "", "q of its springs or of the bind constraint; empty: prescribed nodes have none"},
    {"core_radius", &AttachmentShare::core_radius, "",
     "radius of the bones' capsules over the limb's; empty: the bind constraint has none"},
    {"difference_pct", &AttachmentShare::difference_pct, "%", "its distance from the reference, at the joints outside the mask"},
    {"k_stretch", &AttachmentShare::k_stretch, "", "stiffness of the stretch constraints of PBS"},
    {"model_pct", &AttachmentShare::model_pct, "%", "distance of PBS's converged shape from this flesh"},
    {"finished", &AttachmentShare::finished, "", "the flesh reached its pose"}};

namespace {

pbs::PbsOptions in_double(const DeformerSpec& spec, double k_stretch, int iterations)
{
    pbs::PbsOptions options = options_of<pbs::PbsOptions>(spec);
    options.precision = pbs::Precision::f64;
    options.k_stretch = k_stretch;
    options.iterations = iterations;
    options.jiggle.reset();
    return options;
}

Scene refined(Scene scene)
{
    ++scene.character.refinements;
    return scene;
}

// PBS with its constraints converged, and after half of the iterations, which shows how far it still moves.
struct Converged {
    Shapes shapes, half_way, refined;
};

class Splitting {
public:
    explicit Splitting(const ErrorSplitCase& of) : of_(of), base_(of.scene, of.frames), fine_(refined(of.scene), of.frames)
    {
        references_.reserve(of.frames.size());
        for (std::size_t pose = 0; pose < of.frames.size(); ++pose) {
            const PosedReference& reference =
                references_.emplace_back(base_.character(), of.reference, base_.pose(pose), of.scene.motion.time_step_s);
            if (!reference.is_reached())
                split_.breakdown +=
                    fmt::format("{} in frame {}: not reached, {}. ", of.reference.label, of.frames[pose], reference.why_not_reached());
        }
        for (const DeformerSpec& other : of.others) others_.push_back(base_.shapes(other));
    }

    ErrorSplit split()
    {
        for (const double k_stretch : of_.k_stretch) {
            const Converged converged = converge(k_stretch);
            std::vector<pbs::PbsOptions> options;
            for (const int iterations : of_.iterations) options.push_back(in_double(of_.pbs, k_stretch, iterations));
            const std::vector<Shapes> stopped = base_.shapes(options);
            for (std::size_t pose = 0; pose < references_.size(); ++pose) {
                if (!references_[pose].is_reached()) continue;
                for (std::size_t n = 0; n < stopped.size(); ++n) add_parts(options[n], pose, stopped[n][pose], converged);
                add_attachments(k_stretch, pose, converged.shapes[pose]);
            }
        }
        return split_;
    }

private:
    Converged converge(double k_stretch) const
    {
        const pbs::PbsOptions whole = in_double(of_.pbs, k_stretch, of_.converged_iterations),
                              half = in_double(of_.pbs, k_stretch, of_.converged_iterations / 2);
        std::vector<Shapes> shapes = base_.shapes({whole, half});
        return {std::move(shapes[0]), std::move(shapes[1]), fine_.shapes({whole}).front()};
    }

    void add_parts(const pbs::PbsOptions& options, std::size_t pose, const Shape& shape, const Converged& converged)
    {
        const PosedReference& reference = references_[pose];
        const Shape& limit = converged.shapes[pose];
        const analysis::ErrorNorms total = distance(pose, shape, reference_shape(pose));
        ErrorParts parts;
        parts.scene = of_.scene.name;
        parts.frame = of_.frames[pose];
        parts.angle_deg = base_.angle_deg(pose);
        parts.k_stretch = options.k_stretch;
        parts.iterations = options.iterations;
        parts.error_joint_pct = total.joint_pct;
        parts.solver_pct = distance(pose, shape, limit).joint_pct;
        parts.model_pct = distance(pose, limit, reference_shape(pose)).joint_pct;
        parts.discretisation_pct = reference.bound().joint_pct;
        parts.not_converged_pct = distance(pose, limit, converged.half_way[pose]).joint_pct;
        parts.pbs_refinement_pct = distance(pose, limit, converged.refined[pose]).joint_pct;
        parts.error_l2_pct = total.l2_pct;
        parts.error_linf_m = total.linf_m;
        parts.whole_joint_pct = base_.distance(shape, reference_shape(pose)).joint_pct;
        parts.masked_share_pct = reference.masked_share_pct();
        if (reference.order()) {
            parts.observed_order = reference.order()->observed;
            parts.order_is_reliable = reference.order()->reliable;
        }
        split_.parts.push_back(parts);
    }

    void add_attachments(double k_stretch, std::size_t pose, const Shape& converged)
    {
        add_attachment(k_stretch, pose, converged, of_.reference, reference_shape(pose));
        for (std::size_t other = 0; other < others_.size(); ++other)
            add_attachment(k_stretch, pose, converged, of_.others[other], others_[other][pose]);
    }

    void add_attachment(double k_stretch, std::size_t pose, const Shape& converged, const DeformerSpec& flesh, const Shape& shape)
    {
        const auto& fem = options_of<FemOptions>(flesh);
        AttachmentShare share;
        share.scene = of_.scene.name;
        share.frame = of_.frames[pose];
        share.angle_deg = base_.angle_deg(pose);
        share.reference = flesh.label;
        share.model = name_of(fem.model);
        share.attachment = name_of(fem.attachment);
        if (has_spring_factor(fem.attachment)) share.spring_factor = spring_factor_of(fem);
        if (has_capsules(fem.attachment)) share.core_radius = core_radius_of(fem);
        share.difference_pct = distance(pose, shape, reference_shape(pose)).joint_pct;
        share.k_stretch = k_stretch;
        share.model_pct = distance(pose, converged, shape).joint_pct;
        share.finished = shape.finished;
        split_.attachments.push_back(share);
    }

    Shape reference_shape(std::size_t pose) const { return {references_[pose].reference().positions, true}; }

    // Outside the mask of the pose. Not a number where one of them did not finish.
    analysis::ErrorNorms distance(std::size_t pose, const Shape& one, const Shape& other) const
    {
        constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
        if (!one.finished || !other.finished) return {nothing, nothing, nothing};
        const Eigen::Index vertices = base_.character().mesh.rest.rows();
        return references_[pose].distance(one.positions.topRows(vertices), other.positions.topRows(vertices));
    }

    const ErrorSplitCase& of_;
    PosedCharacter base_, fine_;
    std::vector<PosedReference> references_;  // one per pose
    std::vector<Shapes> others_;              // one per deformer of others, in each pose
    ErrorSplit split_;
};

}  // namespace

nlohmann::json to_json(const ErrorSplitCase& of)
{
    static const auto fields = OptionFields<ErrorSplitCase>("error_split")
                                   .record("scene", &ErrorSplitCase::scene)
                                   .record("frames", &ErrorSplitCase::frames)
                                   .record("pbs", &ErrorSplitCase::pbs)
                                   .record("reference", &ErrorSplitCase::reference)
                                   .record("others", &ErrorSplitCase::others)
                                   .record("k_stretch", &ErrorSplitCase::k_stretch)
                                   .record("iterations", &ErrorSplitCase::iterations)
                                   .record("converged_iterations", &ErrorSplitCase::converged_iterations)
                                   .complete();
    return fields.json(of);
}

std::vector<DeformerSpec> other_attachments(const DeformerSpec& reference)
{
    FemOptions flesh = options_of<FemOptions>(reference);
    flesh.element_order = 2;
    flesh.nested_start = true;
    flesh.attachment = FemAttachment::smooth;
    FemOptions stiffer = flesh, thinner = flesh, embedded = flesh, bind = flesh;
    stiffer.spring_factor = 100.0;
    thinner.core_radius = 0.5;
    embedded.attachment = FemAttachment::embedded;
    embedded.spring_factor = embedded.core_radius = 0.0;  // the attachment's own
    bind.attachment = FemAttachment::bind;
    bind.spring_factor = bind.core_radius = 0.0;
    FemOptions linear = flesh, linear_embedded = embedded;
    for (FemOptions* small_strain : {&linear, &linear_embedded}) {
        small_strain->model = reference_fem::Model::linear;
        small_strain->nested_start = false;
        small_strain->most_newton_steps = 0;
    }
    std::vector<DeformerSpec> others;
    for (const auto& [label, options] : std::initializer_list<std::pair<const char*, FemOptions>>{{"smooth_q_100", stiffer},
                                                                                                  {"smooth_core_0.5", thinner},
                                                                                                  {"embedded", embedded},
                                                                                                  {"bind", bind},
                                                                                                  {"linear_smooth", linear},
                                                                                                  {"linear_embedded", linear_embedded}}) {
        others.push_back(reference);
        others.back().name = others.back().label = label;
        others.back().options = options;
    }
    return others;
}

ErrorSplit split_error(const ErrorSplitCase& of)
{
    return Splitting(of).split();
}

}  // namespace experiments
