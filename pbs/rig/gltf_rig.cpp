#include "pbs/rig/gltf_rig.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/rig/gltf_animations.hpp"
#include "pbs/rig/gltf_meshes.hpp"
#include "pbs/rig/gltf_model.hpp"
#include "pbs/rig/tiny_gltf.hpp"

#include <algorithm>

namespace pbs {
namespace {

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
        transform.matrix = matrix;
    }
    transform.translation = vec3_or(node.translation, Vec3::Zero());
    transform.scale = vec3_or(node.scale, Vec3::Ones());
    if (node.rotation.size() == 4) transform.rotation = Eigen::Quaterniond(node.rotation.data());  // x, y, z, w
    if (!(transform.rotation.norm() > 0.0)) throw InputError(path, 0, field + "/rotation", "", "expected a quaternion that is not zero");
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
            if (parent[child] >= 0) throw InputError(path, 0, field, std::to_string(child), "expected one parent per node");
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

// The file's nodes that its scene shows.
std::vector<int> nodes_of_scene(const tinygltf::Model& model, const std::string& path)
{
    std::vector<int> shown, waiting;
    if (model.scenes.empty()) {
        for (std::size_t n = 0; n < model.nodes.size(); ++n) shown.push_back(static_cast<int>(n));
        return shown;
    }
    const int scene = std::max(model.defaultScene, 0);
    if (scene >= static_cast<int>(model.scenes.size())) throw InputError(path, 0, "scene", std::to_string(scene), "does not exist");
    waiting = model.scenes[scene].nodes;
    while (!waiting.empty()) {
        const int n = waiting.back();
        waiting.pop_back();
        if (n < 0 || n >= static_cast<int>(model.nodes.size()))
            throw InputError(path, 0, "scenes/" + std::to_string(scene) + "/nodes", std::to_string(n), "expected a node of the file");
        if (shown.size() == model.nodes.size())
            throw InputError(path, 0, "scenes/" + std::to_string(scene) + "/nodes", std::to_string(n), "expected each node once");
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
    read_gltf_model(path, model);
    Rig rig;
    rig.file = path;
    const std::vector<int> rig_node = add_nodes(model, rig);
    for (const int node : nodes_of_scene(model, path))
        if (model.nodes[node].mesh >= 0) add_gltf_mesh(model, node, rig_node, rig);
    add_gltf_animations(model, rig_node, rig);
    return rig;
}

}  // namespace pbs
