#include "experiments/rigs/glb_writer.hpp"

#include "pbs/geometry/input_error.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string_view>

namespace pbs {
namespace {

using nlohmann::json;

constexpr double most_glb_bytes = 4.2e9;  // its lengths have 32 bits; some room for the description
constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8, bytes_per_number = 4;
constexpr int of_shorts = 5123, of_indices = 5125,
              of_floats = 5126;  // component types: unsigned short, unsigned int, float
// targets of views, and a mode of primitives
constexpr int for_vertices = 34962, for_triangles = 34963, triangle_list = 4;
constexpr const char *scalar = "SCALAR", *vec2 = "VEC2", *vec3 = "VEC3", *vec4 = "VEC4", *mat4 = "MAT4";
constexpr int bones_per_set = 4;

std::size_t components(const char* type)
{
    return type == mat4 ? 16 : type == vec4 ? 4 : type == vec3 ? 3 : type == vec2 ? 2 : 1;
}

template <typename Number>
std::string_view bytes_of(const std::vector<Number>& numbers)
{
    return {reinterpret_cast<const char*>(numbers.data()), sizeof(Number) * numbers.size()};
}

std::string words(const std::vector<std::uint32_t>& numbers)
{
    return std::string(bytes_of(numbers));
}

std::string padded(std::string bytes)
{
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    return bytes;
}

// The numbers of a set of texture coordinates.
std::vector<float> coordinates(const RigLook& look, Eigen::Index set)
{
    const Eigen::Matrix<float, Eigen::Dynamic, 2, Eigen::RowMajor> rows = look.numbers.middleCols<2>(3 + 2 * set);
    return {rows.data(), rows.data() + rows.size()};
}

Eigen::Index sets_of(const RigLook& look)
{
    return std::max<Eigen::Index>(look.numbers.cols() - 3, 0) / 2;
}

// The smooth piece that each point belongs to: points at one place with one normal, to a hundredth, are one.
std::vector<int> smooth_pieces(const Positions& points, const RigLook& look)
{
    std::map<std::array<double, 6>, int> pieces;
    std::vector<int> piece;
    for (Eigen::Index p = 0; p < points.rows(); ++p) {
        std::array<double, 6> key{points(p, 0), points(p, 1), points(p, 2)};
        for (int axis = 0; axis < 3; ++axis)
            key[3 + axis] = std::round(100.0 * static_cast<double>(look.numbers(p, axis)));
        piece.push_back(pieces.emplace(key, static_cast<int>(pieces.size())).first->second);
    }
    return piece;
}

std::vector<float> single(const std::vector<double>& numbers)
{
    return {numbers.begin(), numbers.end()};
}

// The description of a file whose numbers are all in one buffer, in the order in which they are added.
struct GlbDocument {
    json document = {
        {"asset", {{"generator", "pbskin"}, {"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
    std::size_t bytes = 0;  // of the buffer
    std::string behind;     // its end, behind the numbers that GlbWriter has written

    std::size_t add_view(std::size_t length, int target)
    {
        json view = {{"buffer", 0}, {"byteLength", length}};
        if (bytes > 0) view["byteOffset"] = bytes;
        if (target > 0) view["target"] = target;
        bytes += (length + 3) / 4 * 4;
        document["bufferViews"].push_back(view);
        return document["bufferViews"].size() - 1;
    }

    // The number of the accessor. target: 0 for none.
    std::size_t add(std::size_t count, int component_type, const char* type, int target)
    {
        const std::size_t number =
            add_view((component_type == of_shorts ? 2 : bytes_per_number) * count * components(type), target);
        document["accessors"].push_back(
            {{"bufferView", number}, {"componentType", component_type}, {"count", count}, {"type", type}});
        return document["accessors"].size() - 1;
    }

    // An accessor of numbers behind all others.
    template <typename Number>
    std::size_t append(const std::vector<Number>& numbers, const char* type, int target = 0)
    {
        behind += padded(std::string(bytes_of(numbers)));
        return add(numbers.size() / components(type), sizeof(Number) == 2 ? of_shorts : of_floats, type, target);
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

std::size_t add_times(const std::vector<double>& times_s, GlbDocument& glb)
{
    const std::vector<float> times = single(times_s);
    const std::size_t input = glb.append(times, scalar);
    glb.bound(input, {static_cast<double>(times.front())}, {static_cast<double>(times.back())});
    return input;
}

// A channel of the animation, with linear interpolation.
void animate(std::size_t node, const char* path, std::size_t input, std::size_t output, GlbDocument& glb)
{
    json& animation = glb.document["animations"][0];
    animation["name"] = "deformed";
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    animation["samplers"].push_back({{"input", input}, {"interpolation", "LINEAR"}, {"output", output}});
}

// In frame f the weight of target f - 1 is one, and all others are zero.
void animate_frames(const std::vector<double>& times_s, GlbDocument& glb)
{
    const std::size_t targets = times_s.size() - 1;
    std::vector<float> weights(times_s.size() * targets, 0.0F);
    for (std::size_t target = 0; target < targets; ++target) weights[(target + 1) * targets + target] = 1.0F;
    const std::size_t input = add_times(times_s, glb);
    animate(0, "weights", input, glb.append(weights, scalar), glb);
}

// The attributes JOINTS_0, WEIGHTS_0 and so on of the points.
void add_weights(const Weights& weights, GlbDocument& glb, json& attributes)
{
    int most = 1;
    for (int p = 0; p < weights.vertices(); ++p) most = std::max(most, weights.first[p + 1] - weights.first[p]);
    for (int set = 0; set * bones_per_set < most; ++set) {
        std::vector<std::uint16_t> bones(static_cast<std::size_t>(bones_per_set * weights.vertices()), 0);
        std::vector<float> shares(bones.size(), 0.0F);
        for (int p = 0; p < weights.vertices(); ++p)
            for (int k = 0; k < bones_per_set; ++k) {
                const int entry = weights.first[p] + set * bones_per_set + k;
                if (entry >= weights.first[p + 1]) break;
                bones[static_cast<std::size_t>(bones_per_set * p + k)] =
                    static_cast<std::uint16_t>(weights.bone[entry]);
                shares[static_cast<std::size_t>(bones_per_set * p + k)] = static_cast<float>(weights.weight[entry]);
            }
        attributes["JOINTS_" + std::to_string(set)] = glb.append(bones, vec4, for_vertices);
        attributes["WEIGHTS_" + std::to_string(set)] = glb.append(shares, vec4, for_vertices);
    }
}

// A node per bone behind that of the mesh, at the bone's head, with the axes of the world at rest.
void add_bones(const Skeleton& skeleton, GlbDocument& glb)
{
    std::vector<float> inverse_binds;
    json& nodes = glb.document["nodes"];
    json joints = json::array();
    for (const Bone& bone : skeleton.bones) {
        const std::size_t node = nodes.size();
        const Vec3 place = bone.parent < 0 ? bone.head : Vec3(bone.head - skeleton.bones[bone.parent].head);
        nodes.push_back({{"name", bone.name}, {"translation", {place.x(), place.y(), place.z()}}});
        (bone.parent < 0 ? glb.document["scenes"][0]["nodes"]
                         : nodes[static_cast<std::size_t>(bone.parent) + 1]["children"])
            .push_back(node);
        joints.push_back(node);
        const Eigen::Matrix4f bind = Eigen::Affine3d(Eigen::Translation3d(-bone.head)).matrix().cast<float>();
        inverse_binds.insert(inverse_binds.end(), bind.data(), bind.data() + bind.size());
    }
    glb.document["skins"] = {{{"joints", joints}, {"inverseBindMatrices", glb.append(inverse_binds, mat4)}}};
    nodes[0]["skin"] = 0;
}

void animate_skin(const GlbSkin& skin, GlbDocument& glb)
{
    const std::size_t input = add_times(skin.times_s, glb);
    if (skin.target_weights.cols() > 0) {
        const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> weights =
            skin.target_weights.cast<float>();
        animate(0, "weights", input,
                glb.append(std::vector<float>(weights.data(), weights.data() + weights.size()), scalar), glb);
    }
    for (std::size_t b = 0; b < skin.skeleton.bones.size(); ++b) {
        const Bone& bone = skin.skeleton.bones[b];
        std::vector<float> turns, places;
        for (const Pose& pose : skin.poses) {
            const Vec3 head = pose[b] * bone.head;
            const Eigen::Isometry3d parent = bone.parent < 0 ? Eigen::Isometry3d::Identity() : pose[bone.parent];
            const Vec3 origin = bone.parent < 0 ? Vec3(Vec3::Zero()) : skin.skeleton.bones[bone.parent].head;
            const Eigen::Quaterniond relative(Eigen::Matrix3d(parent.linear().transpose() * pose[b].linear()));
            const Eigen::Vector4d turn = relative.normalized().coeffs();
            const Vec3 place = parent.inverse() * head - origin;
            for (const double number : turn) turns.push_back(static_cast<float>(number));
            for (const double number : place) places.push_back(static_cast<float>(number));
        }
        animate(b + 1, "rotation", input, glb.append(turns, vec4), glb);
        animate(b + 1, "translation", input, glb.append(places, vec3), glb);
    }
}

void copy(const std::string& from, AtomicFile& file)
{
    std::ifstream data(from, std::ios::binary);
    std::vector<char> piece(1 << 20);
    while (data.read(piece.data(), static_cast<std::streamsize>(piece.size())) || data.gcount() > 0)
        file.write({piece.data(), static_cast<std::size_t>(data.gcount())});
}

}  // namespace

GlbWriter::GlbWriter(std::string path, std::string name, const Triangles& triangles, RigLook look,
                     RigMaterials materials)
    : path_(std::move(path)),
      name_(std::move(name)),
      data_(path_),
      triangles_(triangles),
      look_(std::move(look)),
      materials_(std::move(materials)),
      has_normals_(look_.numbers.cols() > 0 && !look_.numbers.leftCols<3>().isZero())
{
    const int count =
        materials_.document.empty() ? 0 : static_cast<int>(json::parse(materials_.document)["materials"].size());
    std::map<int, std::vector<std::uint32_t>> corners;  // by material, -1: none
    for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
        const int material = look_.material.empty() ? -1 : look_.material[static_cast<std::size_t>(f)];
        for (const int corner : triangles.row(f))
            corners[material < count ? material : -1].push_back(static_cast<std::uint32_t>(corner));
    }
    const auto write = [&](std::string_view bytes) {
        data_.write(bytes);
        data_bytes_ += static_cast<double>(bytes.size());
    };
    for (const auto& [material, own] : corners) {
        corners_[material] = own.size();
        write(bytes_of(own));
    }
    for (Eigen::Index set = 0; set < sets_of(look_); ++set) write(bytes_of(coordinates(look_, set)));
    for (const std::string& image : materials_.images) write(padded(image));
}

Positions GlbWriter::normals_of(const Positions& points) const
{
    Positions sum = Positions::Zero(points.rows(), 3), normals(points.rows(), 3);
    for (const auto& triangle : triangles_.rowwise()) {
        const Vec3 a = points.row(triangle(0)), b = points.row(triangle(1)), c = points.row(triangle(2));
        for (const int corner : triangle) sum.row(piece_[corner]) += (b - a).cross(c - a).transpose();
    }
    for (Eigen::Index p = 0; p < points.rows(); ++p) {
        const Vec3 normal = Vec3(sum.row(piece_[p])).normalized();
        normals.row(p) = normal.isZero() ? Vec3(Vec3::UnitY()) : normal;  // of a point of no triangle with an area
    }
    return normals;
}

void GlbWriter::write_rows(const Positions& rows)
{
    const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> single = rows.cast<float>();
    data_.write(
        {reinterpret_cast<const char*>(single.data()), sizeof(float) * static_cast<std::size_t>(single.size())});
}

double GlbWriter::bytes(int frames) const
{
    const auto numbers = static_cast<double>((has_normals_ ? 2 : 1) * first_frame_.size());
    // with a weight per frame and target
    return data_bytes_ + static_cast<double>(bytes_per_number) * frames * (numbers + frames);
}

void GlbWriter::add_frame(double time_s, const Positions& points)
{
    const bool is_first = times_s_.empty();
    if (is_first) first_frame_ = points;
    if (bytes(static_cast<int>(times_s_.size()) + 1) > most_glb_bytes)
        throw InputError(path_, 0, "frames", std::to_string(times_s_.size() + 1),
                         "expected fewer: a .glb file is limited to 4 GiB (output.frames_every writes fewer frames)");
    const Positions stored = is_first ? points : Positions(points - first_frame_);
    write_rows(stored);
    Extent extent;
    for (int axis = 0; axis < 3; ++axis) {
        extent.smallest.push_back(static_cast<double>(static_cast<float>(stored.col(axis).minCoeff())));
        extent.largest.push_back(static_cast<double>(static_cast<float>(stored.col(axis).maxCoeff())));
    }
    if (has_normals_) {
        if (is_first) piece_ = smooth_pieces(points, look_);
        const Positions normals = normals_of(points);
        if (is_first) first_normals_ = normals;
        write_rows(is_first ? normals : Positions(normals - first_normals_));
    }
    extents_.push_back(extent);
    times_s_.push_back(time_s);
}

void GlbWriter::write(const GlbSkin* skin)
{
    GlbDocument glb;
    if (!materials_.document.empty()) glb.document.update(json::parse(materials_.document));
    const auto points = static_cast<std::size_t>(first_frame_.rows());
    json mesh = {{"name", name_}, {"primitives", json::array()}}, all;  // all: of all primitives
    for (const auto& [material, corners] : corners_) {
        mesh["primitives"].push_back(
            {{"mode", triangle_list}, {"indices", glb.add(corners, of_indices, scalar, for_triangles)}});
        if (material >= 0) mesh["primitives"].back()["material"] = material;
    }
    for (Eigen::Index set = 0; set < sets_of(look_); ++set)
        all["attributes"]["TEXCOORD_" + std::to_string(set)] = glb.add(points, of_floats, vec2, for_vertices);
    for (std::size_t i = 0; i < materials_.images.size(); ++i)
        glb.document["images"][i]["bufferView"] = glb.add_view(materials_.images[i].size(), 0);
    for (std::size_t f = 0; f < times_s_.size(); ++f) {
        json frame = {{"POSITION", glb.add(points, of_floats, vec3, for_vertices)}};
        glb.bound(frame["POSITION"], extents_[f].smallest, extents_[f].largest);
        if (has_normals_) frame["NORMAL"] = glb.add(points, of_floats, vec3, for_vertices);
        if (f == 0)
            all["attributes"].update(frame);
        else
            all["targets"].push_back(frame);
    }
    if (skin) add_weights(skin->weights, glb, all["attributes"]);
    for (json& primitive : mesh["primitives"]) primitive.update(all);
    if (times_s_.size() > 1) mesh["weights"] = std::vector<double>(times_s_.size() - 1, 0.0);
    glb.document["meshes"] = json::array({mesh});
    glb.document["nodes"] = {{{"mesh", 0}, {"name", name_}}};
    if (skin) {
        add_bones(skin->skeleton, glb);
        animate_skin(*skin, glb);
    } else if (times_s_.size() > 1) {
        animate_frames(times_s_, glb);
    }

    const std::string text = glb.text();
    const auto json_bytes = static_cast<std::uint32_t>(text.size()), data_bytes = static_cast<std::uint32_t>(glb.bytes);
    const auto all_bytes = static_cast<std::uint32_t>(header_bytes + 2 * chunk_header_bytes) + json_bytes + data_bytes;
    AtomicFile file(path_);
    file.write("glTF" + words({2, all_bytes, json_bytes, json_chunk}) + text + words({data_bytes, binary_chunk}));
    copy(data_.temporary(), file);
    file.write(glb.behind);
    file.finish();
}

}  // namespace pbs
