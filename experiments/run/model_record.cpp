#include "experiments/run/model_record.hpp"

#include "pbs/character/input_file.hpp"
#include "pbs/character/model_character.hpp"

#include <nlohmann/json.hpp>

namespace experiments {
namespace {

std::vector<double> weight_of_bones(const pbs::Weights& weights, std::size_t bones)
{
    std::vector<double> sums(bones, 0.0);
    for (std::size_t e = 0; e < weights.bone.size(); ++e) sums[weights.bone[e]] += weights.weight[e];
    return sums;
}

double transferred_pct(const pbs::RiggedBody& body, const pbs::Weights& in_tets)
{
    const std::size_t bones = body.skeleton.bones.size();
    std::vector<bool> leads(bones, false);
    for (std::size_t e = 0; e < in_tets.bone.size(); ++e)
        if (in_tets.weight[e] > 0.5) leads[in_tets.bone[e]] = true;
    const std::vector<double> of_artist = weight_of_bones(body.skin, bones);
    double whole = 0.0, reached = 0.0;
    for (std::size_t b = 0; b < bones; ++b) {
        whole += of_artist[b];
        if (leads[b]) reached += of_artist[b];
    }
    return whole > 0.0 ? 100.0 * reached / whole : 0.0;
}

}  // namespace

nlohmann::json model_record(const pbs::Character& character)
{
    const pbs::RiggedModel& model = *character.artist->model;
    const pbs::RiggedBody& body = model.body;
    nlohmann::json record = {{"file", pbs::file_name(model.rig.file)}, {"containers", body.containers}};
    for (const auto* list : {"joints", "joints_dropped", "meshes", "animations"}) record[list] = nlohmann::json::array();
    for (const pbs::Bone& bone : body.skeleton.bones) record["joints"].push_back(bone.name);
    for (const pbs::DroppedJoint& joint : body.dropped)
        record["joints_dropped"].push_back({{"name", joint.name}, {"reason", joint.reason}});
    for (const pbs::RigMesh& mesh : body.binding.meshes) record["meshes"].push_back(mesh.name);
    for (const pbs::RigAnimation& animation : model.rig.animations) record["animations"].push_back(animation.name);
    record["animation"] = model.animation ? nlohmann::json(model.animation->name) : nlohmann::json();
    record["bind_pose_deg"] = body.bind_pose_deg;
    record["metres_per_unit"] = body.binding.metres_per_unit;
    record["extent_m"] = (body.surface.colwise().maxCoeff() - body.surface.colwise().minCoeff()).maxCoeff();
    if (!body.skeleton.bones.empty()) record["weights_transferred_pct"] = transferred_pct(body, character.artist->weights);
    return record;
}

}  // namespace experiments
