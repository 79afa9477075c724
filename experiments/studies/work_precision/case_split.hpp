// Which poses train and which are evaluated. Settings are chosen on the training poses, and the diagrams show the others.
//   halves_of({"limb", "limb", "human"})   // training, evaluation, evaluation
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/settings/option_names.hpp"

#include <string>
#include <vector>

namespace experiments {

enum class Half { training, evaluation };

// The poses of each body, in the order of the list, alternate: the first one trains, the second one is evaluated, and so on. A body with
// one pose is only evaluated. bodies: that of each pose.
std::vector<Half> halves_of(const std::vector<std::string>& bodies);

template <>
inline constexpr NameTable<Half, 2> option_names<Half>{{{Half::training, "training"}, {Half::evaluation, "evaluation"}}};

}  // namespace experiments

namespace analysis {

template <>
struct EnumNames<experiments::Half> : experiments::OptionNames<experiments::Half> {
};

}  // namespace analysis
