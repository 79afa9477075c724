#include "pbs/geometry/meshing_count.hpp"

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

}  // namespace pbs
