#include "experiments/artefacts/smoothness_comparison.hpp"

#include "analysis/frame_metrics.hpp"
#include "analysis/smoothness.hpp"
#include "experiments/deformers/option_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

namespace experiments {
namespace {

constexpr int converged_iterations = 400;
constexpr double tolerance_over_converged = 1.1;

const std::vector<std::string> columns = {"body",
                                          "vertices",
                                          "weights",
                                          "pose",
                                          "joint",
                                          "deformer",
                                          "order",
                                          "precision",
                                          "strain_jump_rms",
                                          "bending_rms_rad",
                                          "volume_abs_change_pct"};

struct Twin {
    ArtefactBody paper, rigid;
};

Twin twin_of(ArtefactCase of, int vertices)
{
    of.scene.character.weights = pbs::WeightKind::paper;
    ArtefactBody paper(of, vertices);
    of.scene.character.weights = pbs::WeightKind::rigid;
    return {std::move(paper), ArtefactBody(of, vertices)};
}

// The first iteration from which on the largest residual stays within the tolerance of the last one.
int iterations_to_tolerance(const std::vector<pbs::Residuals>& history)
{
    const auto largest = [](const pbs::Residuals& r) { return std::max({r.stretch_rms, r.volume_rms, r.bind_rms_m}); };
    int enough = static_cast<int>(history.size());
    while (enough > 1 && largest(history[enough - 2]) <= tolerance_over_converged * largest(history.back())) --enough;
    return enough;
}

class Comparison {
public:
    explicit Comparison(const ArtefactCase& of) : of_(of), result_{{}, analysis::CsvTable(columns)} {}

    void compare(const Twin& twin, const DeformerSpec& spec)
    {
        const Shapes paper = twin.paper.posed.shapes(spec), rigid = twin.rigid.posed.shapes(spec);
        for (std::size_t pose = 0; pose < paper.size(); ++pose) {
            if (!paper[pose].finished || !rigid[pose].finished) continue;
            for (std::size_t joint = 0; joint < twin.paper.joints.size(); ++joint) {
                const analysis::Smoothness smooth = measure(twin.paper, spec, paper[pose], pose, joint, "paper"),
                                           rough = measure(twin.rigid, spec, rigid[pose], pose, joint, "rigid");
                const std::string at = fmt::format("{}, {}, {}", body_name(twin), of_.poses[pose].name, twin.paper.joints[joint].name);
                add("strain jump at the joint of " + title(spec) + ", Eq. 2 over rigid", at, smooth.strain_jump_rms, rough.strain_jump_rms);
                add("curvature of the skin of " + title(spec) + ", Eq. 2 over rigid", at, smooth.bending_rms_rad, rough.bending_rms_rad);
            }
            if (spec.kind == "pbs")
                add("absolute volume change of PBS, Eq. 2 over rigid", whole_body(twin, pose), volume_change_pct(twin.paper, paper[pose]),
                    volume_change_pct(twin.rigid, rigid[pose]));
        }
    }

    void compare_convergence(const Twin& twin, DeformerSpec spec)
    {
        spec.pbs.iterations = converged_iterations;
        spec.pbs.record_iterations = true;
        spec.pbs.precision = pbs::Precision::f64;
        for (std::size_t pose = 0; pose < of_.poses.size(); ++pose)
            add("iterations to tolerance, Eq. 2 over rigid", whole_body(twin, pose), iterations(twin.paper, spec, pose),
                iterations(twin.rigid, spec, pose));
    }

    WeightsComparison result() &&
    {
        for (const auto& [key, ratios] : ratios_) {
            const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
            result_.figures.push_back({"C06", key.first, key.second, ratios.front(), *least, *most, "1"});
        }
        return std::move(result_);
    }

private:
    static std::string title(const DeformerSpec& spec) { return spec.kind == "pbs" ? "PBS" : "LBS"; }
    static std::string body_name(const Twin& twin) { return twin.paper.posed.character().name; }
    std::string whole_body(const Twin& twin, std::size_t pose) const
    {
        return fmt::format("{}, {}", body_name(twin), of_.poses[pose].name) + (of_.joint.empty() ? "" : ", " + of_.joint);
    }

    void add(const std::string& quantity, const std::string& at, double paper, double rigid)
    {
        if (rigid > 0.0) ratios_[{quantity, at}].push_back(paper / rigid);
    }

    static double volume_change_pct(const ArtefactBody& body, const Shape& shape)
    {
        const pbs::TetMesh& mesh = body.posed.character().mesh;
        return analysis::Ruler(mesh.rest, mesh.tets).measure(shape.positions).volume_abs_change_pct;
    }

    static int iterations(const ArtefactBody& body, const DeformerSpec& spec, std::size_t pose)
    {
        const std::unique_ptr<Deformer> deformer = make_deformer(spec);
        deformer->reset(body.posed.character());
        return iterations_to_tolerance(deformer->advance(body.posed.pose(pose), 0.01).history);
    }

    analysis::Smoothness measure(const ArtefactBody& body, const DeformerSpec& spec, const Shape& shape, std::size_t pose,
                                 std::size_t joint, const std::string& weights)
    {
        const pbs::Character& character = body.posed.character();
        const analysis::SmoothnessRuler ruler(character.mesh.rest, character.mesh.tets, near_joint(character, body.joints[joint]));
        const analysis::Smoothness smoothness = ruler.measure(shape.positions);
        const bool pbs = spec.kind == "pbs";
        result_.smoothness.add_row({character.name, static_cast<int>(character.mesh.rest.rows()), weights, of_.poses[pose].name,
                                    body.joints[joint].name, spec.name, pbs ? name_of(spec.pbs.order) : "",
                                    pbs ? name_of(spec.pbs.precision) : "", smoothness.strain_jump_rms, smoothness.bending_rms_rad,
                                    volume_change_pct(body, shape)});
        return smoothness;
    }

    const ArtefactCase& of_;
    std::map<std::pair<std::string, std::string>, std::vector<double>> ratios_;  // by quantity and what it is of; its own first
    WeightsComparison result_;
};

}  // namespace

WeightsComparison compare_weights(const ArtefactCase& of)
{
    Comparison comparison(of);
    std::vector<int> meshes = {0};
    meshes.insert(meshes.end(), of.vertices.begin(), of.vertices.end());
    const DeformerSpec pbs = spec_of(of.scene, "pbs");
    for (const int vertices : meshes) {
        const Twin twin = twin_of(of, vertices);
        comparison.compare(twin, spec_of(of.scene, "lbs"));
        comparison.compare(twin, pbs);
        comparison.compare_convergence(twin, pbs);
        if (vertices != 0) continue;
        for (const DeformerSpec& other : other_orders(pbs)) comparison.compare(twin, other);
    }
    return std::move(comparison).result();
}

}  // namespace experiments
