#include "pbs/rig/rig_formats.hpp"

#include "pbs/geometry/assimp_files.hpp"
#include "pbs/geometry/files.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/rig/rig_reader.hpp"

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/version.h>
#include <minizip/unzip.h>
#include <pugixml.hpp>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>

namespace pbs {
namespace {

// The .dae files of an archive; none where it is damaged.
std::vector<std::string> collada_files_in(const std::string& path)
{
    std::vector<std::string> texts;
    unzFile archive = unzOpen(path.c_str());
    if (!archive) return texts;
    for (int state = unzGoToFirstFile(archive); state == UNZ_OK; state = unzGoToNextFile(archive)) {
        unz_file_info about{};
        char name[1024] = {};
        if (unzGetCurrentFileInfo(archive, &about, name, sizeof name - 1, nullptr, 0, nullptr, 0) != UNZ_OK) break;
        if (lower_extension(name) != ".dae" || unzOpenCurrentFile(archive) != UNZ_OK) continue;
        char buffer[1 << 14];
        std::string text;
        for (int count = 0; (count = unzReadCurrentFile(archive, buffer, sizeof buffer)) > 0;)
            text.append(buffer, static_cast<std::size_t>(count));
        unzCloseCurrentFile(archive);
        texts.push_back(std::move(text));
    }
    unzClose(archive);
    return texts;
}

std::vector<std::string_view> words_of(std::string_view text)
{
    constexpr const char* spaces = " \t\r\n";
    std::vector<std::string_view> words;
    for (std::size_t at = text.find_first_not_of(spaces); at != std::string_view::npos; at = text.find_first_not_of(spaces, at)) {
        const std::size_t end = std::min(text.find_first_of(spaces, at), text.size());
        words.push_back(text.substr(at, end - at));
        at = end;
    }
    return words;
}

// Nothing is added for words that are no whole numbers: the reader refuses the file.
std::vector<std::size_t> whole_numbers_of(std::string_view text)
{
    std::vector<std::size_t> numbers;
    for (const std::string_view word : words_of(text)) {
        std::size_t number = 0;
        if (std::from_chars(word.data(), word.data() + word.size(), number).ec == std::errc()) numbers.push_back(number);
    }
    return numbers;
}

bool is_weight(std::string_view word)
{
    if (word.starts_with('+')) word.remove_prefix(1);
    double weight = std::numeric_limits<double>::quiet_NaN();
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), weight);
    if (error == std::errc::result_out_of_range) return !word.starts_with('-') && word.find("e-") != std::string_view::npos;  // nearly zero
    return end == word.data() + word.size() && std::isfinite(weight) && weight >= 0.0;
}

std::size_t number_of(const pugi::xml_node& node, const char* attribute, unsigned missing = 0)
{
    return node.attribute(attribute).as_uint(missing);
}

// The weight of each pair of a joint and a weight, with the point of the pair.
struct WeightIndices {
    std::string source;  // its name
    std::vector<std::pair<std::size_t, std::size_t>> point_and_weight;
};

WeightIndices weight_indices_of(const pugi::xml_node& vertex_weights)
{
    WeightIndices indices;
    std::size_t stride = 1, offset = 0;
    for (const pugi::xml_node input : vertex_weights.children("input")) {
        stride = std::max(stride, number_of(input, "offset") + 1);
        if (input.attribute("semantic").as_string() != std::string_view("WEIGHT")) continue;
        offset = number_of(input, "offset");
        indices.source = input.attribute("source").as_string();
    }
    const std::vector<std::size_t> counts = whole_numbers_of(vertex_weights.child("vcount").text().as_string());
    const std::vector<std::size_t> numbers = whole_numbers_of(vertex_weights.child("v").text().as_string());
    std::size_t at = offset;
    for (std::size_t point = 0; point < counts.size(); ++point)
        for (std::size_t pair = 0; pair < counts[point] && at < numbers.size(); ++pair, at += stride)
            indices.point_and_weight.emplace_back(point, numbers[at]);
    return indices;
}

