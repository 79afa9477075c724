#include "pbs/rig/glb_writer.hpp"

#include "pbs/geometry/atomic_file.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/rig/tiny_gltf.hpp"

#include <cstdint>
#include <cstring>
#include <sstream>

namespace pbs {
namespace {

// A glTF model whose numbers are all in one buffer.
class GlbModel {
public:
    tinygltf::Model model;

    GlbModel()
    {
        model.asset.version = "2.0";
        model.asset.generator = "pbskin";
        model.buffers.emplace_back();
    }

    // Points with their bounding box, which glTF requires of positions.
    int add_points(const Positions& points)
    {
        const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> single = points.cast<float>();
        const int accessor =
            add(single.data(), sizeof(float) * static_cast<std::size_t>(single.size()), static_cast<std::size_t>(single.rows()),
                TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
        for (int axis = 0; axis < 3; ++axis) {
            model.accessors[accessor].minValues.push_back(static_cast<double>(single.col(axis).minCoeff()));
            model.accessors[accessor].maxValues.push_back(static_cast<double>(single.col(axis).maxCoeff()));
        }
        return accessor;
    }

    int add_indices(const Triangles& triangles)
    {
        std::vector<std::uint32_t> indices(triangles.data(), triangles.data() + triangles.size());
        return add(indices.data(), sizeof(std::uint32_t) * indices.size(), indices.size(), TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                   TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    }

    int add_scalars(const std::vector<float>& scalars)
    {
        return add(scalars.data(), sizeof(float) * scalars.size(), scalars.size(), TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR, 0);
    }

private:
    // All components have four bytes, so that every view begins at a multiple of four.
    int add(const void* data, std::size_t bytes, std::size_t count, int component_type, int type, int target)
    {
        auto& buffer = model.buffers.front().data;
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = buffer.size();
        view.byteLength = bytes;
        view.target = target;
        buffer.resize(buffer.size() + bytes);
        if (bytes > 0) std::memcpy(buffer.data() + view.byteOffset, data, bytes);
        model.bufferViews.push_back(view);

        tinygltf::Accessor accessor;
        accessor.bufferView = static_cast<int>(model.bufferViews.size()) - 1;
        accessor.byteOffset = 0;
        accessor.componentType = component_type;
        accessor.count = count;
        accessor.type = type;
        model.accessors.push_back(accessor);
        return static_cast<int>(model.accessors.size()) - 1;
    }
};

void add_mesh(const std::string& name, const Triangles& triangles, const std::vector<Positions>& frames, GlbModel& glb)
{
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.indices = glb.add_indices(triangles);
    primitive.attributes["POSITION"] = glb.add_points(frames.front());
    for (std::size_t f = 1; f < frames.size(); ++f) primitive.targets.push_back({{"POSITION", glb.add_points(frames[f] - frames.front())}});
    tinygltf::Mesh mesh;
    mesh.name = name;
    mesh.primitives.push_back(primitive);
    mesh.weights.assign(frames.size() - 1, 0.0);
    glb.model.meshes.push_back(mesh);
}

// In frame f the weight of target f - 1 is one, and all others are zero.
void add_animation(const std::vector<double>& times_s, GlbModel& glb)
{
    std::vector<float> times, weights;
    for (std::size_t f = 0; f < times_s.size(); ++f) {
        times.push_back(static_cast<float>(times_s[f]));
        for (std::size_t target = 1; target < times_s.size(); ++target) weights.push_back(target == f ? 1.0F : 0.0F);
    }
    tinygltf::AnimationSampler sampler;
    sampler.input = glb.add_scalars(times);
    glb.model.accessors[sampler.input].minValues = {static_cast<double>(times.front())};
    glb.model.accessors[sampler.input].maxValues = {static_cast<double>(times.back())};
    sampler.output = glb.add_scalars(weights);
    sampler.interpolation = "LINEAR";
    tinygltf::AnimationChannel channel;
    channel.sampler = 0;
    channel.target_node = 0;
    channel.target_path = "weights";
    tinygltf::Animation animation;
    animation.name = "deformed";
    animation.samplers.push_back(sampler);
    animation.channels.push_back(channel);
    glb.model.animations.push_back(animation);
}

constexpr double most_glb_bytes = 4.2e9;  // its lengths have 32 bits; some room for the description

}  // namespace

void write_glb(const std::string& path, const std::string& name, const Triangles& triangles, const std::vector<double>& times_s,
               const std::vector<Positions>& frames)
{
    const auto count = static_cast<double>(frames.size()), numbers = static_cast<double>(frames.front().size());
    const double bytes_needed = 4.0 * count * (numbers + count);  // the points, and a weight per frame and target
    if (bytes_needed > most_glb_bytes)
        throw InputError(path, 0, "frames", std::to_string(frames.size()),
                         "expected fewer: a .glb file is limited to 4 GiB (output.frames_every writes fewer frames)");
    GlbModel glb;
    add_mesh(name, triangles, frames, glb);
    if (frames.size() > 1) add_animation(times_s, glb);
    tinygltf::Node node;
    node.name = name;
    node.mesh = 0;
    glb.model.nodes.push_back(node);
    tinygltf::Scene scene;
    scene.nodes.push_back(0);
    glb.model.scenes.push_back(scene);
    glb.model.defaultScene = 0;

    std::ostringstream bytes;
    tinygltf::TinyGLTF writer;
    if (!writer.WriteGltfSceneToStream(&glb.model, bytes, false, true)) throw InputError(path, 0, "", "", "tinygltf cannot write it");
    write_atomically(path, bytes.str());
}

}  // namespace pbs
