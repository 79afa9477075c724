#include "pbs/rig/gltf_meshes.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/number_text.hpp"
#include "pbs/rig/gltf_numbers.hpp"
#include "pbs/rig/skin_weights.hpp"
#include "pbs/rig/tiny_gltf.hpp"

#include <cmath>
#include <utility>

namespace pbs {
namespace {

// One mesh while its primitives are read.
class MeshReader {
public:
    MeshReader(const tinygltf::Model& model, int mesh, Rig& rig)
        : model_(model), source_(model.meshes[mesh]), field_("meshes/" + std::to_string(mesh)), rig_(rig)
    {
        mesh_.name = source_.name;
    }

    RigMesh read(int joints)
    {
        for (std::size_t p = 0; p < source_.primitives.size(); ++p)
            add(source_.primitives[p], field_ + "/primitives/" + std::to_string(p), joints);
        mesh_.points = Eigen::Map<const Positions>(points_.data(), static_cast<Eigen::Index>(points_.size() / 3), 3);
        mesh_.triangles = Eigen::Map<const Triangles>(triangles_.data(), static_cast<Eigen::Index>(triangles_.size() / 3), 3);
        if (joints > 0) mesh_.skin = skin_.normalised(rig_.file, mesh_.name, rig_.remarks);
        return mesh_;
    }

private:
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
        if (!primitive.targets.empty())
            rig_.remarks.push_back("mesh " + source_.name + ": " + std::to_string(primitive.targets.size()) +
                                   " morph targets are left out");
        const auto first = static_cast<int>(points_.size() / 3);
        const AccessorNumbers points = attribute(primitive, "POSITION", 3, field);
        points_.insert(points_.end(), points.data(), points.data() + points.size());
        add_triangles(primitive, first, static_cast<int>(points.rows()), field);
        if (joints > 0) add_weights(primitive, static_cast<int>(points.rows()), joints, field);
    }

    AccessorNumbers attribute(const tinygltf::Primitive& primitive, const std::string& name, int components, const std::string& field)
    {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end()) throw InputError(rig_.file, 0, field + "/attributes/" + name, "", "missing");
        return accessor_numbers(model_, found->second, components, rig_.file, field + "/attributes/" + name);
    }

    // Takes the primitive's indices, or its vertices in their order.
    void add_triangles(const tinygltf::Primitive& primitive, int first, int points, const std::string& field)
    {
        std::vector<int> corners;
        if (primitive.indices >= 0) {
            const AccessorNumbers indices = accessor_numbers(model_, primitive.indices, 1, rig_.file, field + "/indices");
            for (const double index : indices.col(0)) {
                if (!(index >= 0.0 && index < points))
                    throw InputError(rig_.file, 0, field + "/indices", number_text(index, 12), expected_whole("an index", 0, points - 1));
                corners.push_back(static_cast<int>(index));
            }
        } else {
            for (int p = 0; p < points; ++p) corners.push_back(p);
        }
        const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES, fan = primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
        for (std::size_t c = 0; c + 2 < corners.size(); c += list ? 3 : 1) {
            // A strip's odd triangles run the other way round (glTF 2.0, Sec. 3.7.2.1).
            const bool odd = !list && !fan && c % 2 == 1;
            for (const std::size_t corner : {fan ? 0 : c, c + (odd ? 2 : 1), c + (odd ? 1 : 2)})
                triangles_.push_back(first + corners[corner]);
        }
    }