void check_skin(const pugi::xml_node& controller, const std::string& path)
{
    const pugi::xml_node skin = controller.child("skin");
    const WeightIndices indices = weight_indices_of(skin.child("vertex_weights"));
    if (!indices.source.starts_with('#')) return;
    const pugi::xml_node source = skin.find_child_by_attribute("source", "id", indices.source.c_str() + 1);
    const pugi::xml_node accessor = source.child("technique_common").child("accessor");
    const std::vector<std::string_view> weights = words_of(source.child("float_array").text().as_string());
    const std::size_t first = number_of(accessor, "offset"), stride = number_of(accessor, "stride", 1);
    for (const auto& [point, index] : indices.point_and_weight) {
        const std::size_t at = first + stride * index;
        if (at < weights.size() && !is_weight(weights[at]))
            throw InputError(
                path, 0, "controller " + std::string(controller.attribute("id").as_string()) + ", weight of point " + std::to_string(point),
                std::string(weights[at]), "expected a finite number of 0 or more");
    }
}

void check_document(const std::string& text, const std::string& path)
{
    pugi::xml_document document;
    if (!document.load_buffer(text.data(), text.size())) return;
    std::set<std::string> used;
    for (const pugi::xpath_node& node : document.select_nodes("//instance_controller"))
        used.insert(node.node().attribute("url").as_string());
    for (const pugi::xml_node library : document.child("COLLADA").children("library_controllers"))
        for (const pugi::xml_node controller : library.children("controller"))
            if (used.contains(std::string("#") + controller.attribute("id").as_string())) check_skin(controller, path);
}

using Flags = std::vector<std::int32_t>;

constexpr std::string_view flags_key = "KeyAttrFlags";
constexpr std::int32_t linear = 4, all_kinds = 2 | 4 | 8;  // constant, linear, cubic
constexpr std::uint32_t most_keys = 1 << 24;

std::uint32_t number_at(const std::string& bytes, std::size_t at)
{
    std::uint32_t number = 0;
    std::memcpy(&number, bytes.data() + at, sizeof number);
    return number;
}

// A property of a binary file: the letter i, the number of keys, the encoding (1: zlib), the number of bytes, and the bytes.
std::optional<Flags> binary_flags(const std::string& bytes, std::size_t at)
{
    constexpr std::size_t header = 13;
    if (at + header > bytes.size() || bytes[at] != 'i') return std::nullopt;
    const std::uint32_t keys = number_at(bytes, at + 1), encoding = number_at(bytes, at + 5), size = number_at(bytes, at + 9);
    if (keys > most_keys || size > bytes.size() - at - header) return std::nullopt;
    Flags flags(keys);
    uLongf unpacked = sizeof(std::int32_t) * flags.size();
    if (encoding == 0 && size == unpacked)
        std::copy_n(bytes.data() + at + header, size, reinterpret_cast<char*>(flags.data()));
    else if (encoding != 1 || uncompress(reinterpret_cast<Bytef*>(flags.data()), &unpacked,
                                         reinterpret_cast<const Bytef*>(bytes.data() + at + header), size) != Z_OK)
        return std::nullopt;
    flags.resize(unpacked / sizeof(std::int32_t));
    return flags;
}

// "KeyAttrFlags: *2 { a: 4,4 }", from the colon on.
std::optional<Flags> text_flags(const std::string& bytes, std::size_t at)
{
    const std::size_t end = bytes.find('}', at), numbers = bytes.find("a:", at);
    if (end == std::string::npos || numbers > end) return std::nullopt;
    Flags flags;
    for (std::size_t next = numbers + 2; next < end;) {
        std::int32_t flag = 0;
        const auto [rest, error] = std::from_chars(bytes.data() + next, bytes.data() + end, flag);
        if (error == std::errc()) flags.push_back(flag);
        next = std::max(next + 1, static_cast<std::size_t>(rest - bytes.data()));
    }
    return flags;
}

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

// Appends to `rig.animations` those that move a node of the rig; channels of other names are remarks. The matrix of a node that is moved is
// removed, since an animation replaces its translation, rotation and scale.
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

using Nodes = std::vector<const aiNode*>;  // in the order of the rig

Eigen::Affine3d to_eigen(const aiMatrix4x4& matrix)
{
    Eigen::Affine3d affine;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            affine.affine()(row, column) = matrix[static_cast<unsigned>(row)][static_cast<unsigned>(column)];
    return affine;
}

