// The deformers there are. A new one is one folder and one line in registry.cpp.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/deformer_spec.hpp"

#include <memory>
#include <vector>

namespace experiments {

struct DeformerKind {
    std::string kind;
    std::string meaning;
    std::unique_ptr<Deformer> (*make)(const DeformerSpec& spec);
};
const std::vector<DeformerKind>& deformer_kinds();

std::unique_ptr<Deformer> make_deformer(const DeformerSpec& spec);

}  // namespace experiments
