#include "experiments/studies/artefacts/smoothness_comparison.hpp"

#include "analysis/metrics/error_norms.hpp"
#include "analysis/metrics/frame_metrics.hpp"
#include "analysis/statistics/statistics.hpp"
#include "experiments/deformers/deformer_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace experiments {

using analysis::Columns;
using analysis::Smoothness;
using analysis::within;

namespace {

const Columns<Smoothness> at_joint_columns = {
    {"strain_jump_rms", &Smoothness::strain_jump_rms, "", "root mean square jump of strain between neighbouring tets at the joint"},
    {"bending_rms_rad", &Smoothness::bending_rms_rad, "rad", "root mean square bending of the skin at the joint"}};

}  // namespace

const Columns<SmoothnessRow> smoothness_columns =
    Columns<SmoothnessRow>{{"body", &SmoothnessRow::body, "", "name of the body"},
                           {"vertices", &SmoothnessRow::vertices, "", "vertices of its mesh"},
                           {"weights", &SmoothnessRow::weights, "", "paper: Eq. 2; rigid: every vertex on its nearest bone alone"},
                           {"pose", &SmoothnessRow::pose, "", "name of the pose"},
                           {"joint", &SmoothnessRow::joint, "", "name of the joint"}} +
    within(&SmoothnessRow::deformer, artefact_deformer_columns) + within(&SmoothnessRow::smoothness, at_joint_columns) +
    Columns<SmoothnessRow>{{"volume_abs_change_pct", &SmoothnessRow::volume_abs_change_pct, "%", "sum of the tets' absolute changes"}};

namespace {

const Columns<Reached> paper_columns = {{"iterations_paper", &Reached::iterations, "", "iterations to tolerance with Eq. 2"},
                                        {"reached_paper", &Reached::within, "", "they reached it"}};
const Columns<Reached> rigid_columns = {{"iterations_rigid", &Reached::iterations, "", "iterations to tolerance with rigid weights"},
                                        {"reached_rigid", &Reached::within, "", "they reached it"}};

}  // namespace

const Columns<WeightIterations> weight_iteration_columns = within(&WeightIterations::place, artefact_place_columns) +
                                                           within(&WeightIterations::paper, paper_columns) +
                                                           within(&WeightIterations::rigid, rigid_columns);

namespace {

constexpr double rounding = 1e-12;  // a smaller value is that of the rest pose

struct Twin {
    ArtefactBody paper, rigid;
};

Twin twin_of(ArtefactCase of, int vertices)
{
    of.scene.character.weights = pbs::WeightKind::paper;
    ArtefactBody paper(of, vertices);
    of.scene.character.weights = pbs::WeightKind::rigid;
    of.scene.character.weights_file.clear();
    return {std::move(paper), ArtefactBody(of, vertices)};
}

// The ratios of one quantity over meshes and orders, the own mesh and order first. Not a number where there is none.
struct Ratios {
    std::vector<double> values = {};
    analysis::Limit limit = analysis::Limit::none;  // of the first value
};

class Comparison {
public:
    explicit Comparison(const ArtefactCase& of) : of_(of) {}

    void compare(const Twin& twin, const DeformerSpec& spec)
    {
        const Shapes paper = twin.paper.posed.shapes(spec), rigid = twin.rigid.posed.shapes(spec);
        for (std::size_t pose = 0; pose < paper.size(); ++pose) {
            if (!paper[pose].finished || !rigid[pose].finished) continue;
            for (std::size_t joint = 0; joint < twin.paper.joints.size(); ++joint) {
                const analysis::Smoothness smooth = measure(twin.paper, spec, paper[pose], pose, joint, "paper"),
                                           rough = measure(twin.rigid, spec, rigid[pose], pose, joint, "rigid");
                const analysis::CaseKey at = key_of(twin, pose, twin.paper.joints[joint].name, spec.kind);
                add("strain_jump_over_rigid_weights", at, smooth.strain_jump_rms, rough.strain_jump_rms);
                add("curvature_over_rigid_weights", at, smooth.bending_rms_rad, rough.bending_rms_rad);
            }
            if (options_if<pbs::PbsOptions>(spec))
                add("volume_abs_change_over_rigid_weights", key_of(twin, pose, of_.joint, "pbs"),
                    volume_change_pct(twin.paper, paper[pose]), volume_change_pct(twin.rigid, rigid[pose]));
        }
    }

