// Surfaces by assimp, in its single precision.
#include "pbs/geometry/mesh_io_formats.hpp"

#include "pbs/geometry/assimp_files.hpp"
#include "pbs/geometry/assimp_unit.hpp"
#include "pbs/geometry/input_error.hpp"

#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <new>
#include <string>
#include <vector>

namespace pbs {
namespace {

// assimp takes a negative index of COLLADA's <p> for 0 and goes on with a torn surface.
void refuse_negative_indices(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    for (std::size_t open = text.find("<p"); open != std::string::npos; open = text.find("<p", open + 1)) {
        if (text.find_first_of("> \t\r\n", open) != open + 2) continue;  // <param, ...
        const std::size_t begin = text.find('>', open), close = std::min(text.find('<', open + 1), text.size());
        const std::size_t minus = text.find('-', begin);
        if (minus >= close) continue;
        const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(minus), '\n');
        throw InputError(path, static_cast<int>(line), "p", text.substr(minus, text.find_first_of(" \t\r\n<", minus) - minus),
                         "expected indices from 0");
    }
}

// The parts of a file that assimp's warnings report as left out.
class LeftOut {
public:
    LeftOut()
    {
        Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
        Assimp::DefaultLogger::get()->attachStream(&warnings_, Assimp::Logger::Warn);
    }
    ~LeftOut()
    {
        Assimp::DefaultLogger::get()->detachStream(&warnings_, Assimp::Logger::Warn);
        Assimp::DefaultLogger::kill();
    }
    LeftOut(const LeftOut&) = delete;
    LeftOut& operator=(const LeftOut&) = delete;

    void throw_if_any(const std::string& path) const
    {
        if (!warnings_.first.empty()) throw InputError(path, 0, "", "", "assimp: " + warnings_.first);
    }

private:
    struct Warnings : Assimp::LogStream {
        void write(const char* message) override
        {
            const std::string text = message;  // "Warn,  T0: Some faces had out-of-range indices. Those faces were dropped.\n"
            if (text.find("dropped") == std::string::npos || !first.empty()) return;
            const std::size_t level = text.find(": ");
            first = text.substr(level == std::string::npos ? 0 : level + 2);
            first.erase(first.find_last_not_of(" \n") + 1);
        }
        std::string first;
    };
    Warnings warnings_;
};

struct Collected {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::string names;  // of all meshes
};

void add_mesh(const aiMesh& mesh, const aiMatrix4x4& to_world, Collected& collected)
{
    const int first = static_cast<int>(collected.points.size());
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const aiVector3D p = to_world * mesh.mVertices[i];
        collected.points.emplace_back(p.x, p.y, p.z);
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        if (face.mNumIndices != 3) continue;  // points and lines
        collected.triangles.push_back({first + static_cast<int>(face.mIndices[0]), first + static_cast<int>(face.mIndices[1]),
                                       first + static_cast<int>(face.mIndices[2])});
    }
}

// Meshes under a node, in world space.
void add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, const std::string& wanted, Collected& collected)
{
    const aiMatrix4x4 to_world = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
        const std::string name = mesh.mName.C_Str();
        collected.names += (collected.names.empty() ? "" : ", ") + name;
        if (wanted.empty() || wanted == name || wanted == node.mName.C_Str()) add_mesh(mesh, to_world, collected);
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(scene, *node.mChildren[i], to_world, wanted, collected);
}

}  // namespace

IndexedPoints read_assimp(const std::string& path, const std::string& mesh_name)
{
    if (format_extension(path) == ".dae") refuse_negative_indices(path);
    Assimp::Importer importer;
    const OwnFolder& files = only_own_folder(importer, path);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
    const LeftOut left_out;
    const aiScene* scene = importer.ReadFile(files.name_by_content(), aiProcess_Triangulate);
    if (!scene) files.refuse_what_was_referred_to();
    if (importer.GetErrorString() == std::string("std::bad_alloc")) throw std::bad_alloc();  // which assimp catches
    if (!scene || !scene->mRootNode) throw InputError(path, 0, "", "", std::string("assimp: ") + importer.GetErrorString());

    left_out.throw_if_any(path);

    Collected collected;
    add_node(*scene, *scene->mRootNode, aiMatrix4x4(), mesh_name, collected);
    if (collected.triangles.empty() && !mesh_name.empty())
        throw InputError(path, 0, "mesh", mesh_name, "expected one of the file's meshes: " + collected.names);
    const double unit_m = metres_per_unit(*scene);
    IndexedPoints mesh;
    mesh.points.resize(static_cast<Eigen::Index>(collected.points.size()), 3);
    mesh.cells.resize(static_cast<Eigen::Index>(collected.triangles.size()), 3);
    for (std::size_t i = 0; i < collected.points.size(); ++i)
        mesh.points.row(static_cast<Eigen::Index>(i)) = unit_m * collected.points[i].transpose();
    for (std::size_t f = 0; f < collected.triangles.size(); ++f)
        mesh.cells.row(static_cast<Eigen::Index>(f)) << collected.triangles[f][0], collected.triangles[f][1], collected.triangles[f][2];
    return mesh;
}

}  // namespace pbs
