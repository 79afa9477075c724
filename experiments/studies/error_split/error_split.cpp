#include "experiments/studies/error_split/error_split.hpp"

#include "analysis/grid_convergence.hpp"
#include "experiments/deformers/fem/fem_option_names.hpp"
#include "experiments/deformers/pbs/pbs_option_names.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/run/reference_error_bar.hpp"
#include "experiments/settings/option_fields.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {

const analysis::Columns<ErrorParts> part_columns = {
    {"scene", &ErrorParts::scene, "", "name of the scene"},
    {"frame", &ErrorParts::frame, "", "frame of the scene's motion, from 0"},
    {"angle_deg", &ErrorParts::angle_deg, "deg", "angle of a sweep; nan for clips"},
    {"k_stretch", &ErrorParts::k_stretch, "", "stiffness of the stretch constraints"},
    {"iterations", &ErrorParts::iterations, "", "iterations of PBS"},
    {"error_joint_pct", &ErrorParts::error_joint_pct, "%", "distance of PBS from the reference, at the joints"},
    {"solver_pct", &ErrorParts::solver_pct, "%", "distance of PBS from its own converged shape"},
    {"model_pct", &ErrorParts::model_pct, "%", "distance of PBS's converged shape from the reference"},
    {"discretisation_pct", &ErrorParts::discretisation_pct, "%", "bound of the reference's distance from its limit on ever finer tets"},
    {"discretisation_of", &ErrorParts::discretisation_of, "", "what that bound was computed from: the truth or its linear twin"},
    {"not_converged_pct", &ErrorParts::not_converged_pct, "%", "distance of PBS's converged shape from that after half of the iterations"},
    {"pbs_refinement_pct", &ErrorParts::pbs_refinement_pct, "%", "distance of PBS's converged shape from that on refined tets"},
    {"error_l2_pct", &ErrorParts::error_l2_pct, "%", "distance of PBS from the reference, over all vertices"},
    {"error_linf_m", &ErrorParts::error_linf_m, "m", "largest distance of a vertex of PBS from the reference"},
    {"truth_self_intersects", &ErrorParts::truth_self_intersects, "", "boundary triangles of the reference intersect"}};

const analysis::Columns<AttachmentShare> attachment_columns = {
    {"scene", &AttachmentShare::scene, "", "name of the scene"},
    {"frame", &AttachmentShare::frame, "", "frame of the scene's motion, from 0"},
    {"angle_deg", &AttachmentShare::angle_deg, "deg", "angle of a sweep; nan for clips"},
    {"reference", &AttachmentShare::reference, "", "label of the reference"},
    {"attachment", &AttachmentShare::attachment, "", "how its flesh is held by the bones"},
    {"core_radius", &AttachmentShare::core_radius, "", "radius of the bones over the limb's"},
    {"difference_pct", &AttachmentShare::difference_pct, "%", "its distance from the linear twin, at the joints"},
    {"k_stretch", &AttachmentShare::k_stretch, "", "stiffness of the stretch constraints of PBS"},
    {"model_pct", &AttachmentShare::model_pct, "%", "distance of PBS's converged shape from this reference"},
    {"finished", &AttachmentShare::finished, "", "the reference reached its pose"},
    {"self_intersects", &AttachmentShare::self_intersects, "", "its boundary triangles intersect"}};

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

struct NamedReference {
    DeformerSpec spec;
    Shapes shapes;
};

// The references of a case, each in every pose.
struct References {
    Shapes truth, twin, twin_refined, truth_refined;  // truth_refined: in the first poses only
    std::vector<NamedReference> variants;             // the twin with other attachments
};

References solve_references(const ErrorSplitCase& of, const PosedCharacter& base, const PosedCharacter& fine)
{
    References references{base.shapes(of.truth), base.shapes(of.twin), fine.shapes(of.twin), {}, {}};
    if (of.refined_poses > 0) references.truth_refined = fine.shapes(of.truth, of.refined_poses);
    for (const double core_radius : of.core_radii) {
        DeformerSpec other = of.twin;
        options_of<FemOptions>(other).core_radius = core_radius;
        other.label = fmt::format("{}_core_{}", of.twin.label, core_radius);
        references.variants.push_back({other, base.shapes(other)});
    }
    DeformerSpec bound = of.twin;
    options_of<FemOptions>(bound).attachment = FemAttachment::bind;
    bound.label = of.twin.label + "_bind";
    references.variants.push_back({bound, base.shapes(bound)});
    return references;
}

// A bound of the reference's distance from its limit, as error_joint_pct, from two grids and the order that reference_error_bar.hpp
// assumes. Where the reference itself is not refined, the bound is that of its twin on the refined mesh, which has the same nodes as the
// reference.
double discretisation_pct(const PosedCharacter& base, const References& references, std::size_t pose, double order)
{
    constexpr double halved = 2.0;
    if (pose >= references.truth_refined.size())
        return analysis::two_fields(base.distance(references.twin_refined[pose], references.twin[pose]).joint_pct, halved, order).bounds[0];
    return analysis::two_fields(base.distance(references.truth_refined[pose], references.truth[pose]).joint_pct, halved, order).bounds[1];
}

