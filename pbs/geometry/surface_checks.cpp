#include "pbs/geometry/surface_checks.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/mesh_io_formats.hpp"
#include "pbs/geometry/number_text.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace pbs {
namespace {

constexpr double farthest_m = 1e9;

}  // namespace

void check_raw_surface(const std::string& path, const IndexedPoints& mesh)
{
    if (mesh.cells.rows() == 0) throw InputError(path, 0, "triangles", "0", "expected at least one triangle");
    for (Eigen::Index i = 0; i < mesh.points.rows(); ++i)
        if (!(mesh.points.row(i).cwiseAbs().maxCoeff() <= farthest_m && mesh.points.row(i).allFinite()))
            throw InputError(path, 0, "vertex " + std::to_string(i), "", "expected finite coordinates within 1e9 m of the origin");
    require_points(path, mesh.points.rows());
    for (Eigen::Index f = 0; f < mesh.cells.rows(); ++f)
        for (Eigen::Index k = 0; k < 3; ++k)
            if (mesh.cells(f, k) < 0 || mesh.cells(f, k) >= mesh.points.rows())
                throw InputError(path, 0, "triangle " + std::to_string(f) + " vertex", std::to_string(mesh.cells(f, k)),
                                 expected_whole("an index", 0, mesh.points.rows() - 1));
}

void check_surface_edges(const std::string& path, const SurfaceMesh& surface)
{
    std::map<std::pair<int, int>, int> triangles_at;
    for (const auto& triangle : surface.triangles.rowwise())
        for (int k = 0; k < 3; ++k) ++triangles_at[std::minmax({triangle(k), triangle((k + 1) % 3)})];
    const auto joint = std::find_if(triangles_at.begin(), triangles_at.end(), [](const auto& edge) { return edge.second > 2; });
    if (joint == triangles_at.end()) return;
    const auto [from, to] = joint->first;
    throw InputError(path, 0, "edge", place_text(surface.points.row(from)) + " to " + place_text(surface.points.row(to)),
                     "expected in one or two triangles; it is in " + std::to_string(joint->second) + ", the surface not manifold there");
}

}  // namespace pbs
