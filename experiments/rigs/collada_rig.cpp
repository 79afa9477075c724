#include "experiments/rigs/rig_formats.hpp"

#include "experiments/rigs/assimp_files.hpp"
#include "experiments/rigs/collada_document.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "pbs/geometry/input_error.hpp"

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
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
std::optional<KeyTrack> track_of(const Key* keys, unsigned count, double tick_rate_hz, const std::string& file,
                                 const std::string& node)
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

RigAnimation animation_of(const aiAnimation& source, unsigned index, const std::map<std::string, int>& node_named,
                          Rig& rig)
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
        NodeTracks tracks{node->second,
                          track_of(channel.mPositionKeys, channel.mNumPositionKeys, tick_rate_hz, rig.file, name),
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

// Appends to `rig.animations` those that move a node of the rig; channels of other names are remarks. The matrix of a
// node that is moved is removed, since an animation replaces its translation, rotation and scale.
void add_assimp_animations(const aiScene& scene, Rig& rig)
{
    std::map<std::string, int> node_named;
    std::set<int> with_mesh;
    for (const RigMesh& mesh : rig.meshes) with_mesh.insert(mesh.node);
    for (const bool is_mesh : {true, false})  // of nodes with the same name, the one without a mesh, which is the joint
        for (std::size_t n = rig.nodes.size(); n-- > 0;)
            if ((with_mesh.count(static_cast<int>(n)) > 0) == is_mesh)
                node_named[rig.nodes[n].name] = static_cast<int>(n);
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

// Animations replace a node's whole transform, so that its parts are needed only where an animation has no keys for
// them.
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
    if (with_mesh < 0)
        throw InputError(rig.file, 0, "joint", name, "the skin names a joint that is no node of the file");
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
    return normalised_skin(with_weights_of_neighbours(points, own, rig.file, rig.remarks), rig.file, own.name,
                           rig.remarks, rig.notes);
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
    for (unsigned f = 0; f < source.mNumFaces; ++f)  // not of points and lines
        for (unsigned c = 0; source.mFaces[f].mNumIndices == 3 && c < 3; ++c)
            corners.push_back(static_cast<int>(source.mFaces[f].mIndices[c]));
    mesh.triangles = Eigen::Map<const Triangles>(corners.data(), static_cast<Eigen::Index>(corners.size() / 3), 3);
    mesh.look.material.assign(corners.size() / 3, static_cast<int>(source.mMaterialIndex));
    using Rows = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
    const auto rows_of = [&](const aiVector3D* rows) {
        return Eigen::Map<const Rows>(&rows->x, source.mNumVertices, 3);
    };
    if (source.mNormals) mesh.look.put(0, 0, rows_of(source.mNormals));
    for (unsigned set = 0; set < AI_MAX_NUMBER_OF_TEXTURECOORDS && source.mTextureCoords[set]; ++set) {
        const Rows uv = rows_of(source.mTextureCoords[set]);
        mesh.look.put(0, 3 + 2 * set,
                      // glTF's v: down
                      (Eigen::MatrixX2f(uv.rows(), 2) << uv.col(0), (1.0F - uv.col(1).array()).matrix()).finished());
    }
    for (unsigned joint = 0; joint < source.mNumBones; ++joint)
        mesh.joints.push_back({joint_named(source.mBones[joint]->mName.C_Str(), nodes, rig),
                               to_eigen(source.mBones[joint]->mOffsetMatrix)});
    for (const SkinJoint& joint : mesh.joints)
        if (!(std::abs(joint.inverse_bind.linear().determinant()) > 0.0))
            throw InputError(rig.file, 0,
                             "mesh " + mesh.name + ", joint " + rig.nodes[joint.node].name + ", inverse bind matrix",
                             "", "expected a matrix that has an inverse");
    if (!mesh.joints.empty()) mesh.skin = skin_of(source, mesh, rig);
    if (source.mNumAnimMeshes > 0)
        rig.remarks.push_back("mesh " + mesh.name + ": " + std::to_string(source.mNumAnimMeshes) +
                              " morph targets are left out");
    return mesh;
}

// Puts materials into the order in which an FBX file has them: those of one name in assimp's order, and ones that
// assimp left out, since no mesh uses them, without any property.
void order_materials(aiScene& scene, const std::vector<std::string>& names)
{
    std::vector<aiMaterial*> left(scene.mMaterials, scene.mMaterials + scene.mNumMaterials), ordered;
    for (const std::string& name : names) {
        const auto named =
            std::ranges::find_if(left, [&](const aiMaterial* material) { return material->GetName().C_Str() == name; });
        ordered.push_back(named == left.end() ? new aiMaterial : *named);
        if (named != left.end()) left.erase(named);
    }
    ordered.insert(ordered.end(), left.begin(), left.end());
    delete[] scene.mMaterials;
    scene.mNumMaterials = static_cast<unsigned>(ordered.size());
    scene.mMaterials = new aiMaterial*[ordered.size()];
    std::ranges::copy(ordered, scene.mMaterials);
}

}  // namespace

const aiScene& read_assimp_scene(Assimp::Importer& importer, const std::string& path, const std::string& text)
{
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    return read_scene(importer, path, aiProcess_Triangulate | aiProcess_JoinIdenticalVertices, text);
}

Rig rig_of_scene(const aiScene& scene, const std::string& path)
{
    Rig rig;
    rig.file = path;
    Nodes nodes;
    add_node(*scene.mRootNode, -1, nodes, rig);
    for (std::size_t n = 0; n < nodes.size(); ++n)
        for (unsigned m = 0; m < nodes[n]->mNumMeshes; ++m) {
            RigMesh mesh = mesh_of(*scene.mMeshes[nodes[n]->mMeshes[m]], static_cast<int>(n), nodes, rig);
            if (mesh.triangles.rows() > 0) rig.meshes.push_back(std::move(mesh));
        }
    add_assimp_animations(scene, rig);
    return rig;
}

RigMaterials read_assimp_materials(const std::string& path)
{
    Assimp::Importer importer;
    Assimp::Exporter exporter;
    read_assimp_scene(importer, path);
    const std::unique_ptr<aiScene> scene(importer.GetOrphanedScene());
    if (content_extension(path) == ".fbx") order_materials(*scene, fbx_material_names(path));
    const aiExportDataBlob* glb = exporter.ExportToBlob(scene.get(), "glb2");
    if (!glb)
        throw InputError(path, 0, "", "",
                         std::string("the materials, which assimp cannot write: ") + exporter.GetErrorString());
    return gltf_materials({static_cast<const char*>(glb->data), glb->size}, path);
}

Rig read_collada_rig(const std::string& path)
{
    const ColladaDocument document = read_collada_document(path);
    Assimp::Importer importer;
    Rig rig = rig_of_scene(read_assimp_scene(importer, path, document.text), path);
    rig.unit_m = document.unit_m;
    for (RigMesh& mesh : rig.meshes) {
        if (document.origins.empty()) break;
        const auto origin = document.origins.find(mesh.name);
        if (origin == document.origins.end())
            throw InputError(path, 0, "mesh of node " + rig.nodes[mesh.node].name, mesh.name,
                             "expected the id of a geometry, by which its distance from the origin is known, since the "
                             "file has points far "
                             "from it: give each geometry a short id of its own, or export glTF 2.0 (.glb)");
        mesh.points.rowwise() += origin->second.transpose();
    }
    rig.remarks.insert(rig.remarks.end(), document.remarks.begin(), document.remarks.end());
    return rig;
}

}  // namespace pbs
