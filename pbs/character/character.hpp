// A character: flesh, bones, how they hang together, and the surface that is rendered.
#pragma once

#include "pbs/character/embedding.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/weights.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pbs {

struct Character {
    std::string name;
    TetMesh mesh;
    Skeleton skeleton;
    BoneBinding binding;
    Weights weights;                                          // what LBS and DQS blend with
    std::vector<bool> blended;                                // vertices that Eq. 2 blends between bones, whatever `weights` is, #V
    std::optional<EmbeddedSurface> surface;                   // the surface people see, carried by the tets
    std::vector<std::pair<std::string, std::string>> inputs;  // what it was made from -> content hash
};

// Vertices farther from their nearest bone than the mean over all (Sec. 4), #V.
std::vector<bool> jiggle_zone(const BoneBinding& binding);

}  // namespace pbs
