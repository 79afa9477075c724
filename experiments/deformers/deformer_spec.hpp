// Which deformer, with which options, under which name in the records.
#pragma once

#include "experiments/deformers/delta_mush/delta_mush.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/xpbd/xpbd_options.hpp"
#include "pbs/solver/options.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace experiments {

struct DeformerSpec {
    std::string name;                 // a kind, or the name of a [[fem]] table
    std::string kind;                 // registered kind
    std::string label;                // one for one deformer of a run: keys of run.json, names of frame files; e.g. pbs, pbs_96
    std::string variant = "default";  // e.g. jiggle, labels_relative
    pbs::PbsOptions pbs;              // of kind pbs
    FemOptions fem;                   // of kind fem
    XpbdOptions xpbd = {};            // of kinds xpbd, xpbd_small_steps
    DeltaMushOptions delta_mush = {};
};

nlohmann::json to_json(const DeformerSpec& spec);

}  // namespace experiments
