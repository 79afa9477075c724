// Surfaces: which library reads them, by content, and what is made of its points and triangles. Points are joined where their coordinates
// are equal; assimp's own joining has an absolute tolerance of 1e-5, which would merge a small body.

#include "pbs/geometry/assimp_files.hpp"
#include "pbs/geometry/content_format.hpp"
#include "pbs/geometry/child_process.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"

#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace pbs {
namespace {

constexpr std::array<std::string_view, 10> extensions = {".obj", ".ply", ".off", ".stl", ".vtp", ".gltf", ".glb", ".dae", ".zae", ".fbx"};

// assimp takes a negative index of COLLADA's <p> for 0 and goes on with a torn surface.
void refuse_negative_indices(const std::string& path)
{
    const std::string text = read_text_file(path, most_mesh_bytes);
    for (std::size_t open = text.find("<p"); open != std::string::npos; open = text.find("<p", open + 1)) {
        if (text.find_first_of("> \t\r\n", open) != open + 2) continue;  // <param, ...
        const std::size_t begin = text.find('>', open), close = std::min(text.find('<', open + 1), text.size());
        const std::size_t minus = text.find('-', begin);
        if (minus >= close) continue;
        throw InputError(path, line_at(text, minus), "p", text.substr(minus, text.find_first_of(" \t\r\n<", minus) - minus),
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
    std::vector<double> points;
    std::vector<int> corners;  // of triangles
    std::string names;         // of all meshes
};

void add_mesh(const aiMesh& mesh, const aiMatrix4x4& to_world, Collected& collected)
{
    const int first = static_cast<int>(collected.points.size() / 3);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const aiVector3D p = to_world * mesh.mVertices[i];
        collected.points.insert(collected.points.end(), {p.x, p.y, p.z});
    }
    add_triangles(mesh, first, collected.corners);
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

// By assimp, in its single precision.
SurfaceMesh read_assimp(const std::string& path, const std::string& mesh_name)
{
    if (format_extension(path) == ".dae") refuse_negative_indices(path);
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
    const LeftOut left_out;
    const aiScene& scene = read_scene(importer, path, aiProcess_Triangulate);
    left_out.throw_if_any(path);

    Collected collected;
    add_node(scene, *scene.mRootNode, aiMatrix4x4(), mesh_name, collected);
    if (collected.corners.empty() && !mesh_name.empty())
        throw InputError(path, 0, "mesh", mesh_name, "expected one of the file's meshes: " + collected.names);
    const auto points = static_cast<Eigen::Index>(collected.points.size() / 3),
               triangles = static_cast<Eigen::Index>(collected.corners.size() / 3);
    return {metres_per_unit(scene) * Eigen::Map<const Positions>(collected.points.data(), points, 3),
            Eigen::Map<const Triangles>(collected.corners.data(), triangles, 3)};
}

// The surface as the file has it: at least one triangle and one point, finite coordinates within 1e9 m, indices in range. Each violation is
// an InputError that names the file, the place, its value and the rule.
void check_raw_surface(const std::string& path, const SurfaceMesh& mesh)
{
    if (mesh.triangles.rows() == 0) throw InputError(path, 0, "triangles", "0", "expected at least one triangle");
    for (Eigen::Index i = 0; i < mesh.points.rows(); ++i) {
        if (mesh.points.row(i).cwiseAbs().maxCoeff() <= farthest_m && mesh.points.row(i).allFinite()) continue;
        throw InputError(path, 0, "vertex " + std::to_string(i), "", "expected finite coordinates within 1e9 m of the origin");
    }
    require_points(path, mesh.points.rows());
    for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f)
        for (const int point : mesh.triangles.row(f))
            if (point < 0 || point >= mesh.points.rows())
                throw InputError(path, 0, "triangle " + std::to_string(f) + " vertex", std::to_string(point),
                                 expected_whole("an index", 0, mesh.points.rows() - 1));
}

SurfaceMesh read_by_library(const std::string& path, const std::string& mesh_name)
{
    const std::string extension = format_extension(path);
    if (extension == ".obj") return read_obj(path, mesh_name);
    if (extension == ".vtp" && mesh_name.empty()) return read_vtp(path);
    if (extension != ".ply" && extension != ".off" && extension != ".stl" && extension != ".vtp") return read_assimp(path, mesh_name);
    if (!mesh_name.empty()) throw InputError(path, 0, "mesh", mesh_name, "expected no name: such a file holds one mesh");
#ifdef PBS_WITH_CGAL
    return read_polygons(path);
#else
    throw InputError(path, 0, "", "", "this build reads no " + extension + " files: configure it with -DPBS_WITH_CGAL=ON");
#endif
}

int unused_points(const SurfaceMesh& mesh)
{
    std::vector<bool> used(static_cast<std::size_t>(mesh.points.rows()));
    for (const int point : mesh.triangles.reshaped()) used[static_cast<std::size_t>(point)] = true;
    return static_cast<int>(std::count(used.begin(), used.end(), false));
}

// The points that triangles use, in the order of first use; triangles that joining makes a line or a point are left out.
SurfaceMesh joined(const std::string& path, const SurfaceMesh& mesh)
{
    std::map<std::array<double, 3>, int> index_of;
    std::vector<std::array<int, 3>> triangles;
    for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f) {
        std::array<int, 3> triangle{};
        for (Eigen::Index k = 0; k < 3; ++k) {
            const auto p = mesh.points.row(mesh.triangles(f, k));
            triangle[static_cast<std::size_t>(k)] =
                index_of.emplace(std::array{p(0), p(1), p(2)}, static_cast<int>(index_of.size())).first->second;
        }
        if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0]) triangles.push_back(triangle);
    }
    SurfaceMesh surface{Positions(static_cast<Eigen::Index>(index_of.size()), 3),
                        Triangles(static_cast<Eigen::Index>(triangles.size()), 3)};
    for (const auto& [p, index] : index_of) surface.points.row(index) << p[0], p[1], p[2];
    for (std::size_t f = 0; f < triangles.size(); ++f)
        surface.triangles.row(static_cast<Eigen::Index>(f)) << triangles[f][0], triangles[f][1], triangles[f][2];
    require_extent(path, surface.points);
    if (triangles.empty())
        throw InputError(path, 0, "triangles", std::to_string(mesh.triangles.rows()), "expected one whose three corners differ");
    return surface;
}

