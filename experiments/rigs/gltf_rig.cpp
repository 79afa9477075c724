#include "experiments/rigs/rig_formats.hpp"

#include "experiments/rigs/rig_reader.hpp"
#include "experiments/rigs/tiny_gltf.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace pbs {
namespace {

constexpr double last_row_rounding = 1e-6;  // of a node's matrix in single precision
constexpr double bind_last_row_error =
    1e-4;  // of an inverse bind matrix; a matrix by rows has the place of a joint there

// One mesh while its primitives are read.
class MeshReader {
public:
    MeshReader(const tinygltf::Model& model, int mesh, Rig& rig)
        : model_(model), source_(model.meshes[mesh]), field_("meshes/" + std::to_string(mesh)), rig_(rig)
    {
        mesh_.name = source_.name;
    }

    RigMesh read(const tinygltf::Node& node, int joints)
    {
        for (std::size_t p = 0; p < source_.primitives.size(); ++p)
            add(source_.primitives[p], field_ + "/primitives/" + std::to_string(p), joints);
        mesh_.points = Eigen::Map<const Positions>(points_.data(), static_cast<Eigen::Index>(points_.size() / 3), 3);
        if (!triangles_.empty()) add_morphs(node);
        mesh_.triangles =
            Eigen::Map<const Triangles>(triangles_.data(), static_cast<Eigen::Index>(triangles_.size() / 3), 3);
        if (joints > 0)
            mesh_.skin = normalised_skin(with_weights_of_neighbours(shares_, mesh_, rig_.file, rig_.remarks), rig_.file,
                                         mesh_.name, rig_.remarks, rig_.notes);
        return mesh_;
    }

private:
    // The points of a primitive among those of the mesh.
    struct PointRange {
        int first = 0, count = 0;
    };

    static bool is_of_triangles(const tinygltf::Primitive& primitive)
    {
        return primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
               primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
    }

    void add(const tinygltf::Primitive& primitive, const std::string& field, int joints)
    {
        if (!is_of_triangles(primitive)) {
            rig_.remarks.push_back("mesh " + source_.name + ": points and lines are left out");
            return;
        }
        const auto [range, is_new] = points_of_.try_emplace({primitive.attributes, primitive.targets});
        if (is_new) range->second = add_points(primitive, field, joints);
        add_triangles(primitive, range->second, field);
        mesh_.look.material.resize(triangles_.size() / 3, primitive.material);
    }

    PointRange add_points(const tinygltf::Primitive& primitive, const std::string& field, int joints)
    {
        const AccessorNumbers points = attribute(primitive, "POSITION", 3, field);
        const PointRange range = {static_cast<int>(points_.size() / 3), static_cast<int>(points.rows())};
        points_.insert(points_.end(), points.data(), points.data() + points.size());
        add_look(primitive, "NORMAL", range, 0, field);
        for (int set = 0; primitive.attributes.count("TEXCOORD_" + std::to_string(set)) > 0; ++set)
            add_look(primitive, "TEXCOORD_" + std::to_string(set), range, 3 + 2 * set, field);
        if (joints > 0) add_weights(primitive, range.count, joints, field);
        for (std::size_t k = 0; k < primitive.targets.size(); ++k) add_target(primitive.targets[k], k, range, field);
        return range;
    }

    // The displacements of a morph target. Primitives without it are not moved.
    void add_target(const std::map<std::string, int>& target, std::size_t k, const PointRange& points,
                    const std::string& field)
    {
        auto& targets = mesh_.morphs.displacements;
        targets.resize(std::max(targets.size(), k + 1));
        const auto position = target.find("POSITION");
        if (position == target.end()) return;
        const std::string name = field + "/targets/" + std::to_string(k) + "/POSITION";
        const AccessorNumbers rows = accessor_numbers(model_, position->second, 3, rig_.file, name);
        if (rows.rows() != points.count)
            throw InputError(rig_.file, 0, name, std::to_string(rows.rows()),
                             "expected as many as there are points, " + std::to_string(points.count));
        targets[k].conservativeResizeLike(Positions::Zero(points.first + points.count, 3));
        targets[k].bottomRows(points.count) = rows;
    }

