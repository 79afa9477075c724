// The options of PBS: their keys in scenes, and how they are read.
#pragma once

#include "experiments/deformers/deformer_spec.hpp"
#include "experiments/deformers/pbs/pbs_option_names.hpp"
#include "experiments/settings/option_fields.hpp"

namespace experiments {

const OptionFields<pbs::PbsOptions>& pbs_fields();

// Sets the options and the variant.
void read_pbs(const SceneValues& values, const std::string& table, DeformerSpec& spec);

}  // namespace experiments
