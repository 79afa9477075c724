#include "experiments/rigs/fbx_polygons.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>

namespace pbs {
namespace {

// Twice the area of a triangle as seen along the normal.
double area_along(const Vec3& normal, const Vec3& a, const Vec3& b, const Vec3& c)
{
    return normal.dot((b - a).cross(c - a));
}

// Does the corner i of the ring turn to the left, with no other corner in its triangle?
bool is_ear(const std::vector<Vec3>& places, const std::vector<int>& ring, std::size_t i, const Vec3& normal)
{
    const std::size_t count = ring.size();
    const int before = ring[(i + count - 1) % count], own = ring[i], after = ring[(i + 1) % count];
    const Vec3 &a = places[before], &b = places[own], &c = places[after];
    if (!(area_along(normal, a, b, c) > 0.0)) return false;
    return std::ranges::none_of(ring, [&](int other) {
        const Vec3& p = places[other];
        return other != before && other != own && other != after && area_along(normal, a, b, p) > 0.0 &&
               area_along(normal, b, c, p) > 0.0 && area_along(normal, c, a, p) > 0.0;
    });
}

// Corners by their places in the polygon, three per triangle.
std::vector<int> triangles_of(const std::vector<Vec3>& places)
{
    std::vector<int> ring(places.size()), triangles;
    std::iota(ring.begin(), ring.end(), 0);
    Vec3 normal = Vec3::Zero();
    for (std::size_t i = 0; i + 1 < places.size(); ++i)
        normal += (places[i] - places[0]).cross(places[i + 1] - places[0]);
    while (ring.size() > 3) {
        // A convex quadrangle is cut along its first diagonal: the ear is the corner 1.
        std::size_t ear = 1;
        for (std::size_t tried = 0; tried < ring.size() && !is_ear(places, ring, ear, normal); ++tried)
            ear = (ear + 1) % ring.size();
        const std::size_t count = ring.size();
        triangles.insert(triangles.end(), {ring[(ear + count - 1) % count], ring[ear], ring[(ear + 1) % count]});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    triangles.insert(triangles.end(), ring.begin(), ring.end());
    return triangles;
}

}  // namespace

void triangulate(const Positions& points, FbxPolygons& polygons)
{
    std::size_t begin = 0;
    for (std::size_t polygon = 0; polygon < polygons.ends.size(); begin = polygons.ends[polygon++]) {
        std::vector<Vec3> places;
        for (std::size_t corner = begin; corner < polygons.ends[polygon]; ++corner)
            places.push_back(points.row(polygons.corners[corner]));
        if (places.size() < 3) continue;
        for (const int corner : triangles_of(places)) polygons.triangles.push_back(static_cast<int>(begin) + corner);
        polygons.polygon.resize(polygons.triangles.size() / 3, polygon);
    }
}

}  // namespace pbs
