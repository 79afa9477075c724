// The deformers there are. A new one is one folder and one line in registry.cpp; where it has options of its own, also a member of
// DeformerSpec and its keys in scene_schema.cpp and scene.cpp.
#pragma once

#include "experiments/deformers/deformer.hpp"
#include "experiments/deformers/deformer_spec.hpp"

#include <memory>
#include <vector>

namespace experiments {

struct DeformerKind {
    std::string kind;
    std::string meaning;
    bool has_options;  // read from tables of its own; the others are used by the name of their kind
    std::unique_ptr<Deformer> (*make)(const DeformerSpec& spec);
};
const std::vector<DeformerKind>& deformer_kinds();

std::unique_ptr<Deformer> make_deformer(const DeformerSpec& spec);

}  // namespace experiments
