// The record of a rigged model for run.json and try.json: the parts that the run uses and the parts that it leaves out.
#pragma once

#include "pbs/character/character.hpp"

#include <nlohmann/json_fwd.hpp>

namespace experiments {

// file, joints (the bones), joints_dropped with reasons, containers, meshes, bind_pose_deg, metres_per_unit, extent_m, animations,
// animation (the one that determined the size), weights_transferred_pct (pbs::CarriedWeight). The character has a model.
nlohmann::json model_record(const pbs::Character& character);

}  // namespace experiments
