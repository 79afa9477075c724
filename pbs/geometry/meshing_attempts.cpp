#include "pbs/geometry/meshing_attempts.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace pbs {
namespace {

constexpr int max_tries = 8;
constexpr double tolerance = 0.05;

struct Try {
    double size = 0.0;
    double count = 0.0;
};

// Slope of log #V over log size between two tries, kept between a surface's (-2) and more than a volume's (-4).
double slope_of(const Try& a, const Try& b)
{
    const double run = std::log(a.size) - std::log(b.size);
    if (run == 0.0) return -2.5;
    return std::clamp((std::log(a.count) - std::log(b.count)) / run, -4.0, -2.0);
}

}  // namespace

TetMesh mesh_at_vertex_count(int vertices, double first_size, const std::function<TetMesh(double size)>& mesh_at)
{
    TetMesh nearest;
    Try last;
    double size = first_size, slope = -2.5;
    for (int i = 0; i < max_tries; ++i) {
        TetMesh mesh = mesh_at(size);
        if (mesh.tets.rows() == 0) {
            size *= 0.9;
            continue;
        }
        const Try now{size, static_cast<double>(mesh.rest.rows())};
        const auto miss = [&](const TetMesh& m) { return std::abs(static_cast<double>(m.rest.rows()) - vertices); };
        if (nearest.tets.rows() == 0 || miss(mesh) < miss(nearest)) nearest = std::move(mesh);
        if (miss(nearest) <= tolerance * vertices) break;
        if (last.count > 0.0) slope = slope_of(now, last);
        last = now;
        size *= std::pow(vertices / now.count, 1.0 / slope);
    }
    return nearest;
}

namespace {

// |V| / diagonal^3 is 0.19 of the cube. Rounding leaves 1e-16 of a flat surface; a body so thin would be all wrap.
constexpr double flat_surface = 1e-12;
constexpr double smallest_m = 1e-9;       // squares and cubes of cells of a smaller surface leave the range that CGAL can compare
constexpr double sheet_thickness = 0.05;  // over the diagonal: some tets across it at the default number of vertices

}  // namespace

void check_surface(const SurfaceMesh& surface, const SurfaceMeshing& options)
{
    if (options.vertices < 150) throw InputError("", 0, "vertices", std::to_string(options.vertices), "expected at least 150");
    if (surface.triangles.rows() < 4)
        throw InputError("", 0, "triangles", std::to_string(surface.triangles.rows()), "expected a closed surface: at least 4");
    if (!surface.points.allFinite()) throw InputError("", 0, "points", "", "expected finite coordinates [m]");
    if (surface.triangles.minCoeff() < 0 || surface.triangles.maxCoeff() >= surface.points.rows())
        throw InputError("", 0, "triangles", "", "expected indices of points");
    const double diagonal = (surface.points.colwise().maxCoeff() - surface.points.colwise().minCoeff()).norm();
    if (!(diagonal >= smallest_m))
        throw InputError("", 0, "diagonal of the surface [m]", number_text(diagonal), "expected at least " + number_text(smallest_m));
    if (options.is_closed && sheet_offset_m(surface) > 0.0)
        throw InputError("", 0, "enclosed volume [m^3]", number_text(fan_volume(surface.points, surface.triangles)),
                         "expected a closed surface round a volume, neither flat nor open");
}

double sheet_offset_m(const SurfaceMesh& surface)
{
    const double diagonal = (surface.points.colwise().maxCoeff() - surface.points.colwise().minCoeff()).norm();
    const bool has_volume = std::abs(fan_volume(surface.points, surface.triangles)) > flat_surface * diagonal * diagonal * diagonal;
    return has_volume ? 0.0 : diagonal * sheet_thickness / 2.0;
}

std::string breach_of(const TetMesh& mesh, const SurfaceMeshing& options)
{
    if (mesh.tets.rows() == 0) return "no tets";
    const Quality quality = quality_of(mesh);
    if (!quality.topology.boundary_manifold) return boundary_not_manifold;
    if (options.is_one_piece && quality.topology.components != 1) return std::to_string(quality.topology.components) + " pieces";
    if (options.boundary_euler && quality.topology.boundary_euler != *options.boundary_euler)
        return "Euler number of the boundary " + std::to_string(quality.topology.boundary_euler) + ", expected " +
               std::to_string(*options.boundary_euler);
    if (quality.min_dihedral_deg < options.min_dihedral_deg)
        return "smallest dihedral angle " + std::to_string(quality.min_dihedral_deg) + " deg";

    const Triangles boundary = boundary_of(mesh.tets);
    if (self_intersects(mesh.rest, boundary)) return "the boundary intersects itself";
    if (options.inside.empty()) return "";
    const std::vector<bool> inside = points_inside(mesh.rest, boundary, options.inside);
    const auto outside = std::count(inside.begin(), inside.end(), false);
    if (outside == 0) return "";
    const auto first = std::find(inside.begin(), inside.end(), false) - inside.begin();
    return std::to_string(outside) + " of the points asked inside are outside, the first is number " + std::to_string(first);
}

}  // namespace pbs
