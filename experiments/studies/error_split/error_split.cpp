#include "experiments/studies/error_split/error_split.hpp"

#include "analysis/grid_convergence.hpp"
#include "experiments/deformers/fem/fem_option_names.hpp"
#include "experiments/deformers/pbs/pbs_option_names.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

const std::vector<std::string> part_columns = {"scene",
                                               "frame",
                                               "angle_deg",
                                               "k_stretch",
                                               "iterations",
                                               "error_joint_pct",
                                               "solver_pct",
                                               "model_pct",
                                               "discretisation_pct",
                                               "discretisation_of",
                                               "not_converged_pct",
                                               "pbs_refinement_pct",
                                               "error_l2_pct",
                                               "error_linf_m",
                                               "truth_self_intersects"};
const std::vector<std::string> attachment_columns = {"scene",      "frame",       "angle_deg",      "reference",
                                                     "attachment", "core_radius", "difference_pct", "k_stretch",
                                                     "model_pct",  "finished",    "self_intersects"};

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
    Shapes truth, twin, twin_refined, truth_refined;  // the last of the first poses only
    std::vector<NamedReference> variants;             // of the twin: other attachments
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

// A bound of the truth's distance from its limit, in error_joint_pct: of two grids, with the order that reference_error_bar.hpp presumes.
// Where the truth itself is not refined, the bound is that of its twin on the refined mesh, which has the truth's own nodes.
double discretisation_pct(const PosedCharacter& base, const References& references, std::size_t pose)
{
    constexpr double halved = 2.0, order = 1.0;
    if (pose >= references.truth_refined.size())
        return analysis::two_fields(base.distance(references.twin_refined[pose], references.twin[pose]).joint_pct, halved, order).bounds[0];
    return analysis::two_fields(base.distance(references.truth_refined[pose], references.truth[pose]).joint_pct, halved, order).bounds[1];
}

// PBS with its constraints converged: by twice the iterations after which the rest of the way is told.
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
        : of_(of),
          base_(of.scene, of.frames),
          fine_(refined(of.scene), of.frames),
          references_(solve_references(of, base_, fine_)),
          split_{analysis::CsvTable(part_columns), analysis::CsvTable(attachment_columns), {}}
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
            split_.parts.add_row({of_.scene.name, of_.frames[pose], base_.angle_deg(pose), options.k_stretch, options.iterations,
                                  total.joint_pct, base_.distance(shapes[pose], converged.shapes[pose]).joint_pct,
                                  base_.distance(converged.shapes[pose], truth).joint_pct, discretisation_pct(base_, references_, pose),
                                  pose >= references_.truth_refined.size() ? "twin" : "truth",
                                  base_.distance(converged.shapes[pose], converged.half_way[pose]).joint_pct,
                                  base_.distance(converged.shapes[pose], converged.refined[pose]).joint_pct, total.l2_pct, total.linf_m,
                                  int(truth.self_intersects)});
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
            split_.attachments.add_row({of_.scene.name, of_.frames[pose], base_.angle_deg(pose), spec.label, name_of(fem.attachment),
                                        fem.core_radius, base_.distance(shapes[pose], references_.twin[pose]).joint_pct, k_stretch,
                                        base_.distance(converged.shapes[pose], shapes[pose]).joint_pct, int(shapes[pose].finished),
                                        int(shapes[pose].self_intersects)});
    }

    const ErrorSplitCase& of_;
    PosedCharacter base_, fine_;
    References references_;
    ErrorSplit split_;
};

}  // namespace

ErrorSplit split_error(const ErrorSplitCase& of)
{
    return Splitting(of).split();
}

}  // namespace experiments
