// Points are joined where their coordinates are equal; assimp's own joining has an absolute tolerance of 1e-5, which
// would merge a small body.
#include "experiments/rigs/surface_reader.hpp"

#include "experiments/meshes/content_format.hpp"
#include "experiments/meshes/guarded_reading.hpp"
#include "experiments/meshes/mesh_io_formats.hpp"
#include "experiments/rigs/rig_formats.hpp"
#include "experiments/rigs/rig_reader.hpp"
#include "experiments/rigs/rigged_body.hpp"
#include "pbs/geometry/input_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

namespace pbs {
namespace {

constexpr std::array<std::string_view, 5> extensions = {".obj", ".ply", ".off", ".stl", ".vtp"};  // in pbs/geometry

void append(const Positions& points, const Triangles& triangles, SurfaceMesh& surface)
{
    const Eigen::Index first = surface.points.rows(), first_triangle = surface.triangles.rows();
    surface.points.conservativeResize(first + points.rows(), 3);
    surface.points.bottomRows(points.rows()) = points;
    surface.triangles.conservativeResize(first_triangle + triangles.rows(), 3);
    surface.triangles.bottomRows(triangles.rows()) = triangles.array() + static_cast<int>(first);
}

// The meshes of this name, or of nodes of this name.
void keep_meshes_named(const std::string& name, Rig& rig)
{
    std::string names;
    for (const RigMesh& mesh : rig.meshes) names += (names.empty() ? "" : ", ") + mesh.name;
    std::erase_if(rig.meshes,
                  [&](const RigMesh& mesh) { return mesh.name != name && rig.nodes[mesh.node].name != name; });
    if (rig.meshes.empty()) throw InputError(rig.file, 0, "mesh", name, "expected one of the file's meshes: " + names);
}

// The scene as it stands. If it has a mesh with a skin: what joints move, in the bind pose, as `pbskin measure
// hero.glb` has it.
SurfaceReading surface_of_rig(const std::string& path, const std::string& mesh_name)
{
    Rig rig = read_rig(path);
    if (!mesh_name.empty()) keep_meshes_named(mesh_name, rig);
    SurfaceReading surface;
    surface.has_skin = std::ranges::any_of(rig.meshes, [](const RigMesh& mesh) { return !mesh.joints.empty(); });
    if (surface.has_skin) {
        const RigBinding binding = bind_rig(rig, nullptr, 1.0);
        for (const RigMesh& mesh : binding.meshes) append(rest_points(mesh, binding), mesh.triangles, surface.mesh);
        rig.remarks.insert(rig.remarks.end(), binding.remarks.begin(), binding.remarks.end());
    } else {
        const std::vector<Eigen::Affine3d> nodes = node_transforms(rig, nullptr, 0.0);
        for (const RigMesh& mesh : rig.meshes)
            append(rig.unit_m * skinned_points(mesh, nodes), mesh.triangles, surface.mesh);
    }
    surface.remarks = rig.remarks;
    return surface;
}

// The surface as the file has it: at least one triangle and one point, finite coordinates within 1e9 m, indices in
// range. Each violation is an InputError that names the file, the place, its value and the rule.
void check_raw_surface(const std::string& path, const SurfaceMesh& mesh)
{
    if (mesh.triangles.rows() == 0) throw InputError(path, 0, "triangles", "0", "expected at least one triangle");
    for (Eigen::Index i = 0; i < mesh.points.rows(); ++i) {
        if (mesh.points.row(i).cwiseAbs().maxCoeff() <= farthest_m && mesh.points.row(i).allFinite()) continue;
        throw InputError(path, 0, "vertex " + std::to_string(i), "",
                         "expected finite coordinates within 1e9 m of the origin");
    }
    require_points(path, mesh.points.rows());
    for (Eigen::Index f = 0; f < mesh.triangles.rows(); ++f)
        for (const int point : mesh.triangles.row(f))
            if (point < 0 || point >= mesh.points.rows())
                throw InputError(path, 0, "triangle " + std::to_string(f) + " vertex", std::to_string(point),
                                 expected_whole("an index", 0, mesh.points.rows() - 1));
}

bool is_rig_extension(const std::string& extension)
{
    return extension == ".gltf" || extension == ".glb" || extension == ".dae" || extension == ".zae" ||
           extension == ".fbx";
}

SurfaceMesh read_by_library(const std::string& path, const std::string& mesh_name)
{
    const std::string extension = format_extension(path);
    if (extension == ".obj") return read_obj(path, mesh_name);
    if (!mesh_name.empty())
        throw InputError(path, 0, "mesh", mesh_name, "expected no name: such a file holds one mesh");
    if (extension == ".vtp") return read_vtp(path);
#ifdef PBS_WITH_CGAL
    return read_polygons(path);
#else
    throw InputError(path, 0, "", "",
                     "this build reads no " + extension + " files: configure it with -DPBS_WITH_CGAL=ON");
#endif
}

int unused_points(const SurfaceMesh& mesh)
{
    std::vector<bool> used(static_cast<std::size_t>(mesh.points.rows()));
    for (const int point : mesh.triangles.reshaped()) used[static_cast<std::size_t>(point)] = true;
    return static_cast<int>(std::count(used.begin(), used.end(), false));
}

// The points that triangles use, in the order of first use; triangles that joining makes a line or a point are left
// out.
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
        if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
            triangles.push_back(triangle);
    }
    SurfaceMesh surface{Positions(static_cast<Eigen::Index>(index_of.size()), 3),
                        Triangles(static_cast<Eigen::Index>(triangles.size()), 3)};
    for (const auto& [p, index] : index_of) surface.points.row(index) << p[0], p[1], p[2];
    for (std::size_t f = 0; f < triangles.size(); ++f)
        surface.triangles.row(static_cast<Eigen::Index>(f)) << triangles[f][0], triangles[f][1], triangles[f][2];
    require_extent(path, surface.points);
    if (triangles.empty())
        throw InputError(path, 0, "triangles", std::to_string(mesh.triangles.rows()),
                         "expected one whose three corners differ");
    return surface;
}

