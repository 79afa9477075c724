#include "experiments/studies/error_split/error_split.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/settings/option_fields.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <fmt/format.h>

#include <limits>

namespace experiments {

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
