// ensemble.md: how many pairs of deformers are decided, which are not, and which references decide nothing, with their worst tet.
//   finished.write("ensemble.md", ensemble_page(pairs, members));
#pragma once

#include "experiments/studies/ensemble/ensemble.hpp"

#include <string>
#include <vector>

namespace experiments {

inline const std::string linear_elements = "fem_linear";  // the deformer that is no skinning method

std::string ensemble_page(const std::vector<PairRow>& pairs, const std::vector<MemberRow>& members);

}  // namespace experiments
