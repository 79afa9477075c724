// The search for the cell size that gives the wanted number of vertices.
//   const TetMesh mesh = mesh_at_vertex_count(2000, 0.05, [&](double size) { return mesh_with_cells(size); });
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <utility>

namespace pbs {

// Calls mesh_at(cell size [m]) a few times, along the secant of log #V over log size, until the number of vertices is
// within 5 % of the wanted one; the nearest mesh otherwise. mesh_at may return an empty mesh where a size does not work
// out.
inline TetMesh mesh_at_vertex_count(int vertices, double first_size, const std::function<TetMesh(double size)>& mesh_at)
{
    constexpr int max_tries = 8;
    constexpr double tolerance = 0.05;
    const auto miss = [&](const TetMesh& mesh) { return std::abs(static_cast<double>(mesh.rest.rows()) - vertices); };
    TetMesh nearest;
    double size = first_size, last_size = 0.0, last_count = 0.0, slope = -2.5;
    for (int i = 0; i < max_tries; ++i) {
        TetMesh mesh = mesh_at(size);
        if (mesh.tets.rows() == 0) {
            size *= 0.9;
            continue;
        }
        const double count = static_cast<double>(mesh.rest.rows());
        if (nearest.tets.rows() == 0 || miss(mesh) < miss(nearest)) nearest = std::move(mesh);
        if (miss(nearest) <= tolerance * vertices) break;
        if (last_count > 0.0) {  // of log #V over log size, kept between a surface's (-2) and more than a volume's (-4)
            const double run = std::log(size) - std::log(last_size);
            slope = run == 0.0 ? -2.5 : std::clamp((std::log(count) - std::log(last_count)) / run, -4.0, -2.0);
        }
        last_size = size;
        last_count = count;
        size *= std::pow(vertices / count, 1.0 / slope);
    }
    return nearest;
}

}  // namespace pbs
