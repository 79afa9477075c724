// Surfaces by assimp. Its joining of vertices has an absolute tolerance of 1e-5, which would merge a small body: joining is exact here.
#include "pbs/geometry/mesh_io.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <array>
#include <cmath>
#include <map>

namespace pbs {
namespace {

using Point = std::array<float, 3>;  // assimp's precision

// Joins points with equal coordinates, in the order of first use.
class SurfaceBuilder {
public:
    int joined(const Point& point)
    {
        const auto [entry, is_new] = index_of_.emplace(point, static_cast<int>(points_.size()));
        if (is_new) points_.push_back(point);
        return entry->second;
    }
    void add(const std::array<int, 3>& triangle) { triangles_.push_back(triangle); }
    bool has_triangles() const { return !triangles_.empty(); }

    IndexedPoints surface() const
    {
        IndexedPoints mesh;
        mesh.points.resize(static_cast<Eigen::Index>(points_.size()), 3);
        mesh.cells.resize(static_cast<Eigen::Index>(triangles_.size()), 3);
        for (std::size_t i = 0; i < points_.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) mesh.points(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = points_[i][k];
        for (std::size_t f = 0; f < triangles_.size(); ++f)
            for (std::size_t k = 0; k < 3; ++k) mesh.cells(static_cast<Eigen::Index>(f), static_cast<Eigen::Index>(k)) = triangles_[f][k];
        return mesh;
    }

private:
    std::map<Point, int> index_of_;
    std::vector<Point> points_;
    std::vector<std::array<int, 3>> triangles_;
};

void add_mesh(const std::string& path, const aiMesh& mesh, const aiMatrix4x4& to_world, SurfaceBuilder& builder)
{
    std::vector<int> index(mesh.mNumVertices);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const aiVector3D p = to_world * mesh.mVertices[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            throw InputError(path, 0, "vertex " + std::to_string(i), "", "expected finite coordinates [m]");
        index[i] = builder.joined({p.x, p.y, p.z});
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        if (face.mNumIndices != 3) continue;  // points and lines
        std::array<int, 3> triangle{};
        for (unsigned k = 0; k < 3; ++k) {
            if (face.mIndices[k] >= mesh.mNumVertices)
                throw InputError(path, 0, "face " + std::to_string(f) + " vertex", std::to_string(face.mIndices[k]),
                                 "expected an index from 0 to " + std::to_string(mesh.mNumVertices - 1));
            triangle[k] = index[face.mIndices[k]];
        }
        if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0]) builder.add(triangle);
    }
}

// Meshes under a node, in world space; `names` collects what there is.
void add_node(const std::string& path, const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, const std::string& wanted,
              SurfaceBuilder& builder, std::string& names)
{
    const aiMatrix4x4 to_world = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
        const std::string name = mesh.mName.C_Str();
        names += (names.empty() ? "" : ", ") + name;
        if (wanted.empty() || wanted == name || wanted == node.mName.C_Str()) add_mesh(path, mesh, to_world, builder);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(path, scene, *node.mChildren[i], to_world, wanted, builder, names);
}

IndexedPoints read_by_assimp(const std::string& path, const std::string& mesh_name)
{
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
    const std::string extension = lower_extension(path);
    if (extension.empty() || !importer.IsExtensionSupported(extension))
        throw InputError(path, 0, "extension", extension, "expected a surface: .obj, .ply, .off, .stl, .gltf, .glb, .dae or .zae");
    const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
    if (!scene || !scene->mRootNode) throw InputError(path, 0, "", "", std::string("assimp: ") + importer.GetErrorString());

    SurfaceBuilder builder;
    std::string names;
    add_node(path, *scene, *scene->mRootNode, aiMatrix4x4(), mesh_name, builder, names);
    if (!builder.has_triangles() && !mesh_name.empty())
        throw InputError(path, 0, "mesh", mesh_name, "expected one of the file's meshes: " + names);
    if (!builder.has_triangles()) throw InputError(path, 0, "triangles", "0", "expected at least one triangle");
    return builder.surface();
}

}  // namespace

SurfaceMesh read_surface(const std::string& path, const std::string& mesh_name)
{
    require_readable(path);
    const IndexedPoints read = read_guarded(path, [&](const std::string& file) { return read_by_assimp(file, mesh_name); });
    return {read.points, read.cells};
}

}  // namespace pbs