    // A node's weights come before those of its mesh. The shape that they make is that of the body at rest.
    void add_morphs(const tinygltf::Node& node)
    {
        RigMorphs& morphs = mesh_.morphs;
        const std::vector<double>& stated = node.weights.empty() ? source_.weights : node.weights;
        if (stated.size() > morphs.displacements.size())
            throw InputError(
                rig_.file, 0, field_ + "/weights", std::to_string(stated.size()),
                "expected one for each of the " + std::to_string(morphs.displacements.size()) + " morph targets");
        morphs.rest_weights = stated;
        morphs.rest_weights.resize(morphs.displacements.size(), 0.0);
        for (std::size_t k = 0; k < morphs.displacements.size(); ++k) {
            morphs.displacements[k].conservativeResizeLike(Positions::Zero(mesh_.points.rows(), 3));
            mesh_.points += morphs.rest_weights[k] * morphs.displacements[k];
        }
    }

    AccessorNumbers attribute(const tinygltf::Primitive& primitive, const std::string& name, int components,
                              const std::string& field, decltype(&accessor_numbers) read = accessor_numbers)
    {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end())
            throw InputError(rig_.file, 0, field + "/attributes/" + name, "", "missing");
        return read(model_, found->second, components, rig_.file, field + "/attributes/" + name);
    }

    // Takes the primitive's indices, or its vertices in their order.
    void add_triangles(const tinygltf::Primitive& primitive, const PointRange& points, const std::string& field)
    {
        std::vector<int> corners;
        if (primitive.indices >= 0) {
            const AccessorNumbers indices =
                accessor_numbers(model_, primitive.indices, 1, rig_.file, field + "/indices");
            for (const double index : indices.col(0)) {
                if (!(index >= 0.0 && index < points.count))
                    throw InputError(rig_.file, 0, field + "/indices", number_text(index, 12),
                                     expected_whole("an index", 0, points.count - 1));
                corners.push_back(static_cast<int>(index));
            }
        } else {
            for (int p = 0; p < points.count; ++p) corners.push_back(p);
        }
        const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES, fan = primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
        if (list && primitive.indices >= 0 && corners.size() % 3 != 0)
            throw InputError(rig_.file, 0, field + "/indices", std::to_string(corners.size()) + " of triangles",
                             "expected three for each");
        for (std::size_t c = 0; c + 2 < corners.size(); c += list ? 3 : 1) {
            // A strip's odd triangles run the other way round (glTF 2.0, Sec. 3.7.2.1).
            const bool odd = !list && !fan && c % 2 == 1;
            for (const std::size_t corner : {fan ? 0 : c, c + (odd ? 2 : 1), c + (odd ? 1 : 2)})
                triangles_.push_back(points.first + corners[corner]);
        }
    }

    // No point's place depends on it, so that damaged numbers are left out.
    void add_look(const tinygltf::Primitive& primitive, const std::string& name, const PointRange& points, int column,
                  const std::string& field)
    {
        if (primitive.attributes.count(name) == 0) return;
        try {
            const AccessorNumbers rows = attribute(primitive, name, column == 0 ? 3 : 2, field);
            if (rows.rows() != points.count)
                throw InputError(rig_.file, 0, field, name, "expected as many as there are points");
            mesh_.look.put(points.first, column, rows.cast<float>());
        } catch (const InputError& error) {
            rig_.remarks.push_back("mesh " + source_.name + ": " + name + " is left out: " + error.what());
        }
    }

