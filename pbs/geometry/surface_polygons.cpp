// .ply, .off and .stl by CGAL, in double precision; assimp's readers accept truncated files of these, hang or end the process.
#include "pbs/geometry/mesh_io_formats.hpp"

#include "pbs/geometry/content_format.hpp"
#include "pbs/geometry/input_error.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Surface_mesh.h>

#include <fstream>
#include <vector>

namespace pbs {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Polygon = std::vector<std::size_t>;

// CGAL splits faces of a mesh: a mesh of this one polygon, its vertices numbered by corner. False if CGAL cannot split the polygon.
bool add_triangles(const std::vector<Point>& points, const Polygon& polygon, std::vector<int>& triangles)
{
    if (polygon.size() == 3) {
        triangles.insert(triangles.end(), polygon.begin(), polygon.end());
        return true;
    }
    CGAL::Surface_mesh<Point> mesh;
    std::vector<CGAL::Surface_mesh<Point>::Vertex_index> corners;
    for (const std::size_t vertex : polygon) corners.push_back(mesh.add_vertex(points[vertex]));
    mesh.add_face(corners);
    // CGAL 6 triangulates a polygon without area; CGAL 5 refuses it.
    if (!CGAL::Polygon_mesh_processing::triangulate_faces(mesh) || !(CGAL::Polygon_mesh_processing::area(mesh) > 0.0)) return false;
    for (const auto face : mesh.faces())
        for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
            triangles.push_back(static_cast<int>(polygon[vertex.idx()]));
    return true;
}

// The corners of all triangles.
std::vector<int> triangulated(const std::string& path, const std::vector<Point>& points, const std::vector<Polygon>& polygons)
{
    std::vector<int> triangles;
    if (!polygons.empty()) require_points(path, static_cast<long long>(points.size()));
    for (std::size_t f = 0; f < polygons.size(); ++f) {
        for (const std::size_t vertex : polygons[f])
            if (vertex >= points.size())
                throw InputError(path, 0, "face " + std::to_string(f) + " vertex", std::to_string(static_cast<long long>(vertex)),
                                 expected_whole("an index", 0, static_cast<long long>(points.size()) - 1));
        if (polygons[f].size() >= 3 && !add_triangles(points, polygons[f], triangles))
            throw InputError(path, 0, "face " + std::to_string(f), "", "expected an area, and no two edges that cross");
    }
    return triangles;
}

bool read_soup(const std::string& path, std::vector<Point>& points, std::vector<Polygon>& polygons)
{
    std::ifstream file(path, std::ios::binary);
    const std::string extension = format_extension(path);
    if (extension == ".ply") return CGAL::IO::read_PLY(file, points, polygons);
    if (extension == ".stl") return CGAL::IO::read_STL(file, points, polygons);
    return CGAL::IO::read_OFF(file, points, polygons);
}

}  // namespace

SurfaceMesh read_polygons(const std::string& path)
{
    std::vector<Point> points;
    std::vector<Polygon> polygons;
    const bool whole = read_soup(path, points, polygons);
    if (!whole)
        throw InputError(path, 0, "", "",
                         "damaged: CGAL read " + std::to_string(points.size()) + " points and " + std::to_string(polygons.size()) +
                             " faces, and no further");
    const std::vector<int> triangles = triangulated(path, points, polygons);
    SurfaceMesh mesh;
    mesh.points.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i)
        mesh.points.row(static_cast<Eigen::Index>(i)) << points[i].x(), points[i].y(), points[i].z();
    mesh.triangles = Eigen::Map<const Triangles>(triangles.data(), static_cast<Eigen::Index>(triangles.size() / 3), 3);
    return mesh;
}

}  // namespace pbs
