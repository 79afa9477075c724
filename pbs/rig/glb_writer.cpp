#include "pbs/rig/glb_writer.hpp"

#include "pbs/geometry/input_error.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <fstream>
#include <string_view>

namespace pbs {
namespace {

using nlohmann::json;

constexpr double most_glb_bytes = 4.2e9;  // its lengths have 32 bits; some room for the description
constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8, bytes_per_number = 4;
constexpr int of_indices = 5125, of_floats = 5126;                             // component types: unsigned int, float
constexpr int for_vertices = 34962, for_triangles = 34963, triangle_list = 4;  // targets of views, and a mode of primitives
constexpr const char *scalar = "SCALAR", *vec3 = "VEC3";

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
struct GlbDocument {
    json document = {{"asset", {{"generator", "pbskin"}, {"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
    std::size_t bytes = 0;  // of the buffer

    // The number of the accessor. All components have four bytes, so that every view begins at a multiple of four. target: 0 for none.
    std::size_t add(std::size_t count, int component_type, const char* type, int target)
    {
        json view = {{"buffer", 0}, {"byteLength", bytes_per_number * count * (type == vec3 ? 3 : 1)}};
        if (bytes > 0) view["byteOffset"] = bytes;
        if (target > 0) view["target"] = target;
        bytes += view["byteLength"].get<std::size_t>();
        document["bufferViews"].push_back(view);
        const std::size_t number = document["bufferViews"].size() - 1;
        document["accessors"].push_back({{"bufferView", number}, {"componentType", component_type}, {"count", count}, {"type", type}});
        return document["accessors"].size() - 1;
    }

    void bound(std::size_t accessor, const std::vector<double>& smallest, const std::vector<double>& largest)
    {
        document["accessors"][accessor].update({{"min", smallest}, {"max", largest}});
    }

    // As JSON, padded with spaces to a multiple of four.
    std::string text()
    {
        document["buffers"] = {{{"byteLength", bytes}}};
        std::string text = document.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        return text;
    }
};

void add_animation(const std::vector<double>& times_s, GlbDocument& glb)
{
    const std::vector<float> times = single(times_s);
    const std::size_t input = glb.add(times_s.size(), of_floats, scalar, 0);
    glb.bound(input, {static_cast<double>(times.front())}, {static_cast<double>(times.back())});
    const std::size_t output = glb.add(times_s.size() * (times_s.size() - 1), of_floats, scalar, 0);
    glb.document["animations"] = {{{"name", "deformed"},
                                   {"samplers", {{{"input", input}, {"interpolation", "LINEAR"}, {"output", output}}}},
                                   {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
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
    GlbDocument glb;
    json primitive = {{"mode", triangle_list}, {"indices", glb.add(corners_, of_indices, scalar, for_triangles)}};
    for (std::size_t f = 0; f < times_s_.size(); ++f) {
        const std::size_t accessor = glb.add(static_cast<std::size_t>(first_frame_.rows()), of_floats, vec3, for_vertices);
        glb.bound(accessor, extents_[f].smallest, extents_[f].largest);
        if (f == 0)
            primitive["attributes"]["POSITION"] = accessor;
        else
            primitive["targets"].push_back({{"POSITION", accessor}});
    }
    json mesh = {{"name", name_}, {"primitives", json::array({primitive})}};
    if (times_s_.size() > 1) mesh["weights"] = std::vector<double>(times_s_.size() - 1, 0.0);
    glb.document["meshes"] = json::array({mesh});
    glb.document["nodes"] = {{{"mesh", 0}, {"name", name_}}};
    if (times_s_.size() > 1) add_animation(times_s_, glb);

    const std::string text = glb.text();
    const auto json_bytes = static_cast<std::uint32_t>(text.size()), data_bytes = static_cast<std::uint32_t>(glb.bytes);
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