    // All sets JOINTS_0 and WEIGHTS_0, JOINTS_1 and WEIGHTS_1, ... of a primitive. Weights may be no numbers:
    // with_weights_of_neighbours.
    void add_weights(const tinygltf::Primitive& primitive, int points, int joints, const std::string& field)
    {
        const std::size_t first = shares_.size();
        shares_.resize(first + static_cast<std::size_t>(points));
        for (int set = 0; primitive.attributes.count("JOINTS_" + std::to_string(set)) > 0; ++set) {
            const std::string names = "JOINTS_" + std::to_string(set), weights_name = "WEIGHTS_" + std::to_string(set);
            const AccessorNumbers numbers = attribute(primitive, names, 4, field),
                                  weights = attribute(primitive, weights_name, 4, field, accessor_values);
            for (const auto& [name, rows] : {std::pair(names, numbers.rows()), std::pair(weights_name, weights.rows())})
                if (rows != points)
                    throw InputError(rig_.file, 0, field + "/attributes/" + name, std::to_string(rows),
                                     "expected as many as there are points, " + std::to_string(points));
            for (int p = 0; p < points; ++p)
                for (int k = 0; k < 4; ++k) {
                    if (weights(p, k) == 0.0) continue;
                    if (!(numbers(p, k) >= 0.0 && numbers(p, k) < joints) && std::isfinite(weights(p, k)))
                        throw InputError(rig_.file, 0, field + "/attributes/" + names, number_text(numbers(p, k), 12),
                                         expected_whole("the number of a joint", 0, joints - 1));
                    shares_[first + static_cast<std::size_t>(p)].push_back(
                        {static_cast<int>(numbers(p, k)), weights(p, k)});
                }
        }
    }

    const tinygltf::Model& model_;
    const tinygltf::Mesh& source_;
    std::string field_;
    Rig& rig_;
    RigMesh mesh_;
    std::vector<double> points_;
    using Attributes = std::map<std::string, int>;
    // primitives with the same ones have the same points
    std::map<std::pair<Attributes, std::vector<Attributes>>, PointRange> points_of_;
    std::vector<int> triangles_;
    std::vector<std::vector<JointShare>> shares_;  // of the points, if they are weighted
};

std::vector<SkinJoint> joints_of(const tinygltf::Model& model, int skin_index, const std::vector<int>& rig_node,
                                 const std::string& path)
{
    const std::string field = "skins/" + std::to_string(skin_index);
    if (skin_index >= static_cast<int>(model.skins.size()))
        throw InputError(path, 0, "skin", std::to_string(skin_index), "does not exist");
    const tinygltf::Skin& skin = model.skins[skin_index];
    if (skin.joints.empty()) throw InputError(path, 0, field + "/joints", "", "expected at least one joint");
    std::vector<SkinJoint> joints;
    for (const int node : skin.joints) {
        if (node < 0 || node >= static_cast<int>(rig_node.size()))
            throw InputError(path, 0, field + "/joints", std::to_string(node), "expected a node of the file");
        joints.push_back({rig_node[node]});
    }
    if (skin.inverseBindMatrices < 0) return joints;  // identities
    const AccessorNumbers matrices =
        accessor_numbers(model, skin.inverseBindMatrices, 16, path, field + "/inverseBindMatrices");
    if (matrices.rows() < static_cast<Eigen::Index>(joints.size()))
        throw InputError(path, 0, field + "/inverseBindMatrices", std::to_string(matrices.rows()),
                         "expected one per joint");
    for (std::size_t j = 0; j < joints.size(); ++j) {
        // by columns
        const Eigen::Matrix4d matrix =
            Eigen::Map<const Eigen::Matrix4d>(matrices.row(static_cast<Eigen::Index>(j)).data());
        if (!(std::abs(matrix.topLeftCorner<3, 3>().determinant()) > 0.0))
            throw InputError(path, 0, field + "/inverseBindMatrices", std::to_string(j),
                             "expected matrices that can be inverted");
        if (!(matrix.row(3) - Eigen::RowVector4d::Unit(3)).isZero(bind_last_row_error))
            throw InputError(path, 0, field + "/inverseBindMatrices", "matrix " + std::to_string(j),
                             matrix.col(3).head<3>().isZero() ? "is stored by rows: expected its columns one after the "
                                                                "other (transpose the matrices, or export the "
                                                                "model with another program)"
                                                              : "expected the last row 0, 0, 0, 1");
        joints[j].inverse_bind.affine() = matrix.topRows<3>();
    }
    return joints;
}