// Animations replace a node's whole transform, so that its parts are needed only where an animation has no keys for them.
NodeTransform transform_of(const aiNode& node)
{
    NodeTransform transform;
    aiVector3D scale, translation;
    aiQuaternion rotation;
    node.mTransformation.Decompose(scale, rotation, translation);
    transform.translation = {translation.x, translation.y, translation.z};
    transform.rotation = Eigen::Quaterniond(rotation.w, rotation.x, rotation.y, rotation.z);
    transform.scale = {scale.x, scale.y, scale.z};
    transform.matrix = to_eigen(node.mTransformation);
    return transform;
}

void add_node(const aiNode& node, int parent, Nodes& nodes, Rig& rig)
{
    const int index = static_cast<int>(rig.nodes.size());
    nodes.push_back(&node);
    rig.nodes.push_back({node.mName.C_Str(), parent, transform_of(node)});
    if (!rig.nodes.back().rest.matrix->matrix().allFinite())
        throw InputError(rig.file, 0, "node " + rig.nodes.back().name, "", "expected finite numbers");
    for (unsigned child = 0; child < node.mNumChildren; ++child) add_node(*node.mChildren[child], index, nodes, rig);
}

// The node of a joint. A node with a mesh may have the same name; the joint is the one without.
int joint_named(const std::string& name, const Nodes& nodes, const Rig& rig)
{
    int with_mesh = -1;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (name != nodes[n]->mName.C_Str()) continue;
        if (nodes[n]->mNumMeshes == 0) return static_cast<int>(n);
        with_mesh = static_cast<int>(n);
    }
    if (with_mesh < 0) throw InputError(rig.file, 0, "joint", name, "the skin names a joint that is no node of the file");
    return with_mesh;
}

Weights skin_of(const aiMesh& mesh, const RigMesh& own, Rig& rig)
{
    std::vector<std::vector<JointShare>> points(mesh.mNumVertices);
    for (unsigned joint = 0; joint < mesh.mNumBones; ++joint)
        for (unsigned w = 0; w < mesh.mBones[joint]->mNumWeights; ++w) {
            const aiVertexWeight& weight = mesh.mBones[joint]->mWeights[w];
            if (weight.mVertexId >= mesh.mNumVertices)
                throw InputError(rig.file, 0, "mesh " + std::string(mesh.mName.C_Str()) + ", vertex of a weight",
                                 std::to_string(weight.mVertexId), "expected a vertex of the mesh");
            points[weight.mVertexId].push_back({static_cast<int>(joint), weight.mWeight});
        }
    return normalised_skin(with_weights_of_neighbours(points, own, rig.file, rig.remarks), rig.file, own.name, rig.remarks);
}

// Returns the factor by which the inverse bind matrices of a mesh must be multiplied. assimp 5.4 leaves the transform of the mesh's node
// out of those of an FBX file (assimp's pull request 5349 changed this, and 5751 corrected it).
Eigen::Affine3d missing_in_binds(const aiNode* node, const std::string& path)
{
    Eigen::Affine3d missing = Eigen::Affine3d::Identity();
    if (aiGetVersionMajor() != 5 || aiGetVersionMinor() != 4 || content_extension(path) != ".fbx") return missing;
    for (; node != nullptr; node = node->mParent) missing = to_eigen(node->mTransformation) * missing;
    return missing;
}

