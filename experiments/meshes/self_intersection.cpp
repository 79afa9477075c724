// Checks of closed triangle meshes, by CGAL's Polygon_mesh_processing.
#include "experiments/meshes/meshing.hpp"

#include "pbs/geometry/input_error.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_slicer.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>
#include <vector>

namespace pbs {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;

Point point_of(const Positions& positions, int v)
{
    return {positions(v, 0), positions(v, 1), positions(v, 2)};
}

// Where the triangles are not manifold, the vertices concerned are duplicated.
Surface surface_of(const Positions& positions, const Triangles& triangles)
{
    std::vector<Point> points;
    std::vector<std::array<std::size_t, 3>> corners;
    for (int i = 0; i < positions.rows(); ++i) points.push_back(point_of(positions, i));
    for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
        const auto vertex = [&](int corner) { return static_cast<std::size_t>(triangles(f, corner)); };
        corners.push_back({vertex(0), vertex(1), vertex(2)});
    }
    if (!pmp::is_polygon_soup_a_polygon_mesh(corners)) pmp::orient_polygon_soup(points, corners);
    Surface surface;
    pmp::polygon_soup_to_polygon_mesh(points, corners, surface);
    return surface;
}

Positions closed_line(const std::vector<Point>& points)
{
    Positions line(static_cast<Eigen::Index>(points.size()) - 1, 3);
    for (Eigen::Index i = 0; i < line.rows(); ++i) line.row(i) << points[i].x(), points[i].y(), points[i].z();
    return line;
}

}  // namespace

std::vector<std::array<int, 2>> self_intersections(const Positions& positions, const Triangles& triangles)
{
    std::vector<std::pair<Surface::Face_index, Surface::Face_index>> faces;
    pmp::self_intersections(surface_of(positions, triangles), std::back_inserter(faces));
    std::vector<std::array<int, 2>> pairs;
    for (const auto& [a, b] : faces)
        pairs.push_back({static_cast<int>(std::min(a, b).idx()), static_cast<int>(std::max(a, b).idx())});
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

int count_self_intersections(const Positions& positions, const Triangles& triangles)
{
    return static_cast<int>(self_intersections(positions, triangles).size());
}

bool self_intersects(const Positions& positions, const Triangles& boundary)
{
    return pmp::does_self_intersect(surface_of(positions, boundary));
}

std::vector<std::vector<Positions>> section_outlines(const Positions& positions, const Triangles& boundary,
                                                     const std::vector<CuttingPlane>& planes)
{
    const Surface surface = surface_of(positions, boundary);
    CGAL::Polygon_mesh_slicer<Surface, Kernel> cut(surface);
    std::vector<std::vector<Positions>> sections;
    for (const CuttingPlane& plane : planes) {
        if (!(plane.normal.norm() > 0.0)) throw InputError("", 0, "plane", "", "expected a normal that is not zero");
        std::vector<std::vector<Point>> lines;
        const Kernel::Vector_3 normal(plane.normal.x(), plane.normal.y(), plane.normal.z());
        cut(Kernel::Plane_3(Point(plane.point.x(), plane.point.y(), plane.point.z()), normal),
            std::back_inserter(lines));
        sections.emplace_back();
        for (const auto& line : lines)
            if (line.size() > 3 && line.front() == line.back()) sections.back().push_back(closed_line(line));
    }
    return sections;
}

std::vector<bool> points_inside(const Positions& positions, const Triangles& boundary, const std::vector<Vec3>& points)
{
    const Surface surface = surface_of(positions, boundary);
    if (surface.number_of_faces() == 0 || !CGAL::is_closed(surface))
        throw InputError("", 0, "boundary", "", "expected a closed surface");
    const CGAL::Side_of_triangle_mesh<Surface, Kernel> side_of(surface);
    std::vector<bool> inside;
    for (const Vec3& p : points) inside.push_back(side_of(Point(p(0), p(1), p(2))) != CGAL::ON_UNBOUNDED_SIDE);
    return inside;
}

}  // namespace pbs