SurfaceMesh checked_points(const std::string& path, const std::string& mesh_name)
{
    require_readable(path, most_mesh_bytes);
    const std::string content = content_extension(path), extension = format_extension(path);
    if (!is_surface_file(path))
        throw InputError(path, 0, content.empty() ? "extension" : "format of the content", extension,
                         "expected a surface: .obj, .ply, .off, .stl, .vtp, .gltf, .glb, .dae, .zae or .fbx");
    SurfaceMesh read = read_guarded(path, [&](const std::string& file) { return read_by_library(file, mesh_name); });
    check_raw_surface(path, read);
    return read;
}

}  // namespace

bool is_surface_file(const std::string& path)
{
    if (lower_extension(path) == ".tobj") return false;  // tets, which begin as an .obj does
    return std::find(extensions.begin(), extensions.end(), format_extension(path)) != extensions.end();
}

SurfaceMesh read_surface_frame(const std::string& path)
{
    SurfaceMesh surface = checked_points(path, "");
    if (format_extension(path) != ".stl") return surface;
    surface.points = surface.points(surface.triangles.reshaped<Eigen::RowMajor>(), Eigen::all).eval();
    surface.triangles = Eigen::VectorXi::LinSpaced(surface.points.rows(), 0, static_cast<int>(surface.points.rows()) - 1)
                            .reshaped<Eigen::RowMajor>(surface.triangles.rows(), 3);
    return surface;
}

SurfaceMesh read_surface(const std::string& path, const std::string& mesh_name)
{
    return joined(path, checked_points(path, mesh_name));
}

SurfaceMesh read_surface(const std::string& path, std::vector<std::string>& remarks, double scale)
{
    const SurfaceMesh read = checked_points(path, "");
    SurfaceMesh surface = joined(path, read);
    surface.points *= scale;
    remarks = remarks_on(path, surface, unused_points(read), static_cast<int>(read.triangles.rows() - surface.triangles.rows()));
    if (const std::string content = content_extension(path); !content.empty() && content != lower_extension(path))
        remarks.insert(remarks.begin(), remark_on_name(path, content));
    return surface;
}

}  // namespace pbs
