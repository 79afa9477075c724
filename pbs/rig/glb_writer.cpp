#include "pbs/rig/glb_writer.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/rig/tiny_gltf.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string_view>

namespace pbs {
namespace {

constexpr double most_glb_bytes = 4.2e9;  // its lengths have 32 bits; some room for the description
constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8, bytes_per_number = 4;

template <typename Number>
std::string_view bytes_of(const std::vector<Number>& numbers)
{
    return {reinterpret_cast<const char*>(numbers.data()), sizeof(Number) * numbers.size()};
}

std::string words(const std::vector<std::uint32_t>& numbers)
{
    return std::string(bytes_of(numbers));
}

// In frame f the weight of target f - 1 is one, and all others are zero.
std::vector<float> weights_in(std::size_t frame, std::size_t frames)
{
    std::vector<float> weights(frames - 1, 0.0F);
    if (frame > 0) weights[frame - 1] = 1.0F;
    return weights;
}

std::vector<float> single(const std::vector<double>& numbers)
{
    return {numbers.begin(), numbers.end()};
}

// The description of a file whose numbers are all in one buffer, in the order in which they are added.
class GlbModel {
public:
    tinygltf::Model model;

    GlbModel()
    {
        model.asset.version = "2.0";
        model.asset.generator = "pbskin";
    }

    // All components have four bytes, so that every view begins at a multiple of four.
    int add(std::size_t count, int component_type, int type, int target)
    {
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = bytes_;
        view.byteLength = bytes_per_number * count * (type == TINYGLTF_TYPE_VEC3 ? 3 : 1);
        view.target = target;
        bytes_ += view.byteLength;
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

    int add_scalars(std::size_t count) { return add(count, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_SCALAR, 0); }

    std::size_t bytes() const { return bytes_; }  // of the buffer

    // The description as JSON, padded with spaces to a multiple of four.
    std::string text()
    {
        std::ostringstream stream;
        tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, false);
        nlohmann::json document = nlohmann::json::parse(stream.str());
        document["buffers"] = {{{"byteLength", bytes_}}};
        std::string text = document.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        return text;
    }

private:
    std::size_t bytes_ = 0;
};

void add_animation(const std::vector<double>& times_s, GlbModel& glb)
{
    tinygltf::AnimationSampler sampler;
    sampler.input = glb.add_scalars(times_s.size());
    const std::vector<float> times = single(times_s);
    glb.model.accessors[sampler.input].minValues = {static_cast<double>(times.front())};
    glb.model.accessors[sampler.input].maxValues = {static_cast<double>(times.back())};
    sampler.output = glb.add_scalars(times_s.size() * (times_s.size() - 1));
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

void add_scene(const std::string& name, GlbModel& glb)
{
    tinygltf::Node node;
    node.name = name;
    node.mesh = 0;
    glb.model.nodes.push_back(node);
    tinygltf::Scene scene;
    scene.nodes.push_back(0);
    glb.model.scenes.push_back(scene);
    glb.model.defaultScene = 0;
}

void copy(const std::string& from, AtomicFile& file)
{
    std::ifstream data(from, std::ios::binary);
    std::vector<char> piece(1 << 20);
    while (data.read(piece.data(), static_cast<std::streamsize>(piece.size())) || data.gcount() > 0)
        file.write({piece.data(), static_cast<std::size_t>(data.gcount())});
}

}  // namespace

GlbWriter::GlbWriter(std::string path, std::string name, const Triangles& triangles)
    : path_(std::move(path)), name_(std::move(name)), data_(path_), corners_(static_cast<std::size_t>(triangles.size()))
{
    data_.write(bytes_of(std::vector<std::uint32_t>(triangles.data(), triangles.data() + triangles.size())));
}

void GlbWriter::add_frame(double time_s, const Positions& points)
{
    if (times_s_.empty()) first_frame_ = points;
    const auto count = static_cast<double>(times_s_.size() + 1), numbers = static_cast<double>(points.size());
    if (bytes_per_number * count * (numbers + count) > most_glb_bytes)  // the points, and a weight per frame and target
        throw InputError(path_, 0, "frames", std::to_string(times_s_.size() + 1),
                         "expected fewer: a .glb file is limited to 4 GiB (output.frames_every writes fewer frames)");
    const Positions stored = times_s_.empty() ? points : Positions(points - first_frame_);
    const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> single = stored.cast<float>();
    data_.write({reinterpret_cast<const char*>(single.data()), sizeof(float) * static_cast<std::size_t>(single.size())});
    Extent extent;
    for (int axis = 0; axis < 3; ++axis) {
        extent.smallest.push_back(static_cast<double>(single.col(axis).minCoeff()));
        extent.largest.push_back(static_cast<double>(single.col(axis).maxCoeff()));
    }
    extents_.push_back(extent);
    times_s_.push_back(time_s);
}

void GlbWriter::write()
{
    GlbModel glb;
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.indices = glb.add(corners_, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    for (std::size_t f = 0; f < times_s_.size(); ++f) {
        const int accessor = glb.add(static_cast<std::size_t>(first_frame_.rows()), TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3,
                                     TINYGLTF_TARGET_ARRAY_BUFFER);
        glb.model.accessors[accessor].minValues = extents_[f].smallest;
        glb.model.accessors[accessor].maxValues = extents_[f].largest;
        if (f == 0)
            primitive.attributes["POSITION"] = accessor;
        else
            primitive.targets.push_back({{"POSITION", accessor}});
    }
    tinygltf::Mesh mesh;
    mesh.name = name_;
    mesh.primitives.push_back(primitive);
    mesh.weights.assign(times_s_.size() - 1, 0.0);
    glb.model.meshes.push_back(mesh);
    if (times_s_.size() > 1) add_animation(times_s_, glb);
    add_scene(name_, glb);

    const std::string text = glb.text();
    const auto json_bytes = static_cast<std::uint32_t>(text.size()), data_bytes = static_cast<std::uint32_t>(glb.bytes());
    const auto all_bytes = static_cast<std::uint32_t>(header_bytes + 2 * chunk_header_bytes) + json_bytes + data_bytes;
    AtomicFile file(path_);
    file.write("glTF" + words({2, all_bytes, json_bytes, json_chunk}) + text + words({data_bytes, binary_chunk}));
    copy(data_.temporary(), file);
    if (times_s_.size() > 1) file.write(bytes_of(single(times_s_)));
    if (times_s_.size() > 1)
        for (std::size_t f = 0; f < times_s_.size(); ++f) file.write(bytes_of(weights_in(f, times_s_.size())));
    file.finish();
}

}  // namespace pbs
