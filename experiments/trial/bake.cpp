#include "experiments/trial/bake.hpp"

#include "analysis/metrics/skin_error.hpp"
#include "experiments/characters/bodies.hpp"
#include "experiments/characters/model_character.hpp"
#include "experiments/deformers/correctives.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/meshes/mesh_io.hpp"
#include "experiments/rigs/glb_writer.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "experiments/run/corrective_training.hpp"
#include "experiments/run/runners.hpp"
#include "experiments/run/spread_reference.hpp"
#include "experiments/scene/motion.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/skinning/correctives.hpp"
#include "pbs/system/child_process.hpp"
#include "pbs/system/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace experiments {
namespace {

constexpr int held_out_of = 3;            // one of so many frames of the motion
constexpr double most_coordinates = 1e8;  // of the surface in all poses drawn, about a gigabyte
constexpr int fewest_drawn = 150;
constexpr std::size_t bones_of_a_point = 4;

struct SolvedPose {
    pbs::CorrectiveSample sample;
    std::vector<bool> at_tips;  // of creases, #V
    bool is_held_out = false;
};

std::vector<pbs::Pose> frames_of(const pbs::Motion& motion)
{
    std::vector<pbs::Pose> frames;
    for (std::size_t step = 0; step < motion.steps.size(); step += motion.steps_per_frame)
        frames.push_back(motion.steps[step]);
    return frames;
}

// The frames of the motion that the reference reaches.
std::vector<SolvedPose> solved_frames(const Scene& scene, const pbs::Character& character,
                                      const std::vector<pbs::Pose>& frames, const std::string& folder, double seconds)
{
    const auto spec = std::ranges::find(scene.deformers, scene.reference, &DeformerSpec::name);
    SpreadReference reference(*spec, reference_budget(*spec, character, folder, seconds, false));
    reference.reset(character);
    reference.foresee(frames);
    std::vector<SolvedPose> solved;
    for (std::size_t f = 0; f < frames.size(); ++f) {
        reference.advance(frames[f], 0.0);
        if (!reference.has_state()) continue;
        solved.push_back({{frames[f], reference.positions()}, near_tips(reference.facts()->tips, character.mesh.rest)});
        solved.back().is_held_out = f % held_out_of == 1;
    }
    return solved;
}

// The frames that are not held out, and poses drawn around them.
std::vector<pbs::CorrectiveSample> training_of(const Scene& scene, const pbs::Character& character,
                                               const std::vector<SolvedPose>& solved, double seconds)
{
    std::vector<pbs::CorrectiveSample> samples;
    std::vector<pbs::Pose> frames;
    for (const SolvedPose& pose : solved)
        if (!pose.is_held_out) {
            samples.push_back(pose.sample);
            frames.push_back(pose.sample.pose);
        }
    const auto spec = std::ranges::find(scene.deformers, scene.reference, &DeformerSpec::name);
    DrawnPoses drawn;
    const double coordinates = 3.0 * static_cast<double>(character.surface->tet.size());
    drawn.count = std::clamp(static_cast<int>(most_coordinates / coordinates), fewest_drawn, drawn.count);
    pbs::Character moving_apart = character;
    moving_apart.moves_with.clear();  // the poses that are drawn turn every joint
    for (pbs::CorrectiveSample& sample : solved_on_linear_elements(
             moving_apart, options_of<FemOptions>(*spec),
             drawn_poses(character.skeleton, rotations_in(character.skeleton, frames), drawn), seconds))
        samples.push_back(std::move(sample));
    return samples;
}

// Over the frames held out, within the range of the training or beyond it.
nlohmann::json distances(const pbs::Correctives& correctives, const pbs::Character& character,
                         const std::vector<SolvedPose>& solved, bool within)
{
    const analysis::SkinErrorMetrics skin(character.mesh.rest, character.mesh.tets);
    int frames = 0;
    double lbs_squares = 0.0, own_squares = 0.0;
    for (const SolvedPose& pose : solved) {
        if (!pose.is_held_out || is_within_training(correctives, pose.sample.pose) != within) continue;
        pbs::Positions lbs, own;
        pbs::linear_blend_skinning(character.mesh.rest, character.weights, pose.sample.pose, lbs);
        pbs::corrected_skinning(correctives, character.mesh.rest, character.weights, pose.sample.pose, own);
        const auto square_mm2 = [&](const pbs::Positions& x) {
            return std::pow(skin.measure(x, pose.sample.shape, pose.at_tips).rms_mm, 2);
        };
        lbs_squares += square_mm2(lbs);
        own_squares += square_mm2(own);
        ++frames;
    }
    if (frames == 0) return nullptr;
    return {{"frames", frames},
            {"lbs_mm", std::sqrt(lbs_squares / frames)},
            {"correctives_mm", std::sqrt(own_squares / frames)}};
}

// The four heaviest of a point, by bone.
void add_heaviest(const std::map<int, double>& shares, pbs::Weights& weights)
{
    std::vector<std::pair<double, int>> heaviest;
    for (const auto& [bone, share] : shares)
        if (share > 0.0) heaviest.emplace_back(-share, bone);
    std::ranges::sort(heaviest);
    heaviest.resize(std::min(heaviest.size(), bones_of_a_point));
    double sum = 0.0;
    for (const auto& [share, bone] : heaviest) sum -= share;
    for (const auto& [share, bone] : heaviest) weights.add(bone, -share / sum);
    weights.end_vertex();
}

// Moves all frames by the surface's own correctives. Returns the number of morph targets.
Eigen::Index write_surface(const pbs::Character& character, const pbs::Motion& motion,
                           std::vector<pbs::CorrectiveSample> samples, const std::string& frames_folder,
                           const BakeOptions& options)
{
    const pbs::EmbeddedSurface& surface = *character.surface;
    const pbs::Tets& tets = character.mesh.tets;
    const pbs::RiggedModel& model = *character.artist->model;
    const pbs::Positions rest = pbs::embedded_positions(surface, character.mesh.rest, tets);
    for (pbs::CorrectiveSample& sample : samples)
        sample.shape = pbs::surface_positions(character, sample.shape, sample.pose);
    pbs::GlbWriter writer(frames_folder + "/correctives.glb", "correctives", surface.triangles, model.body.look,
                          pbs::read_materials(model.rig.file));
    writer.add_frame(0.0, rest);
    const int joints = static_cast<int>(character.skeleton.bones.size());
    pbs::CorrectiveOptions fit;
    while (fit.rank > 1 && writer.bytes(1 + fit.rank * joints) > options.most_glb_bytes) --fit.rank;
    pbs::GlbSkin skin{
        .skeleton = character.skeleton, .weights = surface_weights(character), .poses = frames_of(motion)};
    const pbs::Correctives correctives = pbs::fit_correctives(skin.skeleton, rest, skin.weights, samples, fit);
    for (const pbs::JointCorrective& joint : correctives.joints)
        for (const auto mode : joint.modes.colwise()) {
            pbs::Positions target = rest;
            for (std::size_t i = 0; i < joint.vertices.size(); ++i)
                target.row(joint.vertices[i]) += mode.segment<3>(3 * static_cast<Eigen::Index>(i)).transpose();
            writer.add_frame(0.0, target);
        }
    skin.target_weights.resize(static_cast<Eigen::Index>(skin.poses.size()), correctives.modes());
    for (std::size_t f = 0; f < skin.poses.size(); ++f) {
        skin.times_s.push_back(static_cast<double>(f) * motion.steps_per_frame * motion.time_step_s);
        skin.target_weights.row(static_cast<Eigen::Index>(f)) =
            corrective_coefficients(correctives, skin.poses[f]).transpose();
        if (!options.surface_files) continue;
        pbs::Positions moved;
        pbs::corrected_skinning(correctives, rest, skin.weights, skin.poses[f], moved);
        pbs::write_vtp(fmt::format("{}/correctives_surface_{:06d}.vtp", frames_folder, f), moved, surface.triangles);
    }
    writer.write(&skin);
    return correctives.modes();
}

}  // namespace