    // All sets JOINTS_0 and WEIGHTS_0, JOINTS_1 and WEIGHTS_1, ... of a primitive.
    void add_weights(const tinygltf::Primitive& primitive, int points, int joints, const std::string& field)
    {
        std::vector<std::vector<JointShare>> shares(static_cast<std::size_t>(points));
        for (int set = 0; primitive.attributes.count("JOINTS_" + std::to_string(set)) > 0; ++set) {
            const std::string names = "JOINTS_" + std::to_string(set), weights_name = "WEIGHTS_" + std::to_string(set);
            const AccessorNumbers numbers = attribute(primitive, names, 4, field), weights = attribute(primitive, weights_name, 4, field);
            for (const auto& [name, rows] : {std::pair(names, numbers.rows()), std::pair(weights_name, weights.rows())})
                if (rows != points)
                    throw InputError(rig_.file, 0, field + "/attributes/" + name, std::to_string(rows),
                                     "expected as many as there are points, " + std::to_string(points));
            for (int p = 0; p < points; ++p)
                for (int k = 0; k < 4; ++k) {
                    if (weights(p, k) == 0.0) continue;
                    if (!(numbers(p, k) >= 0.0 && numbers(p, k) < joints))
                        throw InputError(rig_.file, 0, field + "/attributes/" + names, number_text(numbers(p, k), 12),
                                         expected_whole("the number of a joint", 0, joints - 1));
                    shares[static_cast<std::size_t>(p)].push_back({static_cast<int>(numbers(p, k)), weights(p, k)});
                }
        }
        for (const auto& point : shares) skin_.add_point(point);
    }

    const tinygltf::Model& model_;
    const tinygltf::Mesh& source_;
    std::string field_;
    Rig& rig_;
    RigMesh mesh_;
    std::vector<double> points_;
    std::vector<int> triangles_;
    SkinWeights skin_;
};

std::vector<SkinJoint> joints_of(const tinygltf::Model& model, int skin_index, const std::vector<int>& rig_node, const std::string& path)
{
    const std::string field = "skins/" + std::to_string(skin_index);
    if (skin_index >= static_cast<int>(model.skins.size())) throw InputError(path, 0, "skin", std::to_string(skin_index), "does not exist");
    const tinygltf::Skin& skin = model.skins[skin_index];
    if (skin.joints.empty()) throw InputError(path, 0, field + "/joints", "", "expected at least one joint");
    std::vector<SkinJoint> joints;
    for (const int node : skin.joints) {
        if (node < 0 || node >= static_cast<int>(rig_node.size()))
            throw InputError(path, 0, field + "/joints", std::to_string(node), "expected a node of the file");
        joints.push_back({rig_node[node]});
    }
    if (skin.inverseBindMatrices < 0) return joints;  // identities
    const AccessorNumbers matrices = accessor_numbers(model, skin.inverseBindMatrices, 16, path, field + "/inverseBindMatrices");
    if (matrices.rows() < static_cast<Eigen::Index>(joints.size()))
        throw InputError(path, 0, field + "/inverseBindMatrices", std::to_string(matrices.rows()), "expected one per joint");
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix4d>(matrices.row(static_cast<Eigen::Index>(j)).data());  // by columns
        if (!(std::abs(matrix.topLeftCorner<3, 3>().determinant()) > 0.0))
            throw InputError(path, 0, field + "/inverseBindMatrices", std::to_string(j), "expected matrices that can be inverted");
        joints[j].inverse_bind.affine() = matrix.topRows<3>();
    }
    return joints;
}

}  // namespace

void add_gltf_mesh(const tinygltf::Model& model, int gltf_node, const std::vector<int>& rig_node, Rig& rig)
{
    const tinygltf::Node& node = model.nodes[gltf_node];
    if (node.mesh >= static_cast<int>(model.meshes.size()))
        throw InputError(rig.file, 0, "nodes/" + std::to_string(gltf_node) + "/mesh", std::to_string(node.mesh), "does not exist");
    std::vector<SkinJoint> joints;
    if (node.skin >= 0) joints = joints_of(model, node.skin, rig_node, rig.file);
    RigMesh mesh = MeshReader(model, node.mesh, rig).read(static_cast<int>(joints.size()));
    if (mesh.triangles.rows() == 0) return;
    if (mesh.name.empty()) mesh.name = node.name;
    mesh.node = rig_node[gltf_node];
    mesh.joints = std::move(joints);
    rig.meshes.push_back(std::move(mesh));
}

}  // namespace pbs
