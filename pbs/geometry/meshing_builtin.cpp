// The built-in bodies: a capsule from its distance function, a bar from its eight corners.
#include "pbs/geometry/meshing.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/meshing_attempts.hpp"
#include "pbs/geometry/meshing_cgal.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <variant>
#include <vector>

namespace pbs {
namespace {

constexpr double half_length = 1.0;  // [m]
constexpr double radius = 0.15;      // [m], half the bar's width

// Signed distance to the capsule round the segment (-1,0,0) -> (1,0,0).
double capsule_distance(const Point& p)
{
    const double along = p.x() - std::clamp(p.x(), -half_length, half_length);
    return std::sqrt(along * along + p.y() * p.y() + p.z() * p.z()) - radius;
}

class Capsule : public MeshedBody {
public:
    CGAL::Bbox_3 box() const override { return box_.bbox(); }
    bool contains(const Point& p) const override { return capsule_distance(p) < 0.0; }

    std::optional<SkinPoint> crossing(const Line& line) const override
    {
        if (const auto* segment = std::get_if<Kernel::Segment_3>(&line)) return crossing(*segment);
        const auto part = clipped(line, box_);
        return part ? crossing(*part) : std::nullopt;
    }

    // CGAL would begin with a dozen random points; where two fall close together a short edge stays, whatever the cell size. Here these are
    // the poles and three rings of three.
    std::vector<SkinPoint> initial_points() const override
    {
        std::vector<SkinPoint> points = {{Point(-half_length - radius, 0, 0), 1}, {Point(half_length + radius, 0, 0), 1}};
        for (int ring = -1; ring <= 1; ++ring)
            for (int k = 0; k < 3; ++k) {
                const double angle = std::numbers::pi / 3.0 * (2 * k + ring);
                points.emplace_back(Point(0.7 * half_length * ring, radius * std::cos(angle), radius * std::sin(angle)), 1);
            }
        return points;
    }

private:
    // By bisection.
    std::optional<SkinPoint> crossing(const Kernel::Segment_3& segment) const
    {
        Point p = segment.source(), q = segment.target();
        const bool begins_inside = contains(p);
        if (contains(q) == begins_inside) return std::nullopt;
        Point middle = CGAL::midpoint(p, q);
        while (CGAL::squared_distance(p, q) >= squared_error_) {
            (contains(middle) == begins_inside ? p : q) = middle;
            middle = CGAL::midpoint(p, q);
        }
        return SkinPoint(middle, 1);
    }

    Kernel::Iso_cuboid_3 box_{Kernel::Sphere_3(Point(0, 0, 0), 4.0).bbox()};  // centre, squared radius
    double squared_error_ = CGAL::squared_distance(box_.min(), box_.max()) * 1e-9 * 1e-9 / 4;
};

std::unique_ptr<MeshedBody> make_bar()
{
    const double x = half_length, r = radius;
    const std::vector<Point> corners = {{-x, -r, -r}, {x, -r, -r}, {x, r, -r}, {-x, r, -r}, {-x, r, r}, {-x, -r, r}, {x, -r, r}, {x, r, r}};
    const std::vector<PatchTriangle> triangles = {{6, 4, 5, 1}, {2, 0, 3, 2}, {7, 1, 2, 3}, {6, 0, 1, 4}, {5, 3, 0, 5}, {4, 2, 3, 6},
                                                  {4, 6, 7, 1}, {0, 2, 1, 2}, {1, 7, 6, 3}, {0, 6, 5, 4}, {3, 5, 4, 5}, {2, 4, 7, 6}};
    return make_enclosed_body(corners, triangles);
}

// vertices: see mesh_limb. least: below, cells as large as the body is thick, and no vertex inside.
TetMesh mesh_builtin(MeshedBody& body, int vertices, int least)
{
    if (vertices < least) throw InputError("", 0, "vertices", std::to_string(vertices), "expected at least " + std::to_string(least));
    return mesh_at_vertex_count(vertices, 0.78 * std::pow(vertices, -0.36), [&](double size) {
        return mesh_body(body, {.facet_size = size, .cell_size = size, .facet_distance = 0.1 * size, .sliver_bound_deg = 0.0});
    });
}

}  // namespace

TetMesh mesh_limb(int vertices)
{
    Capsule capsule;
    return mesh_builtin(capsule, vertices, 300);
}

TetMesh mesh_bar(int vertices)
{
    return mesh_builtin(*make_bar(), vertices, 150);
}

}  // namespace pbs
