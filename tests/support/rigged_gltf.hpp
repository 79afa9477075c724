// A rigged model as a glTF file: a tetrahedron of 1 m along x, the joints root and elbow, and animations that turn the elbow by 90 degrees
// in two seconds.
//   const std::string file = test_support::write_rigged_gltf(folder, "arm.gltf", {"Bend", "Wave"});
#pragma once

#include "tests/support/gltf_document.hpp"
#include "tests/support/scratch_folder.hpp"

namespace test_support {

inline std::string write_rigged_gltf(const ScratchFolder& folder, const std::string& name, const std::vector<std::string>& animations,
                                     float duration_s = 2.0f)
{
    constexpr float half = 0.70710678f;
    GltfDocument gltf;
    const int position = gltf.put<float>("VEC3", {0, 0, 0, 1, 0, 0, 0.5, 0.2f, 0, 0.5, 0, 0.2f}),
              weight = gltf.put<float>("VEC4", {1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0.5, 0, 0, 0.5, 0.5, 0, 0}),
              bind = gltf.put<float>("MAT4",
                                     {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -0.5, 0, 0, 1}),
              joint = gltf.put<std::uint8_t>("VEC4", {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}),
              times = gltf.put<float>("SCALAR", {0.0f, duration_s}), turns = gltf.put<float>("VEC4", {0, 0, 0, 1, 0, 0, half, half}),
              corners = gltf.put<std::uint16_t>("SCALAR", {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
    nlohmann::json moved = nlohmann::json::array();
    for (const std::string& animation : animations)
        moved.push_back({{"name", animation},
                         {"samplers", {{{"input", times}, {"output", turns}}}},
                         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}}}});
    gltf.json.update(nlohmann::json::parse(R"({
        "scene": 0, "scenes": [{"nodes": [0, 2]}],
        "nodes": [{"name": "root", "children": [1]}, {"name": "elbow", "translation": [0.5, 0, 0]},
                  {"name": "body", "mesh": 0, "skin": 0}]})"));
    gltf.json["skins"] = {{{"joints", {0, 1}}, {"inverseBindMatrices", bind}}};
    const nlohmann::json attributes = {{"POSITION", position}, {"WEIGHTS_0", weight}, {"JOINTS_0", joint}};
    gltf.json["meshes"] = {{{"name", "flesh"}, {"primitives", {{{"attributes", attributes}, {"indices", corners}}}}}};
    if (!animations.empty()) gltf.json["animations"] = moved;
    return folder.file(name, gltf.text());
}

}  // namespace test_support
