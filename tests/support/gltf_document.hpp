// A glTF 2.0 document whose numbers are in one buffer, which the text contains as base64: rigs of a few points without
// other files.
//   test_support::GltfDocument gltf = test_support::two_joint_document();
//   gltf.json["nodes"][0]["scale"] = {2, 2, 2};
//   const pbs::Rig rig = pbs::read_gltf_rig(folder.file("a.gltf", gltf.text()));
#pragma once

#include "tests/support/scratch_folder.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace test_support {

template <typename Number>
constexpr int gltf_component_type()
{
    if (std::is_same_v<Number, std::int8_t>) return 5120;
    if (std::is_same_v<Number, std::uint8_t>) return 5121;
    if (std::is_same_v<Number, std::int16_t>) return 5122;
    if (std::is_same_v<Number, std::uint16_t>) return 5123;
    return std::is_same_v<Number, std::uint32_t> ? 5125 : 5126;
}

inline std::string base64(const std::string& bytes)
{
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three = three << 8 | (at + k < bytes.size() ? std::uint8_t(bytes[at + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k) text += at + k > bytes.size() ? '=' : digits[three >> (18 - 6 * k) & 63U];
    }
    return text;
}

class GltfDocument {
public:
    nlohmann::json json = nlohmann::json::parse(R"({"asset": {"version": "2.0"}, "accessors": [], "bufferViews": []})");
    std::string bytes;

    // The number of a new buffer view.
    template <typename Number>
    int put_bytes(const std::vector<Number>& numbers)
    {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", numbers.size() * sizeof(Number)}});
        bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
        return static_cast<int>(json["bufferViews"].size()) - 1;
    }

    // The number of a new accessor; type: SCALAR, VEC3, VEC4 or MAT4.
    template <typename Number>
    int put(const std::string& type, const std::vector<Number>& numbers, bool normalized = false)
    {
        const std::size_t width = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
        const int view = put_bytes(numbers);
        json["accessors"].push_back({{"bufferView", view},
                                     {"componentType", gltf_component_type<Number>()},
                                     {"count", numbers.size() / width},
                                     {"type", type},
                                     {"normalized", normalized}});
        return static_cast<int>(json["accessors"].size()) - 1;
    }

    // The number of an accessor with the same numbers as another one.
    int put_copy(int accessor)
    {
        json["accessors"].push_back(json["accessors"][accessor]);
        return static_cast<int>(json["accessors"].size()) - 1;
    }

    std::string text() const
    {
        nlohmann::json document = json;
        if (!bytes.empty())
            document["buffers"] = {
                {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
        return document.dump();
    }
};

// The rig of two_joint_rig.hpp: a root at (1, 0, 0), an elbow at (1, 2, 0), four points, and an animation of 1 s that
// turns the elbow half round about z. Accessors: 0 points, 1 indices, 2 joints, 3 weights, 4 inverse bind matrices, 5
// times, 6 rotations.
inline GltfDocument two_joint_document()
{
    GltfDocument gltf;
    gltf.put<float>("VEC3", {1, 0, 0, 1, 2, 0, 1, 4, 0, 2, 2, 0});
    gltf.put<std::uint16_t>("SCALAR", {0, 1, 3, 1, 2, 3});
    gltf.put<std::uint8_t>("VEC4", {0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0});
    gltf.put<float>("VEC4", {1, 0, 0, 0, 0.5F, 0.5F, 0, 0, 1, 0, 0, 0, 0.25F, 0.75F, 0, 0});
    gltf.put<float>("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0,  0, 1,  // by columns
                             1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, -2, 0, 1});
    gltf.put<float>("SCALAR", {0, 1});
    gltf.put<float>("VEC4", {0, 0, 0, 1, 0, 0, 1, 0});
    gltf.json.update(nlohmann::json::parse(R"({
        "scene": 0, "scenes": [{"nodes": [0, 2]}],
        "nodes": [{"name": "root", "translation": [1, 0, 0], "children": [1]},
                  {"name": "elbow", "translation": [0, 2, 0]},
                  {"name": "body", "mesh": 0, "skin": 0}],
        "meshes": [{"name": "arm", "primitives": [
            {"attributes": {"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3}, "indices": 1}]}],
        "skins": [{"joints": [0, 1], "inverseBindMatrices": 4}],
        "animations": [{"name": "Bend", "samplers": [{"input": 5, "output": 6}],
                        "channels": [{"sampler": 0, "target": {"node": 1, "path": "rotation"}}]}]})"));
    return gltf;
}

// A rigged model as a glTF file: a tetrahedron of 1 m along x, the joints root and elbow, and animations that turn the
// elbow by 90 degrees, or by the angle of each, in two seconds.
//   const std::string file = test_support::write_rigged_gltf(folder, "arm.gltf", {"Bend", "Wave"});
inline std::string write_rigged_gltf(const ScratchFolder& folder, const std::string& name,
                                     const std::vector<std::string>& animations, float duration_s = 2.0f,
                                     const std::vector<float>& angles_deg = {})
{
    GltfDocument gltf;
    const int position = gltf.put<float>("VEC3", {0, 0, 0, 1, 0, 0, 0.5, 0.2f, 0, 0.5, 0, 0.2f}),
              weight = gltf.put<float>("VEC4", {1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0.5, 0, 0, 0.5, 0.5, 0, 0}),
              bind = gltf.put<float>("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,    0, 0, 1,
                                              1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -0.5, 0, 0, 1}),
              joint = gltf.put<std::uint8_t>("VEC4", {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}),
              times = gltf.put<float>("SCALAR", {0.0f, duration_s}),
              corners = gltf.put<std::uint16_t>("SCALAR", {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
    nlohmann::json moved = nlohmann::json::array();
    for (std::size_t a = 0; a < animations.size(); ++a) {
        const float half = (a < angles_deg.size() ? angles_deg[a] : 90.0f) * 0.0087266463f;
        const int turns = gltf.put<float>("VEC4", {0, 0, 0, 1, 0, 0, std::sin(half), std::cos(half)});
        moved.push_back({{"name", animations[a]},
                         {"samplers", {{{"input", times}, {"output", turns}}}},
                         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}}}});
    }
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
