// The options of the finite element reference in scenes and records: their keys, and how they are read.
#pragma once

#include "experiments/deformers/deformer_spec.hpp"
#include "experiments/deformers/fem/fem_option_names.hpp"
#include "experiments/settings/option_fields.hpp"

namespace experiments {

const OptionFields<FemOptions>& fem_fields();

// Sets the options from one [[fem]] table. A name that cannot name files and contradicting keys are an InputError.
void read_fem(const SceneValues& values, const std::string& table, DeformerSpec& spec);

}  // namespace experiments
