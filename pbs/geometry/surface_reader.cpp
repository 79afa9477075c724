// Surfaces: which library reads them, by content, and what is made of its points and triangles. Points are joined where their coordinates
// are equal; assimp's own joining has an absolute tolerance of 1e-5, which would merge a small body.
#include "pbs/geometry/mesh_io.hpp"

#include "pbs/geometry/content_format.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"
#include "pbs/geometry/mesh_remarks.hpp"
#include "pbs/geometry/surface_checks.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <vector>

namespace pbs {
namespace {

constexpr std::array<std::string_view, 9> extensions = {".obj", ".ply", ".off", ".stl", ".gltf", ".glb", ".dae", ".zae", ".fbx"};

IndexedPoints read_by_library(const std::string& path, const std::string& mesh_name)
{
    const std::string extension = format_extension(path);
    if (extension != ".ply" && extension != ".off" && extension != ".stl") return read_assimp(path, mesh_name);
    if (!mesh_name.empty()) throw InputError(path, 0, "mesh", mesh_name, "expected no name: such a file holds one mesh");
#ifdef PBS_WITH_CGAL
    return read_polygons(path);
#else
    throw InputError(path, 0, "", "", "this build reads no " + extension + " files: configure it with -DPBS_WITH_CGAL=ON");
#endif
}

int unused_points(const IndexedPoints& mesh)
{
    std::vector<bool> used(static_cast<std::size_t>(mesh.points.rows()));
    for (const int point : mesh.cells.reshaped()) used[static_cast<std::size_t>(point)] = true;
    return static_cast<int>(std::count(used.begin(), used.end(), false));
}

// The points that triangles use, in the order of first use; triangles that joining makes a line or a point are left out.
SurfaceMesh joined(const std::string& path, const IndexedPoints& mesh)
{
    std::map<std::array<double, 3>, int> index_of;
    std::vector<std::array<int, 3>> triangles;
    for (Eigen::Index f = 0; f < mesh.cells.rows(); ++f) {
        std::array<int, 3> triangle{};
        for (Eigen::Index k = 0; k < 3; ++k) {
            const auto p = mesh.points.row(mesh.cells(f, k));
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
        throw InputError(path, 0, "triangles", std::to_string(mesh.cells.rows()), "expected one whose three corners differ");
    return surface;
}

IndexedPoints checked_points(const std::string& path, const std::string& mesh_name)
{
    require_readable(path, most_mesh_bytes);
    const std::string content = content_extension(path), extension = format_extension(path);
    if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
        throw InputError(path, 0, content.empty() ? "extension" : "format of the content", extension,
                         "expected a surface: .obj, .ply, .off, .stl, .gltf, .glb, .dae, .zae or .fbx");
    IndexedPoints read = read_guarded(path, [&](const std::string& file) { return read_by_library(file, mesh_name); });
    check_raw_surface(path, read);
    return read;
}

}  // namespace

SurfaceMesh read_surface(const std::string& path, const std::string& mesh_name)
{
    return joined(path, checked_points(path, mesh_name));
}

SurfaceMesh read_surface(const std::string& path, std::vector<std::string>& remarks, double scale)
{
    const IndexedPoints read = checked_points(path, "");
    SurfaceMesh surface = joined(path, read);
    surface.points *= scale;
    remarks = remarks_on(path, surface, unused_points(read), static_cast<int>(read.cells.rows() - surface.triangles.rows()));
    if (const std::string content = content_extension(path); !content.empty() && content != lower_extension(path))
        remarks.insert(remarks.begin(), remark_on_name(path, content));
    return surface;
}

}  // namespace pbs
