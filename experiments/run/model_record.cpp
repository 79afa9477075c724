#include "experiments/run/run_records.hpp"

#include "pbs/character/body_cache.hpp"
#include "pbs/character/model_character.hpp"
#include "pbs/character/skinning_weights.hpp"

#include <nlohmann/json.hpp>

namespace experiments {
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
    if (!body.skeleton.bones.empty())
        record["weights_transferred_pct"] =
            pbs::carried_weight(body.skin, character.artist->weights, *character.surface, character.mesh.tets,
                                static_cast<int>(body.skeleton.bones.size()))
                .share_pct();
    return record;
}

}  // namespace experiments
