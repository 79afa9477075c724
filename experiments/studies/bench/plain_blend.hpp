// LBS and DQS as the paper's Eq. 1 reads, one vertex after the other in f64: the baseline of the packed blends. No scene can ask for them.
//   if (is_blend("lbs")) { const auto plain = make_plain_blend("lbs"); ... }
#pragma once

#include "experiments/deformers/deformer.hpp"

#include <memory>
#include <string>

namespace experiments {

bool is_blend(const std::string& kind);                               // lbs, dqs
std::unique_ptr<Deformer> make_plain_blend(const std::string& kind);  // std::out_of_range for any other kind

}  // namespace experiments
