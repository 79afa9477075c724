#include "experiments/studies/stability/stability_body.hpp"

#include "experiments/scene/scene.hpp"
#include "experiments/studies/stability/distorted_mesh.hpp"
#include "pbs/skinning/blend.hpp"

#include <cmath>
#include <map>
#include <random>

namespace experiments {
namespace {

constexpr int limb_vertices = 400;

pbs::Character spoilt(pbs::Character character, Defect defect, double thinness)
{
    character.mesh = distorted(character.mesh, defect, thinness);
    character.binding = pbs::bind_to_nearest_bone(character.mesh.rest, character.skeleton);
    character.weights = pbs::paper_weights(character.binding, character.skeleton);
    for (int vertex = 0; vertex < character.weights.vertices(); ++vertex) character.blended[vertex] = character.weights.blended(vertex);
    return character;
}

std::vector<pbs::Pose> way_of(const StabilityCell& cell, const pbs::Skeleton& skeleton)
{
    const Disturbance& disturbance = cell.disturbance;
    std::vector<pbs::Pose> way;
    if (cell.body == "limb") {
        const int forearm = pbs::find_bone(skeleton, "forearm");
        way = pbs::joint_sweep(skeleton, forearm, disturbance.axis, disturbance.angle_deg, disturbance.turning_steps + 1, cell.time_step_s)
                  .steps;
    } else {
        const Scene scene = stability_scene(cell.body);
        way = make_motion(scene.motion, skeleton, scene.file).steps;
    }
    if (disturbance.teleport_m > 0.0) {
        way = {way.back(), way.back()};
        for (Eigen::Isometry3d& bone : way.back()) bone.pretranslate(disturbance.teleport_m * pbs::Vec3::Ones().normalized());
    }
    if (disturbance.stays || disturbance.start != Start::none) way = {way.back()};
    return way;
}

pbs::Positions random_shape(const pbs::Positions& blended)
{
    std::mt19937 engine(stability_seed);
    const Eigen::RowVector3d lower = blended.colwise().minCoeff(), size = blended.colwise().maxCoeff() - lower;
    pbs::Positions shape(blended.rows(), 3);
    for (Eigen::Index i = 0; i < shape.size(); ++i)
        shape.data()[i] = lower(i % 3) + size(i % 3) * std::uniform_real_distribution<double>(0.0, 1.0)(engine);
    return shape;
}

// Scaled about the centre of the blended shape; flattened and mirrored in z.
pbs::Positions started(Start start, const pbs::Positions& blended)
{
    const Eigen::RowVector3d middle = blended.colwise().mean();
    const auto scaled = [&](double x, double y, double z) -> pbs::Positions {
        return ((blended.rowwise() - middle) * pbs::Vec3(x, y, z).asDiagonal()).rowwise() + middle;
    };
    switch (start) {
        case Start::flattened:
            return scaled(1.0, 1.0, 0.0);
        case Start::mirrored:
            return scaled(1.0, 1.0, -1.0);
        case Start::point:
            return scaled(0.0, 0.0, 0.0);
        case Start::random:
            return random_shape(blended);
        case Start::none:
            break;
    }
    return blended;
}

}  // namespace

Scene stability_scene(const std::string& body)
{
    if (body == "limb") return read_scene("limb_bend", {"character.vertices=" + std::to_string(limb_vertices)});
    return read_scene("human_01_01", {"character.body=" + body, "motion.start_s=6.72", "motion.duration_s=0.36"});
}

const pbs::Character& stability_character(const StabilityCell& cell)
{
    static std::map<std::string, pbs::Character> kept;
    const std::string key = cell.body + std::to_string(static_cast<int>(cell.defect)) + std::to_string(std::log10(cell.thinness));
    if (const auto found = kept.find(key); found != kept.end()) return found->second;
    pbs::Character character = pbs::make_character(stability_scene(cell.body).character);
    if (cell.defect != Defect::none) character = spoilt(std::move(character), cell.defect, cell.thinness);
    return kept.emplace(key, std::move(character)).first->second;
}

StabilityBody::StabilityBody(const StabilityCell& cell)
    : character_(stability_character(cell)),
      way_(way_of(cell, character_.skeleton)),
      start_(cell.disturbance.start),
      still_steps_(cell.still_steps),
      diagonal_m_((character_.mesh.rest.colwise().maxCoeff() - character_.mesh.rest.colwise().minCoeff()).norm())
{
}

Drive StabilityBody::drive(int step)
{
    const int posed = std::min(step, disturbed_steps() - 1);
    const pbs::Pose& pose = way_[posed];
    if (posed != posed_ || step <= 1) {
        pbs::linear_blend_skinning(character_.mesh.rest, character_.weights, pose, blended_);
        bind_points_ = pbs::posed_bind_points(character_.binding, pose);
    }
    if (step == 0) blended_ = started(start_, blended_);
    posed_ = posed;
    return {pose, blended_, bind_points_};
}

}  // namespace experiments
