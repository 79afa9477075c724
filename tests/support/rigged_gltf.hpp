// A rigged model as a glTF file with its numbers next to it: a tetrahedron of 1 m along x, the joints root and elbow, and animations that
// turn the elbow by 90 degrees in two seconds.
//   const std::string file = test_support::write_rigged_gltf(folder, "arm.gltf", {"Bend", "Wave"});
#pragma once

#include "tests/support/scratch_folder.hpp"

#include <nlohmann/json.hpp>

namespace test_support {

class GltfNumbers {
public:
    // The index of a new accessor.
    template <typename Number>
    int add(const std::vector<Number>& numbers, const char* type, int component, int count)
    {
        const std::size_t size = numbers.size() * sizeof(Number);
        views.push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", size}});
        accessors.push_back({{"bufferView", views.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}});
        bytes.append(reinterpret_cast<const char*>(numbers.data()), size);
        return static_cast<int>(accessors.size()) - 1;
    }

    std::string bytes;
    nlohmann::json views = nlohmann::json::array(), accessors = nlohmann::json::array();
};

inline std::string write_rigged_gltf(const ScratchFolder& folder, const std::string& name, const std::vector<std::string>& animations,
                                     float duration_s = 2.0f)
{
    constexpr int floats = 5126, bytes = 5121, shorts = 5123;
    constexpr float half = 0.70710678f;
    GltfNumbers numbers;
    const std::vector<float> points = {0, 0, 0, 1, 0, 0, 0.5, 0.2f, 0, 0.5, 0, 0.2f},
                             weights = {1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0.5, 0, 0, 0.5, 0.5, 0, 0};
    const std::vector<float> binds = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -0.5, 0, 0, 1};
    const int position = numbers.add(points, "VEC3", floats, 4), weight = numbers.add(weights, "VEC4", floats, 4),
              bind = numbers.add(binds, "MAT4", floats, 2),
              joint = numbers.add(std::vector<unsigned char>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4", bytes, 4),
              times = numbers.add(std::vector<float>{0.0f, duration_s}, "SCALAR", floats, 2),
              turns = numbers.add(std::vector<float>{0, 0, 0, 1, 0, 0, half, half}, "VEC4", floats, 2),
              corners = numbers.add(std::vector<unsigned short>{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, "SCALAR", shorts, 12);
    nlohmann::json moved = nlohmann::json::array();
    for (const std::string& animation : animations)
        moved.push_back({{"name", animation},
                         {"samplers", {{{"input", times}, {"output", turns}}}},
                         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}}}});
    nlohmann::json document = {
        {"asset", {{"version", "2.0"}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0, 2}}}}},
        {"nodes",
         {{{"name", "root"}, {"children", {1}}},
          {{"name", "elbow"}, {"translation", {0.5, 0, 0}}},
          {{"name", "body"}, {"mesh", 0}, {"skin", 0}}}},
        {"skins", {{{"joints", {0, 1}}, {"inverseBindMatrices", bind}}}},
        {"meshes",
         {{{"name", "flesh"},
           {"primitives",
            {{{"attributes", {{"POSITION", position}, {"WEIGHTS_0", weight}, {"JOINTS_0", joint}}}, {"indices", corners}}}}}}},
        {"buffers", {{{"uri", "numbers.bin"}, {"byteLength", numbers.bytes.size()}}}},
        {"bufferViews", numbers.views},
        {"accessors", numbers.accessors}};
    if (!animations.empty()) document["animations"] = moved;
    folder.file("numbers.bin", numbers.bytes);
    return folder.file(name, document.dump());
}

}  // namespace test_support