pbs::Weights surface_weights(const pbs::Character& character)
{
    const pbs::EmbeddedSurface& surface = *character.surface;
    const bool has_own = character.weight_kind == pbs::WeightKind::artist;
    const pbs::Weights& skin = has_own ? character.artist->model->body.skin : character.weights;
    pbs::Weights weights{{0}, {}, {}};
    for (int p = 0; p < surface.tet.size(); ++p) {
        std::map<int, double> shares;
        const auto add = [&](int vertex, double share) {
            for (int e = skin.first[vertex]; e < skin.first[vertex + 1]; ++e)
                shares[skin.bone[e]] += share * skin.weight[e];
        };
        if (has_own)
            add(p, 1.0);
        else
            for (int corner = 0; corner < 4; ++corner)
                add(character.mesh.tets(surface.tet(p), corner), surface.barycentric(p, corner));
        add_heaviest(shares, weights);
    }
    return weights;
}

nlohmann::json bake_correctives(const Scene& scene, const std::string& folder, const BakeOptions& options)
{
    const pbs::Stopwatch stopwatch;
    const pbs::Stage stage("learning correctives of " + scene.name);
    pbs::CharacterSource source = scene.character;
    source.surface = true;
    pbs::Character character = pbs::make_character(source);
    const pbs::Motion motion = make_case_motion(scene.motion, character, scene.file).motion;
    take_bones_that_move_as_one(motion, character);
    const std::vector<SolvedPose> solved = solved_frames(scene, character, frames_of(motion), folder, options.seconds);
    const std::vector<pbs::CorrectiveSample> training = training_of(scene, character, solved, options.seconds);
    if (training.empty())
        throw pbs::InputError(
            scene.file, 0, "reference.name", scene.reference,
            "no pose was reached from which correctives could be learned: expected more --reference-seconds");
    const pbs::Correctives correctives =
        pbs::fit_correctives(character.skeleton, character.mesh.rest, character.weights, training);
    const std::string frames_folder = folder + "/frames";
    pbs::write_atomically(frames_folder + "/correctives.toml", text_of(correctives, character));
    const Eigen::Index targets = write_surface(character, motion, training, frames_folder, options);
    return {{"trained", training.size()},
            {"held_out", std::ranges::count(solved, true, &SolvedPose::is_held_out)},
            {"modes", correctives.modes()},
            {"targets", targets},
            {"seconds", stopwatch.seconds()},
            {"within", distances(correctives, character, solved, true)},
            {"beyond", distances(correctives, character, solved, false)}};
}

}  // namespace experiments