// The mesh of node `gltf_node` of the file with all its primitives of triangles. rig_node: the number of each of the
// file's nodes in the rig. Appends to `rig.meshes`, and to `rig.remarks` what was left out: points and lines.
void add_gltf_mesh(const tinygltf::Model& model, int gltf_node, const std::vector<int>& rig_node, Rig& rig)
{
    const tinygltf::Node& node = model.nodes[gltf_node];
    if (node.mesh >= static_cast<int>(model.meshes.size()))
        throw InputError(rig.file, 0, "nodes/" + std::to_string(gltf_node) + "/mesh", std::to_string(node.mesh),
                         "does not exist");
    std::vector<SkinJoint> joints;
    if (node.skin >= 0) joints = joints_of(model, node.skin, rig_node, rig.file);
    RigMesh mesh = MeshReader(model, node.mesh, rig).read(node, static_cast<int>(joints.size()));
    if (mesh.triangles.rows() == 0) return;
    if (mesh.name.empty()) mesh.name = node.name;
    mesh.node = rig_node[gltf_node];
    mesh.joints = std::move(joints);
    rig.meshes.push_back(std::move(mesh));
}

Interpolation interpolation_of(const std::string& name, const std::string& path, const std::string& field)
{
    if (name.empty() || name == "LINEAR") return Interpolation::linear;
    if (name == "STEP") return Interpolation::step;
    if (name == "CUBICSPLINE") return Interpolation::cubic_spline;
    throw InputError(path, 0, field + "/interpolation", name, "expected LINEAR, STEP or CUBICSPLINE");
}

std::vector<double> key_times(const tinygltf::Model& model, const tinygltf::AnimationSampler& sampler,
                              const std::string& path, const std::string& field)
{
    const AccessorNumbers times = accessor_numbers(model, sampler.input, 1, path, field + "/input");
    if (times.rows() == 0) throw InputError(path, 0, field + "/input", "", "expected at least one key");
    if (!std::is_sorted(times.data(), times.data() + times.size()))
        throw InputError(path, 0, field + "/input", "", "expected times that do not go back");
    return {times.data(), times.data() + times.size()};
}

KeyTrack track_of(const tinygltf::Model& model, const tinygltf::AnimationSampler& sampler, int components,
                  const std::string& path, const std::string& field)
{
    KeyTrack track;
    track.interpolation = interpolation_of(sampler.interpolation, path, field);
    track.times_s = key_times(model, sampler, path, field);
    const AccessorNumbers values = accessor_numbers(model, sampler.output, components, path, field + "/output");
    const Eigen::Index per_key = track.interpolation == Interpolation::cubic_spline ? 3 : 1;
    const auto keys = static_cast<Eigen::Index>(track.times_s.size());
    if (values.rows() != per_key * keys)
        throw InputError(path, 0, field + "/output", std::to_string(values.rows()),
                         "expected " + std::to_string(per_key * keys) + " for " + std::to_string(keys) + " keys");
    for (Eigen::Index v = 0; v < values.rows(); ++v) {
        track.values.emplace_back(Eigen::Vector4d::Zero());
        track.values.back().head(components) = values.row(v).transpose();
        const bool is_key = per_key == 1 || v % 3 == 1;  // between the tangents of a spline
        if (components == 4 && is_key && !(track.values.back().norm() > 0.0))
            throw InputError(path, 0, field + "/output, key " + std::to_string(v / per_key), "",
                             "expected a quaternion that is not zero");
    }
    return track;
}

// The tracks of the weights of all morph targets of a mesh. For each key the file has those of all targets; for a
// spline it has first all in-tangents, then all weights, then all out-tangents.
std::vector<KeyTrack> morph_tracks(const tinygltf::Model& model, const tinygltf::AnimationSampler& sampler,
                                   std::size_t targets, const std::string& path, const std::string& field)
{
    KeyTrack track;
    track.interpolation = interpolation_of(sampler.interpolation, path, field);
    track.times_s = key_times(model, sampler, path, field);
    const AccessorNumbers weights = accessor_numbers(model, sampler.output, 1, path, field + "/output");
    const std::size_t per_target = (track.interpolation == Interpolation::cubic_spline ? 3 : 1) * track.times_s.size();
    if (static_cast<std::size_t>(weights.rows()) != per_target * targets)
        throw InputError(
            path, 0, field + "/output", std::to_string(weights.rows()),
            "expected " + std::to_string(per_target) + " for each of " + std::to_string(targets) + " morph targets");
    std::vector<KeyTrack> tracks(targets, track);
    for (Eigen::Index w = 0; w < weights.rows(); ++w)
        tracks[static_cast<std::size_t>(w) % targets].values.emplace_back(weights(w, 0), 0.0, 0.0, 0.0);
    return tracks;
}

