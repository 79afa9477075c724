#include "pbs/rig/assimp_animations.hpp"

#include "pbs/geometry/input_error.hpp"

#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace pbs {
namespace {

constexpr double default_tick_rate_hz = 25.0;  // assimp's rate for files that state none

Eigen::Vector4d numbers_of(const aiVector3D& v)
{
    return {v.x, v.y, v.z, 0.0};
}
Eigen::Vector4d numbers_of(const aiQuaternion& q)
{
    return {q.x, q.y, q.z, q.w};
}

// Null where there are no keys.
template <typename Key>
std::optional<KeyTrack> track_of(const Key* keys, unsigned count, double tick_rate_hz, const std::string& file, const std::string& node)
{
    if (count == 0) return std::nullopt;
    KeyTrack track;
    for (unsigned k = 0; k < count; ++k) {
        track.times_s.push_back(keys[k].mTime / tick_rate_hz);
        track.values.push_back(numbers_of(keys[k].mValue));
        if (!std::isfinite(track.times_s.back()) || !track.values.back().allFinite())
            throw InputError(file, 0, "node " + node + ", key " + std::to_string(k), "", "expected finite numbers");
    }
    if (!std::is_sorted(track.times_s.begin(), track.times_s.end()))
        throw InputError(file, 0, "node " + node, "", "expected times of keys that do not go back");
    return track;
}

RigAnimation animation_of(const aiAnimation& source, unsigned index, const std::map<std::string, int>& node_named, Rig& rig)
{
    const double tick_rate_hz = source.mTicksPerSecond > 0.0 ? source.mTicksPerSecond : default_tick_rate_hz;
    RigAnimation animation;
    animation.name = source.mName.length > 0 ? source.mName.C_Str() : "animation " + std::to_string(index);
    animation.start_s = std::numeric_limits<double>::max();
    animation.end_s = std::numeric_limits<double>::lowest();
    for (unsigned c = 0; c < source.mNumChannels; ++c) {
        const aiNodeAnim& channel = *source.mChannels[c];
        const std::string name = channel.mNodeName.C_Str();
        const auto node = node_named.find(name);
        if (node == node_named.end()) {
            rig.remarks.push_back("animation " + animation.name + " moves " + name + ", which is no node of the file");
            continue;
        }
        NodeTracks tracks{node->second, track_of(channel.mPositionKeys, channel.mNumPositionKeys, tick_rate_hz, rig.file, name),
                          track_of(channel.mRotationKeys, channel.mNumRotationKeys, tick_rate_hz, rig.file, name),
                          track_of(channel.mScalingKeys, channel.mNumScalingKeys, tick_rate_hz, rig.file, name)};
        for (const auto* track : {&tracks.translation, &tracks.rotation, &tracks.scale}) {
            if (!*track) continue;
            animation.start_s = std::min(animation.start_s, (*track)->times_s.front());
            animation.end_s = std::max(animation.end_s, (*track)->times_s.back());
        }
        if (!tracks.translation && !tracks.rotation && !tracks.scale) continue;
        rig.nodes[node->second].rest.matrix.reset();
        animation.nodes.push_back(std::move(tracks));
    }
    return animation;
}

}  // namespace

void add_assimp_animations(const aiScene& scene, Rig& rig)
{
    std::map<std::string, int> node_named;
    std::set<int> with_mesh;
    for (const RigMesh& mesh : rig.meshes) with_mesh.insert(mesh.node);
    for (const bool is_mesh : {true, false})  // of nodes with the same name, the one without a mesh, which is the joint
        for (std::size_t n = rig.nodes.size(); n-- > 0;)
            if ((with_mesh.count(static_cast<int>(n)) > 0) == is_mesh) node_named[rig.nodes[n].name] = static_cast<int>(n);
    for (unsigned a = 0; a < scene.mNumAnimations; ++a) {
        RigAnimation animation = animation_of(*scene.mAnimations[a], a, node_named, rig);
        if (!animation.nodes.empty()) rig.animations.push_back(std::move(animation));
    }
}

}  // namespace pbs