RigMesh mesh_of(const aiMesh& source, int node, const Nodes& nodes, Rig& rig)
{
    RigMesh mesh;
    mesh.name = source.mName.C_Str();
    mesh.node = node;
    mesh.points.resize(source.mNumVertices, 3);
    for (unsigned p = 0; p < source.mNumVertices; ++p)
        mesh.points.row(p) << source.mVertices[p].x, source.mVertices[p].y, source.mVertices[p].z;
    std::vector<int> corners;
    add_triangles(source, 0, corners);
    mesh.triangles = Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
    mesh.look.material.assign(corners.size() / 3, static_cast<int>(source.mMaterialIndex));
    using Rows = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
    const auto rows_of = [&](const aiVector3D* rows) { return Eigen::Map<const Rows>(&rows->x, source.mNumVertices, 3); };
    if (source.mNormals) mesh.look.put(0, 0, rows_of(source.mNormals));
    for (unsigned set = 0; set < AI_MAX_NUMBER_OF_TEXTURECOORDS && source.mTextureCoords[set]; ++set) {
        const Rows uv = rows_of(source.mTextureCoords[set]);
        mesh.look.put(0, 3 + 2 * set,
                      (Eigen::MatrixX2f(uv.rows(), 2) << uv.col(0), (1.0F - uv.col(1).array()).matrix()).finished());  // glTF's v: down
    }
    const Eigen::Affine3d missing = missing_in_binds(nodes[static_cast<std::size_t>(node)], rig.file);
    for (unsigned joint = 0; joint < source.mNumBones; ++joint)
        mesh.joints.push_back(
            {joint_named(source.mBones[joint]->mName.C_Str(), nodes, rig), to_eigen(source.mBones[joint]->mOffsetMatrix) * missing});
    for (const SkinJoint& joint : mesh.joints)
        if (!(std::abs(joint.inverse_bind.linear().determinant()) > 0.0))
            throw InputError(rig.file, 0, "mesh " + mesh.name + ", joint " + rig.nodes[joint.node].name + ", inverse bind matrix", "",
                             "expected a matrix that has an inverse");
    if (!mesh.joints.empty()) mesh.skin = skin_of(source, mesh, rig);
    if (source.mNumAnimMeshes > 0)
        rig.remarks.push_back("mesh " + mesh.name + ": " + std::to_string(source.mNumAnimMeshes) + " morph targets are left out");
    return mesh;
}

void remark_on_curves(Rig& rig)
{
    if (rig.animations.empty() || content_extension(rig.file) != ".fbx") return;
    const FbxCurves count = count_fbx_curves(read_text_file(rig.file, most_mesh_bytes));
    if (count.not_linear > 0)
        rig.remarks.push_back(std::to_string(count.not_linear) + " of the " + std::to_string(count.curves) +
                              " curves of animations are constant or cubic between their keys; they are read as linear there");
}

}  // namespace

void check_collada_weights(const std::string& path)
{
    if (content_extension(path) == ".zae")
        for (const std::string& text : collada_files_in(path)) check_document(text, path);
    else
        check_document(read_text_file(path), path);
}

FbxCurves count_fbx_curves(const std::string& bytes)
{
    FbxCurves count;
    for (std::size_t found = bytes.find(flags_key); found != std::string::npos; found = bytes.find(flags_key, found + flags_key.size())) {
        const std::size_t at = found + flags_key.size();
        const bool is_text = at < bytes.size() && bytes[at] == ':';
        const std::optional<Flags> flags = is_text ? text_flags(bytes, at) : binary_flags(bytes, at);
        if (!flags) continue;
        ++count.curves;
        count.not_linear += std::any_of(flags->begin(), flags->end(), [](std::int32_t key) { return (key & all_kinds) != linear; });
    }
    return count;
}

const aiScene& read_assimp_scene(Assimp::Importer& importer, const std::string& path)
{
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    return read_scene(importer, path, aiProcess_Triangulate | aiProcess_JoinIdenticalVertices);
}

Rig rig_of_scene(const aiScene& scene, const std::string& path)
{
    Rig rig;
    rig.file = path;
    rig.unit_m = metres_per_unit(scene);
    Nodes nodes;
    add_node(*scene.mRootNode, -1, nodes, rig);
    for (std::size_t n = 0; n < nodes.size(); ++n)
        for (unsigned m = 0; m < nodes[n]->mNumMeshes; ++m) {
            RigMesh mesh = mesh_of(*scene.mMeshes[nodes[n]->mMeshes[m]], static_cast<int>(n), nodes, rig);
            if (mesh.triangles.rows() > 0) rig.meshes.push_back(std::move(mesh));
        }
    add_assimp_animations(scene, rig);
    remark_on_curves(rig);
    return rig;
}

RigMaterials read_assimp_materials(const std::string& path)
{
    Assimp::Importer importer;
    Assimp::Exporter exporter;
    const aiExportDataBlob* glb = exporter.ExportToBlob(&read_assimp_scene(importer, path), "glb2");
    if (!glb) throw InputError(path, 0, "", "", std::string("the materials, which assimp cannot write: ") + exporter.GetErrorString());
    return gltf_materials({static_cast<const char*>(glb->data), glb->size}, path);
}

Rig read_assimp_rig(const std::string& path)
{
    const std::string format = content_extension(path);
    if (format == ".dae" || format == ".zae") check_collada_weights(path);
    Assimp::Importer importer;
    return rig_of_scene(read_assimp_scene(importer, path), path);
}

}  // namespace pbs
