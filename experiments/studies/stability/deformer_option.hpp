// A deformer's settings, changed as a scene would change them, for deformers whose struct of options only their own file knows.
//   cell.spec = with_option(cell.spec, "poisson", 0.499);
#pragma once

#include "experiments/deformers/deformer.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace experiments {

bool has_option(const std::string& kind, const std::string& key);  // of the kind's own table

// All other options keep their values. InputError for a value out of its range.
DeformerSpec with_option(const DeformerSpec& spec, const std::string& key, const nlohmann::json& value);

}  // namespace experiments