void check(const tinygltf::AnimationChannel& channel, const tinygltf::Model& model, std::size_t samplers,
           const std::string& path, const std::string& field)
{
    if (channel.target_node >= static_cast<int>(model.nodes.size()))
        throw InputError(path, 0, field + "/target/node", std::to_string(channel.target_node),
                         "expected a node of the file");
    const bool is_of_weights = channel.target_path == "weights";
    if (!is_of_weights && !model.nodes[channel.target_node].matrix.empty())
        throw InputError(
            path, 0, field + "/target/node", std::to_string(channel.target_node),
            "expected a node without a matrix, whose translation, rotation or scale the animation replaces: export the "
            "model with these three");
    if (channel.sampler < 0 || channel.sampler >= static_cast<int>(samplers))
        throw InputError(path, 0, field + "/sampler", std::to_string(channel.sampler),
                         "expected a sampler of the animation");
    if (!is_of_weights && channel.target_path != "translation" && channel.target_path != "rotation" &&
        channel.target_path != "scale")
        throw InputError(path, 0, field + "/target/path", channel.target_path,
                         "expected translation, rotation, scale or weights");
}

RigAnimation animation_of(const tinygltf::Model& model, std::size_t index, const std::vector<int>& rig_node, Rig& rig)
{
    const tinygltf::Animation& source = model.animations[index];
    const std::string field = "animations/" + std::to_string(index);
    RigAnimation animation;
    animation.name = source.name.empty() ? "animation " + std::to_string(index) : source.name;
    animation.start_s = std::numeric_limits<double>::max();
    animation.end_s = std::numeric_limits<double>::lowest();  // times may be negative
    std::map<int, NodeTracks> tracks_of;                      // by node
    const auto targets_of = [&](int node) {
        const auto mesh = std::ranges::find(rig.meshes, node, &RigMesh::node);
        return mesh == rig.meshes.end() ? std::size_t{0} : mesh->morphs.displacements.size();
    };
    for (std::size_t c = 0; c < source.channels.size(); ++c) {
        const tinygltf::AnimationChannel& channel = source.channels[c];
        if (channel.target_node < 0) continue;  // to be ignored (glTF 2.0, Sec. 3.11)
        check(channel, model, source.samplers.size(), rig.file, field + "/channels/" + std::to_string(c));
        const tinygltf::AnimationSampler& sampler = source.samplers[channel.sampler];
        const std::string sampler_field = field + "/samplers/" + std::to_string(channel.sampler);
        const int moved = rig_node[channel.target_node];
        const auto include = [&](const KeyTrack& track) {
            animation.start_s = std::min(animation.start_s, track.times_s.front());
            animation.end_s = std::max(animation.end_s, track.times_s.back());
            tracks_of[moved].node = moved;
        };
        if (channel.target_path == "weights") {
            if (targets_of(moved) == 0) {
                rig.remarks.push_back("animation " + animation.name + ": its weights of node " +
                                      model.nodes[channel.target_node].name +
                                      " are left out, for no mesh with morph targets is shown there");
                continue;
            }
            auto tracks = morph_tracks(model, sampler, targets_of(moved), rig.file, sampler_field);
            include(tracks.front());
            tracks_of[moved].morph_weights = std::move(tracks);
            continue;
        }
        const bool rotation = channel.target_path == "rotation";
        KeyTrack track = track_of(model, sampler, rotation ? 4 : 3, rig.file, sampler_field);
        include(track);
        NodeTracks& node = tracks_of[moved];
        (rotation ? node.rotation : channel.target_path == "scale" ? node.scale : node.translation) = std::move(track);
    }
    for (auto& [node, tracks] : tracks_of) animation.nodes.push_back(std::move(tracks));
    return animation;
}

