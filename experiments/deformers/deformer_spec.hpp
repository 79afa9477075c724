// Which deformer, with which options, under which name in the records.
#pragma once

#include "experiments/deformers/fem/fem_options.hpp"
#include "pbs/solver/options.hpp"

#include <nlohmann/json.hpp>

#include <string>

namespace experiments {

struct DeformerSpec {
    std::string name;                 // lbs, dqs, pbs, or the name of a [[fem]] table
    std::string kind;                 // registered kind: lbs, dqs, pbs, fem
    std::string label;                // one for one deformer of a run: keys of run.json, names of frame files; e.g. pbs, pbs_96
    std::string variant = "default";  // e.g. jiggle, labels_relative
    pbs::PbsOptions pbs;              // of kind pbs
    FemOptions fem;                   // of kind fem
};

nlohmann::json to_json(const DeformerSpec& spec);

}  // namespace experiments
