// The optional features of a scene, as pairs of scenes that differ in one feature alone.
#pragma once

#include "experiments/scene/scene.hpp"

#include <string>
#include <vector>

namespace experiments {

// A scene's settings on top of the bare scene: PBS alone, no reference, no frames on disk and no metrics except the volume.
struct Variant {
    std::vector<std::string> overrides = {};  // key=value
    int threads = 1;
    bool progress = false;  // a progress bar on a terminal

    bool operator==(const Variant&) const = default;
};

struct Feature {
    std::string name;
    Variant without = {}, with = {};
    bool changes_result = false;  // the positions; how far they move is measured too
    bool needs_surface = false;   // only for a character with a rendered surface
};

const std::vector<Feature>& features();

Scene scene_of(const std::string& name, const std::vector<std::string>& cut, const Variant& variant);

}  // namespace experiments