// Appends to `rig.animations` those that move a node or a morph target. An animation without a name gets
// "animation N".
void add_gltf_animations(const tinygltf::Model& model, const std::vector<int>& rig_node, Rig& rig)
{
    for (std::size_t index = 0; index < model.animations.size(); ++index) {
        RigAnimation animation = animation_of(model, index, rig_node, rig);
        if (!animation.nodes.empty()) rig.animations.push_back(std::move(animation));
    }
    const auto is_morphed = [&](const RigMesh& mesh) {
        return std::ranges::any_of(rig.animations, [&](const RigAnimation& animation) {
            return std::ranges::any_of(animation.nodes, [&](const NodeTracks& tracks) {
                return tracks.node == mesh.node && !tracks.morph_weights.empty();
            });
        });
    };
    for (RigMesh& mesh : rig.meshes)
        if (!is_morphed(mesh)) mesh.morphs = {};
}

Vec3 vec3_or(const std::vector<double>& numbers, const Vec3& otherwise)
{
    return numbers.size() == 3 ? Vec3(numbers[0], numbers[1], numbers[2]) : otherwise;
}

NodeTransform transform_of(const tinygltf::Node& node, const std::string& path, const std::string& field)
{
    NodeTransform transform;
    if (node.matrix.size() == 16) {
        Eigen::Affine3d matrix;
        matrix.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());  // by columns
        if (!node.translation.empty() || !node.rotation.empty() || !node.scale.empty())
            throw InputError(path, 0, field + "/matrix", "",
                             "expected a matrix or translation, rotation and scale, not both");
        const Eigen::RowVector4d last(0.0, 0.0, 0.0, 1.0);
        if (!(matrix.matrix().row(3) - last).isZero(last_row_rounding))
            throw InputError(path, 0, field + "/matrix", "", "expected the last row 0, 0, 0, 1");
        matrix.matrix().row(3) = last;
        transform.matrix = matrix;
    }
    transform.translation = vec3_or(node.translation, Vec3::Zero());
    transform.scale = vec3_or(node.scale, Vec3::Ones());
    if (node.rotation.size() == 4) transform.rotation = Eigen::Quaterniond(node.rotation.data());  // x, y, z, w
    if (!(transform.rotation.norm() > 0.0))
        throw InputError(path, 0, field + "/rotation", "", "expected a quaternion that is not zero");
    transform.rotation.normalize();
    if (!transform.affine().matrix().allFinite()) throw InputError(path, 0, field, "", "expected finite numbers");
    return transform;
}

// The parent of each node in the file, -1 for roots.
std::vector<int> parents_of(const tinygltf::Model& model, const std::string& path)
{
    std::vector<int> parent(model.nodes.size(), -1);
    for (std::size_t n = 0; n < model.nodes.size(); ++n)
        for (const int child : model.nodes[n].children) {
            const std::string field = "nodes/" + std::to_string(n) + "/children";
            if (child < 0 || child >= static_cast<int>(model.nodes.size()))
                throw InputError(path, 0, field, std::to_string(child), "expected a node of the file");
            if (parent[child] >= 0)
                throw InputError(path, 0, field, std::to_string(child), "expected one parent per node");
            parent[child] = static_cast<int>(n);
        }
    return parent;
}

// Nodes in the order of the tree: parents first. Returns the number of each of the file's nodes in the rig.
std::vector<int> add_nodes(const tinygltf::Model& model, Rig& rig)
{
    const std::vector<int> parent = parents_of(model, rig.file);
    std::vector<int> rig_node(model.nodes.size(), -1), waiting;
    for (std::size_t n = parent.size(); n-- > 0;)
        if (parent[n] < 0) waiting.push_back(static_cast<int>(n));
    while (!waiting.empty()) {
        const int n = waiting.back();
        waiting.pop_back();
        rig_node[n] = static_cast<int>(rig.nodes.size());
        rig.nodes.push_back({model.nodes[n].name, parent[n] < 0 ? -1 : rig_node[parent[n]],
                             transform_of(model.nodes[n], rig.file, "nodes/" + std::to_string(n))});
        const auto& children = model.nodes[n].children;
        waiting.insert(waiting.end(), children.rbegin(), children.rend());
    }
    const auto lost = std::find(rig_node.begin(), rig_node.end(), -1);
    if (lost != rig_node.end())
        throw InputError(rig.file, 0, "nodes/" + std::to_string(lost - rig_node.begin()), "", "is its own ancestor");
    return rig_node;
}

