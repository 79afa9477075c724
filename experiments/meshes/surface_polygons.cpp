// .ply, .off and .stl by CGAL, in double precision, and the triangles of polygons. assimp's readers accept truncated
// files of these, hang or end the process.
#include "experiments/meshes/mesh_io_formats.hpp"

#include "experiments/meshes/content_format.hpp"
#include "experiments/meshes/text_words.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/system/files.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

namespace pbs {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Polygon = std::vector<std::size_t>;

// CGAL splits faces of a mesh: a mesh of this one polygon, its vertices numbered by corner. False if CGAL cannot split
// the polygon.
bool add_triangles(const Positions& points, const Polygon& polygon, std::vector<int>& triangles)
{
    if (polygon.size() == 3) {
        triangles.insert(triangles.end(), polygon.begin(), polygon.end());
        return true;
    }
    CGAL::Surface_mesh<Point> mesh;
    std::vector<CGAL::Surface_mesh<Point>::Vertex_index> corners;
    for (const std::size_t vertex : polygon) {
        const auto p = points.row(static_cast<Eigen::Index>(vertex));
        corners.push_back(mesh.add_vertex(Point(p(0), p(1), p(2))));
    }
    mesh.add_face(corners);
    // CGAL 6 triangulates a polygon without area; CGAL 5 refuses it.
    if (!CGAL::Polygon_mesh_processing::triangulate_faces(mesh) || !(CGAL::Polygon_mesh_processing::area(mesh) > 0.0))
        return false;
    for (const auto face : mesh.faces())
        for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
            triangles.push_back(static_cast<int>(polygon[vertex.idx()]));
    return true;
}

// CGAL knows face indices of four bytes alone. A text names their type once, in its header.
std::string with_known_index_type(const std::string& path, std::string text)
{
    std::size_t end = text.find("end_header");
    for (const std::string list : {"vertex_indices", "vertex_index"}) {
        const std::size_t name = text.find(' ' + list);
        if (name >= end || end == std::string::npos) continue;
        const std::size_t type = text.rfind(' ', name - 1) + 1;
        const std::string word = text.substr(type, name - type);
        if (word == "int" || word == "uint" || word == "int32" || word == "uint32") continue;
        const std::size_t format = text.find("format ascii");
        if (format >= end)
            throw InputError(path, line_at(text, type), "type of " + list, word,
                             "expected int or uint in a binary file: export it with these, or as text");
        text.replace(type, word.size(), "int");
        end = text.find("end_header");
    }
    return text;
}

// Some programs leave out the number of edges, which CGAL expects behind those of points and faces.
std::string with_number_of_edges(std::string text)
{
    for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end + 1) {
        end = std::min(text.find('\n', begin), text.size());
        const std::string line = text.substr(begin, std::min(text.find('#', begin), end) - begin);
        std::istringstream words(line);
        int numbers = 0;
        for (std::string word; words >> word;) numbers += number_in(word).has_value();
        if (numbers == 2) text.insert(begin + line.find_last_not_of(" \t\r") + 1, " 0");
        if (numbers > 0) break;
    }
    return text;
}

bool read_soup(const std::string& path, std::vector<Point>& points, std::vector<Polygon>& polygons)
{
    const std::string extension = format_extension(path), bytes = read_text_file(path, most_mesh_bytes);
    if (extension == ".ply") {
        const std::string text = with_known_index_type(path, as_utf8(bytes));
        if (text.find("format ascii") < text.find("end_header")) check_polygon_text(path, text, extension);
        std::istringstream file(text);
        return CGAL::IO::read_PLY(file, points, polygons);
    }
    if (extension == ".stl") {
        const bool is_text = bytes.find('\0') == std::string::npos || as_utf8(bytes) != bytes;
        std::string text = is_text ? in_lower_case(as_utf8(bytes)) : bytes;
        if (is_text) {
            // CGAL expects lower case and a blank behind `solid`; names of solids are not used
            std::ranges::replace(text, '\t', ' ');
            check_polygon_text(path, text, extension);
        }
        std::istringstream file(text);
        return CGAL::IO::read_STL(file, points, polygons);
    }
    const std::string text = with_number_of_edges(as_utf8(bytes));
    check_polygon_text(path, text, extension);
    std::istringstream file(text);
    return CGAL::IO::read_OFF(file, points, polygons);
}

}  // namespace

std::vector<int> triangulated(const std::string& path, const Positions& points, const std::vector<Polygon>& polygons)
{
    std::vector<int> triangles;
    if (!polygons.empty()) require_points(path, points.rows());
    for (std::size_t f = 0; f < polygons.size(); ++f) {
        for (const std::size_t vertex : polygons[f])
            if (vertex >= static_cast<std::size_t>(points.rows()))
                throw InputError(path, 0, "face " + std::to_string(f) + " vertex",
                                 std::to_string(static_cast<long long>(vertex)),
                                 expected_whole("an index", 0, points.rows() - 1));
        if (polygons[f].size() >= 3 && !add_triangles(points, polygons[f], triangles))
            throw InputError(path, 0, "face " + std::to_string(f), "", "expected an area, and no two edges that cross");
    }
    return triangles;
}

SurfaceMesh read_polygons(const std::string& path)
{
    std::vector<Point> points;
    std::vector<Polygon> polygons;
    const bool whole = read_soup(path, points, polygons);
    if (!whole)
        throw InputError(path, 0, "", "",
                         "damaged: CGAL read " + std::to_string(points.size()) + " points and " +
                             std::to_string(polygons.size()) + " faces, and no further");
    SurfaceMesh mesh;
    mesh.points.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i)
        mesh.points.row(static_cast<Eigen::Index>(i)) << points[i].x(), points[i].y(), points[i].z();
    const std::vector<int> triangles = triangulated(path, mesh.points, polygons);
    mesh.triangles = Eigen::Map<const Triangles>(triangles.data(), static_cast<Eigen::Index>(triangles.size() / 3), 3);
    return mesh;
}

}  // namespace pbs