SurfaceReading checked_surface(const std::string& path, const std::string& mesh_name)
{
    const SourceFile file(path);
    require_readable(path, most_mesh_bytes);
    const std::string content = content_extension(path), extension = format_extension(path);
    if (!is_surface_file(path))
        throw InputError(path, 0, content.empty() ? "extension" : "format of the content", extension,
                         "expected a surface: .obj, .ply, .off, .stl, .vtp, .gltf, .glb, .dae, .zae or .fbx");
    SurfaceReading surface;
    if (is_rig_extension(extension))
        surface = surface_of_rig(path, mesh_name);
    else
        surface.mesh = read_guarded(path, "surface " + mesh_name,
                                    [&](const std::string& file) { return read_by_library(file, mesh_name); });
    check_raw_surface(path, surface.mesh);
    if (!is_rig_extension(extension))  // the readers of rigs look at each mesh before its node moves it
        if (const std::string remark = remark_on_single_precision(surface.mesh.points, surface.mesh.triangles);
            !remark.empty())
            surface.remarks.push_back(remark);
    return surface;
}

}  // namespace

std::string remark_on_single_precision(const Positions& points, const Triangles& triangles)
{
    constexpr double steps_of_a_good_body = 1e5;
    const auto is_single = [](double x) { return static_cast<double>(static_cast<float>(x)) == x; };
    if (points.rows() == 0 || !points.reshaped().unaryExpr(is_single).all()) return "";
    const double farthest = points.cwiseAbs().maxCoeff();
    if (!(farthest > 0.0)) return "";
    const double step = std::ldexp(1.0, std::ilogb(farthest) - std::numeric_limits<float>::digits + 1);
    const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
    if (!(size < steps_of_a_good_body * step)) return "";
    const double area = surface_area(points, triangles);
    // Each point is up to half a step off in each direction, and the volume by at most the area times that distance.
    const double volume_pct = 100.0 * area * 0.5 * std::sqrt(3.0) * step / std::abs(fan_volume(points, triangles));
    return "coordinates in single precision up to " + number_text(farthest, 3) +
           " from the origin, where they are multiples of " + number_text(step, 2) + ": the size of " +
           number_text(size, 3) + " has only " + number_text(size / step, 1) + " steps, and the volume is " +
           (volume_pct < 100.0 ? "known to " + number_text(volume_pct, 1) + " %" : "not known") +
           "; move the model to the origin before it is exported, or use a format in double precision";
}

bool is_surface_file(const std::string& path)
{
    if (lower_extension(path) == ".tobj") return false;  // tets, which begin as an .obj does
    const std::string extension = format_extension(path);
    return is_rig_extension(extension) || std::ranges::find(extensions, extension) != extensions.end();
}

SurfaceReading read_surface_frame(const std::string& path)
{
    SurfaceReading reading = checked_surface(path, "");
    SurfaceMesh& surface = reading.mesh;
    if (format_extension(path) != ".stl") return reading;
    surface.points = surface.points(surface.triangles.reshaped<Eigen::RowMajor>(), Eigen::all).eval();
    surface.triangles =
        Eigen::VectorXi::LinSpaced(surface.points.rows(), 0, static_cast<int>(surface.points.rows()) - 1)
            .reshaped<Eigen::RowMajor>(surface.triangles.rows(), 3);
    return reading;
}

SurfaceMesh read_surface(const std::string& path, const std::string& mesh_name)
{
    return joined(path, checked_surface(path, mesh_name).mesh);
}

SurfaceMesh read_surface(const std::string& path, std::vector<std::string>& remarks, double scale)
{
    remarks.clear();
    const SurfaceReading reading = checked_surface(path, "");
    const SurfaceMesh& read = reading.mesh;
    SurfaceMesh surface = joined(path, read);
    surface.points *= scale;
    for (const std::string& remark : reading.remarks) remarks.push_back(path + ": " + remark);
    const auto of_surface = remarks_on(path, surface, unused_points(read),
                                       static_cast<int>(read.triangles.rows() - surface.triangles.rows()));
    remarks.insert(remarks.end(), of_surface.begin(), of_surface.end());
    if (const std::string content = content_extension(path); !content.empty() && content != lower_extension(path))
        remarks.insert(remarks.begin(), remark_on_name(path, content));
    return surface;
}

}  // namespace pbs