// Null where the value is no object or lacks the key.
const tinygltf::Value& member(const tinygltf::Value& value, const std::string& key)
{
    static const tinygltf::Value none;
    return value.Has(key) ? value.Get(key) : none;
}

void take_body_part(const tinygltf::Value& node, const std::string& part, const std::vector<int>& rig_node, Rig& rig)
{
    const int number = node.IsInt() ? node.GetNumberAsInt() : -1;
    if (number < 0 || number >= static_cast<int>(rig_node.size())) {
        rig.remarks.push_back("humanoid/humanBones/" + part + " names no node of the file, and is left out");
        return;
    }
    rig.nodes[static_cast<std::size_t>(rig_node[static_cast<std::size_t>(number)])].body_part = part;
}

// The table in which VRM states which node is which part of a body: a list in its version 0, an object by parts since
// then.
void take_body_parts(const tinygltf::Model& model, const std::vector<int>& rig_node, Rig& rig)
{
    for (const char* extension : {"VRM", "VRMC_vrm", "VRMC_vrm_animation"}) {
        const auto found = model.extensions.find(extension);
        if (found == model.extensions.end()) continue;
        const tinygltf::Value& bones = member(member(found->second, "humanoid"), "humanBones");
        for (std::size_t b = 0; bones.IsArray() && b < bones.ArrayLen(); ++b)
            if (const tinygltf::Value& part = member(bones.Get(static_cast<int>(b)), "bone"); part.IsString())
                take_body_part(member(bones.Get(static_cast<int>(b)), "node"), part.Get<std::string>(), rig_node, rig);
        for (const std::string& part : bones.Keys())
            take_body_part(member(bones.Get(part), "node"), part, rig_node, rig);
    }
}

// The file's nodes that its scene shows.
std::vector<int> nodes_of_scene(const tinygltf::Model& model, const std::string& path)
{
    std::vector<int> shown, waiting;
    if (model.scenes.empty()) {
        for (std::size_t n = 0; n < model.nodes.size(); ++n) shown.push_back(static_cast<int>(n));
        return shown;
    }
    const int scene = std::max(model.defaultScene, 0);
    if (scene >= static_cast<int>(model.scenes.size()))
        throw InputError(path, 0, "scene", std::to_string(scene), "does not exist");
    waiting = model.scenes[scene].nodes;
    while (!waiting.empty()) {
        const int n = waiting.back();
        waiting.pop_back();
        if (n < 0 || n >= static_cast<int>(model.nodes.size()))
            throw InputError(path, 0, "scenes/" + std::to_string(scene) + "/nodes", std::to_string(n),
                             "expected a node of the file");
        if (shown.size() == model.nodes.size())
            throw InputError(path, 0, "scenes/" + std::to_string(scene) + "/nodes", std::to_string(n),
                             "expected each node once");
        shown.push_back(n);
        waiting.insert(waiting.end(), model.nodes[n].children.begin(), model.nodes[n].children.end());
    }
    std::sort(shown.begin(), shown.end());
    return shown;
}

}  // namespace

Rig read_gltf_rig(const std::string& path)
{
    tinygltf::Model model;
    read_gltf_model(read_text_file(path, most_mesh_bytes), path, model);
    Rig rig;
    rig.file = path;
    const std::vector<int> rig_node = add_nodes(model, rig);
    for (const int node : nodes_of_scene(model, path))
        if (model.nodes[node].mesh >= 0) add_gltf_mesh(model, node, rig_node, rig);
    take_body_parts(model, rig_node, rig);
    add_gltf_animations(model, rig_node, rig);
    return rig;
}

}  // namespace pbs
