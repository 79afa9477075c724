#include "experiments/characters/thin_shells.hpp"

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace pbs {
namespace {

struct Shell {
    std::vector<int> triangles;
    double area_m2 = 0.0, volume_m3 = 0.0;
};

std::vector<Shell> shells_of(const SurfaceMesh& surface)
{
    const Triangles joined = joined_triangles(surface.points, surface.triangles);
    Classes classes(static_cast<std::size_t>(surface.points.rows()));
    for (const auto& triangle : joined.rowwise())
        for (const int corner : triangle) classes.unite(triangle(0), corner);
    std::map<int, Shell> by_class;
    for (int t = 0; t < static_cast<int>(joined.rows()); ++t)
        by_class[classes.find(joined(t, 0))].triangles.push_back(t);
    std::vector<Shell> shells;
    for (auto& [own, shell] : by_class) {
        const Triangles own_triangles = surface.triangles(shell.triangles, Eigen::all);
        shell.area_m2 = surface_area(surface.points, own_triangles);
        const Eigen::VectorXi corners = own_triangles.reshaped();
        const Positions points = surface.points(corners, Eigen::all);  // of this shell alone, for the middle of the fan
        const auto count = own_triangles.rows();
        const Triangles of_points =
            Eigen::VectorXi::LinSpaced(3 * count, 0, static_cast<int>(3 * count) - 1).reshaped(count, 3);
        shell.volume_m3 = std::abs(fan_volume(points, of_points));
        shells.push_back(std::move(shell));
    }
    return shells;
}

}  // namespace

ThickShells thick_shells(const SurfaceMesh& surface, int vertices)
{
    const std::vector<Shell> shells = shells_of(surface);
    double volume_m3 = 0.0;
    for (const Shell& shell : shells) volume_m3 += shell.volume_m3;
    // of spheres packed as densely as they can be
    const double edge_m = std::cbrt(std::sqrt(2.0) * volume_m3 / vertices);
    const auto largest = std::ranges::max_element(shells, {}, &Shell::volume_m3);
    ThickShells thick;
    std::vector<int> kept;
    for (auto shell = shells.begin(); shell != shells.end(); ++shell)
        if (shell == largest || 4.0 * shell->volume_m3 >= edge_m * shell->area_m2)
            kept.insert(kept.end(), shell->triangles.begin(), shell->triangles.end());
        else
            ++thick.left_out;
    std::ranges::sort(kept);
    thick.triangles = surface.triangles(kept, Eigen::all);
    return thick;
}

SurfaceMesh used_part(const SurfaceMesh& surface)
{
    std::map<int, int> number;
    for (const int corner : surface.triangles.reshaped()) number[corner] = 0;
    std::vector<int> used;
    for (auto& [point, own] : number) {
        own = static_cast<int>(used.size());
        used.push_back(point);
    }
    return {surface.points(used, Eigen::all),
            surface.triangles.unaryExpr([&](int corner) { return number.at(corner); })};
}

}  // namespace pbs
