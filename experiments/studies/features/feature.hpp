// What a scene may ask for or leave out, as pairs of scenes that differ in that alone.
#pragma once

#include "experiments/scene/scene.hpp"

#include <string>
#include <vector>

namespace experiments {

// A scene's settings on top of `bare_scene`; equal ones are measured once.
struct Variant {
    std::vector<std::string> overrides = {};  // key=value
    int threads = 1;
    bool progress = false;  // a progress bar on a terminal

    bool operator==(const Variant&) const = default;
};

struct Feature {
    std::string name;
    Variant without, with;
    bool changes_answer = false;  // the positions: how far is measured too
    bool needs_surface = false;   // makes sense where a rendered surface is carried along
};

// PBS alone, no reference, no frames, the volume columns alone: what every feature comes on top of.
std::vector<std::string> bare_scene();

// Those of architecture.md's list and the other switches of a scene.
const std::vector<Feature>& features();

Scene scene_of(const std::string& name, const std::vector<std::string>& cut, const Variant& variant);

}  // namespace experiments
