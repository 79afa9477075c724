#include "pbs/rig/gltf_animations.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/rig/gltf_numbers.hpp"
#include "pbs/rig/tiny_gltf.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace pbs {
namespace {

Interpolation interpolation_of(const std::string& name, const std::string& path, const std::string& field)
{
    if (name.empty() || name == "LINEAR") return Interpolation::linear;
    if (name == "STEP") return Interpolation::step;
    if (name == "CUBICSPLINE") return Interpolation::cubic_spline;
    throw InputError(path, 0, field + "/interpolation", name, "expected LINEAR, STEP or CUBICSPLINE");
}

KeyTrack track_of(const tinygltf::Model& model, const tinygltf::AnimationSampler& sampler, int components, const std::string& path,
                  const std::string& field)
{
    KeyTrack track;
    track.interpolation = interpolation_of(sampler.interpolation, path, field);
    const AccessorNumbers times = accessor_numbers(model, sampler.input, 1, path, field + "/input");
    const AccessorNumbers values = accessor_numbers(model, sampler.output, components, path, field + "/output");
    const Eigen::Index per_key = track.interpolation == Interpolation::cubic_spline ? 3 : 1;
    if (times.rows() == 0) throw InputError(path, 0, field + "/input", "", "expected at least one key");
    if (values.rows() != per_key * times.rows())
        throw InputError(path, 0, field + "/output", std::to_string(values.rows()),
                         "expected " + std::to_string(per_key * times.rows()) + " for " + std::to_string(times.rows()) + " keys");
    track.times_s.assign(times.data(), times.data() + times.size());
    if (!std::is_sorted(track.times_s.begin(), track.times_s.end()))
        throw InputError(path, 0, field + "/input", "", "expected times that do not go back");
    for (Eigen::Index v = 0; v < values.rows(); ++v) {
        track.values.emplace_back(Eigen::Vector4d::Zero());
        track.values.back().head(components) = values.row(v).transpose();
        const bool is_key = per_key == 1 || v % 3 == 1;  // between the tangents of a spline
        if (components == 4 && is_key && !(track.values.back().norm() > 0.0))
            throw InputError(path, 0, field + "/output, key " + std::to_string(v / per_key), "", "expected a quaternion that is not zero");
    }
    return track;
}

class AnimationReader {
public:
    AnimationReader(const tinygltf::Model& model, std::size_t index, const std::vector<int>& rig_node, Rig& rig)
        : model_(model), source_(model.animations[index]), field_("animations/" + std::to_string(index)), rig_node_(rig_node), rig_(rig)
    {
        animation_.name = source_.name.empty() ? "animation " + std::to_string(index) : source_.name;
        animation_.start_s = std::numeric_limits<double>::max();
    }

    RigAnimation read()
    {
        for (std::size_t c = 0; c < source_.channels.size(); ++c) add(source_.channels[c], field_ + "/channels/" + std::to_string(c));
        for (auto& [node, tracks] : tracks_) {
            tracks.node = node;
            animation_.nodes.push_back(std::move(tracks));
        }
        return animation_;
    }

private:
    // A channel without a node is to be ignored (glTF 2.0, Sec. 3.11).
    void add(const tinygltf::AnimationChannel& channel, const std::string& field)
    {
        if (channel.target_path == "weights") {
            if (!morphs_) rig_.remarks.push_back("animation " + animation_.name + ": the changes of morph targets are left out");
            morphs_ = true;
            return;
        }
        if (channel.target_node < 0) return;
        check(channel, field);
        const bool rotation = channel.target_path == "rotation";
        KeyTrack track = track_of(model_, source_.samplers[channel.sampler], rotation ? 4 : 3, rig_.file,
                                  field_ + "/samplers/" + std::to_string(channel.sampler));
        animation_.start_s = std::min(animation_.start_s, track.times_s.front());
        animation_.end_s = std::max(animation_.end_s, track.times_s.back());
        NodeTracks& node = tracks_[rig_node_[channel.target_node]];
        (rotation ? node.rotation : channel.target_path == "scale" ? node.scale : node.translation) = std::move(track);
    }

    void check(const tinygltf::AnimationChannel& channel, const std::string& field) const
    {
        if (channel.target_node >= static_cast<int>(rig_node_.size()))
            throw InputError(rig_.file, 0, field + "/target/node", std::to_string(channel.target_node), "expected a node of the file");
        if (!model_.nodes[channel.target_node].matrix.empty())
            throw InputError(rig_.file, 0, field + "/target/node", std::to_string(channel.target_node),
                             "expected a node without a matrix: its animation replaces translation, rotation or scale");
        if (channel.sampler < 0 || channel.sampler >= static_cast<int>(source_.samplers.size()))
            throw InputError(rig_.file, 0, field + "/sampler", std::to_string(channel.sampler), "expected a sampler of the animation");
        if (channel.target_path != "translation" && channel.target_path != "rotation" && channel.target_path != "scale")
            throw InputError(rig_.file, 0, field + "/target/path", channel.target_path, "expected translation, rotation, scale or weights");
    }

    const tinygltf::Model& model_;
    const tinygltf::Animation& source_;
    std::string field_;
    const std::vector<int>& rig_node_;
    Rig& rig_;
    RigAnimation animation_;
    std::map<int, NodeTracks> tracks_;  // by node
    bool morphs_ = false;
};

}  // namespace

void add_gltf_animations(const tinygltf::Model& model, const std::vector<int>& rig_node, Rig& rig)
{
    for (std::size_t index = 0; index < model.animations.size(); ++index) {
        RigAnimation animation = AnimationReader(model, index, rig_node, rig).read();
        if (!animation.nodes.empty()) rig.animations.push_back(std::move(animation));
    }
}

}  // namespace pbs