    // The weights affect only the initial guess of the solver: two guesses lead to one limit.
    void compare_convergence(const Twin& twin, const pbs::PbsOptions& options)
    {
        const pbs::Character &paper = twin.paper.posed.character(), &rigid = twin.rigid.posed.character();
        for (std::size_t pose = 0; pose < of_.poses.size(); ++pose) {
            const pbs::Pose& now = twin.paper.posed.pose(pose);
            const pbs::Positions bind_points = pbs::posed_bind_points(paper.binding, now);
            const std::vector<IterationPath> paths = iterate(paper, options, bind_points, {blended(paper, now), blended(rigid, now)},
                                                             most_weight_iterations, IterationMetrics(paper, bind_points));
            const double floor = floor_of(paths);
            add_iterations(twin, pose, reached_residual(paths[0], floor), reached_residual(paths[1], floor));
        }
    }

    WeightsComparison result() &&
    {
        for (const auto& [of, ratios] : ratios_) {
            const double own = ratios.values.front();
            if (!std::isfinite(own)) continue;
            analysis::Measurement measurement{"C06", of.first, of.second, own, own, own, "1"};
            measurement.limit = ratios.limit;
            for (const double ratio : ratios.values) {
                measurement.low = std::fmin(measurement.low, ratio);
                measurement.high = std::fmax(measurement.high, ratio);
            }
            result_.measurements.push_back(measurement);
        }
        return std::move(result_);
    }

private:
    static std::string body_name(const Twin& twin) { return twin.paper.posed.character().name; }
    analysis::CaseKey key_of(const Twin& twin, std::size_t pose, const std::string& joint, const std::string& deformer) const
    {
        analysis::CaseKey key = of_.poses[pose].key;
        key.body = body_name(twin);
        key.joint = joint;
        key.deformer = deformer;
        return key;
    }

    void add(const std::string& quantity, const analysis::CaseKey& at, double paper, double rigid)
    {
        ratios_[{quantity, at}].values.push_back(rigid > rounding ? paper / rigid : analysis::not_known);
    }

    // An initial guess within the tolerance counts as one iteration. Where neither path reaches it there is no ratio.
    void add_iterations(const Twin& twin, std::size_t pose, const Reached& paper, const Reached& rigid)
    {
        result_.iterations.push_back({place_of(of_, twin.paper, pose), paper, rigid});
        Ratios& ratios = ratios_[{"iterations_over_rigid_weights", key_of(twin, pose, of_.joint, "pbs")}];
        const bool some = paper.within || rigid.within;
        if (ratios.values.empty() && some && paper.within != rigid.within)
            ratios.limit = paper.within ? analysis::Limit::at_most : analysis::Limit::at_least;
        ratios.values.push_back(some ? std::max(paper.iterations, 1) / double(std::max(rigid.iterations, 1)) : analysis::not_known);
    }

    static double volume_change_pct(const ArtefactBody& body, const Shape& shape)
    {
        const pbs::TetMesh& mesh = body.posed.character().mesh;
        return analysis::MeshMetrics(mesh.rest, mesh.tets).measure(shape.positions).volume_abs_change_pct;
    }

    analysis::Smoothness measure(const ArtefactBody& body, const DeformerSpec& spec, const Shape& shape, std::size_t pose,
                                 std::size_t joint, const std::string& weights)
    {
        const pbs::Character& character = body.posed.character();
        const analysis::SmoothnessMetrics smoothness_metrics(character.mesh.rest, character.mesh.tets,
                                                             near_joint(character, body.joints[joint]));
        const analysis::Smoothness smoothness = smoothness_metrics.measure(shape.positions);
        result_.smoothness.push_back({character.name, static_cast<int>(character.mesh.rest.rows()), weights, of_.poses[pose].name,
                                      body.joints[joint].name, recorded(spec), smoothness, volume_change_pct(body, shape)});
        return smoothness;
    }

    const ArtefactCase& of_;
    std::map<std::pair<std::string, analysis::CaseKey>, Ratios> ratios_;  // by quantity and the key
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
        comparison.compare_convergence(twin, options_of<pbs::PbsOptions>(pbs));
        if (vertices != 0) continue;
        for (const DeformerSpec& other : other_orders(pbs)) comparison.compare(twin, other);
    }
    return std::move(comparison).result();
}

}  // namespace experiments