// PBS with its constraints converged, and after half of the iterations, which shows how far it still moves.
struct Converged {
    Shapes shapes, half_way, refined;
};

Converged converge(const ErrorSplitCase& of, double k_stretch, const PosedCharacter& base, const PosedCharacter& fine)
{
    const pbs::PbsOptions whole = in_double(of.pbs, k_stretch, of.converged_iterations),
                          half = in_double(of.pbs, k_stretch, of.converged_iterations / 2);
    std::vector<Shapes> shapes = base.shapes({whole, half});
    return {std::move(shapes[0]), std::move(shapes[1]), fine.shapes({whole}).front()};
}

class Splitting {
public:
    explicit Splitting(const ErrorSplitCase& of)
        : of_(of), base_(of.scene, of.frames), fine_(refined(of.scene), of.frames), references_(solve_references(of, base_, fine_))
    {
    }

    ErrorSplit split()
    {
        for (std::size_t pose = 0; pose < of_.frames.size(); ++pose)
            if (!references_.truth[pose].finished) split_.breakdown += fmt::format("{} in frame {}. ", of_.truth.label, of_.frames[pose]);
        for (const double k_stretch : of_.k_stretch) {
            const Converged converged = converge(of_, k_stretch, base_, fine_);
            std::vector<pbs::PbsOptions> options;
            for (const int iterations : of_.iterations) options.push_back(in_double(of_.pbs, k_stretch, iterations));
            const std::vector<Shapes> stopped = base_.shapes(options);
            for (std::size_t n = 0; n < stopped.size(); ++n) add_parts(options[n], stopped[n], converged);
            add_attachments(k_stretch, converged);
        }
        return split_;
    }

private:
    void add_parts(const pbs::PbsOptions& options, const Shapes& shapes, const Converged& converged)
    {
        for (std::size_t pose = 0; pose < shapes.size(); ++pose) {
            const Shape& truth = references_.truth[pose];
            const analysis::ErrorNorms total = base_.distance(shapes[pose], truth);
            split_.parts.push_back(
                {of_.scene.name, of_.frames[pose], base_.angle_deg(pose), options.k_stretch, options.iterations, total.joint_pct,
                 base_.distance(shapes[pose], converged.shapes[pose]).joint_pct, base_.distance(converged.shapes[pose], truth).joint_pct,
                 discretisation_pct(base_, references_, pose, convergence_order(options_of<FemOptions>(of_.truth).attachment)),
                 pose >= references_.truth_refined.size() ? "twin" : "truth",
                 base_.distance(converged.shapes[pose], converged.half_way[pose]).joint_pct,
                 base_.distance(converged.shapes[pose], converged.refined[pose]).joint_pct, total.l2_pct, total.linf_m,
                 truth.self_intersects});
        }
    }

    void add_attachments(double k_stretch, const Converged& converged)
    {
        add_attachment(k_stretch, converged, of_.twin, references_.twin);
        for (const NamedReference& variant : references_.variants) add_attachment(k_stretch, converged, variant.spec, variant.shapes);
    }

    void add_attachment(double k_stretch, const Converged& converged, const DeformerSpec& spec, const Shapes& shapes)
    {
        const auto& fem = options_of<FemOptions>(spec);
        for (std::size_t pose = 0; pose < shapes.size(); ++pose)
            split_.attachments.push_back({of_.scene.name, of_.frames[pose], base_.angle_deg(pose), spec.label, name_of(fem.attachment),
                                          core_radius_of(fem), base_.distance(shapes[pose], references_.twin[pose]).joint_pct, k_stretch,
                                          base_.distance(converged.shapes[pose], shapes[pose]).joint_pct, shapes[pose].finished,
                                          shapes[pose].self_intersects});
    }

    const ErrorSplitCase& of_;
    PosedCharacter base_, fine_;
    References references_;
    ErrorSplit split_;
};

}  // namespace

nlohmann::json to_json(const ErrorSplitCase& of)
{
    static const auto fields = OptionFields<ErrorSplitCase>("error_split")
                                   .record("scene", &ErrorSplitCase::scene)
                                   .record("frames", &ErrorSplitCase::frames)
                                   .record("pbs", &ErrorSplitCase::pbs)
                                   .record("truth", &ErrorSplitCase::truth)
                                   .record("twin", &ErrorSplitCase::twin)
                                   .record("k_stretch", &ErrorSplitCase::k_stretch)
                                   .record("iterations", &ErrorSplitCase::iterations)
                                   .record("converged_iterations", &ErrorSplitCase::converged_iterations)
                                   .record("core_radii", &ErrorSplitCase::core_radii)
                                   .record("refined_poses", &ErrorSplitCase::refined_poses)
                                   .complete();
    return fields.json(of);
}

ErrorSplit split_error(const ErrorSplitCase& of)
{
    return Splitting(of).split();
}

}  // namespace experiments
