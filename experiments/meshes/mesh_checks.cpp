// Checks that every format needs (paths, sizes and index ranges), the conditions on a mesh, repairs, and remarks.
#include "experiments/meshes/mesh_io_formats.hpp"

#include "experiments/meshes/meshing.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/geometry/winding_number.hpp"
#include "pbs/system/source_file.hpp"

#include <Eigen/Geometry>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

namespace pbs {

namespace fs = std::filesystem;

void require_readable(const std::string& path, std::uintmax_t most_bytes)
{
    std::error_code code;
    if (!fs::exists(path, code)) throw InputError(path, 0, "", "", "no such file");
    if (!fs::is_regular_file(path, code)) throw InputError(path, 0, "", "", "expected a file");
    if (::euidaccess(path.c_str(), R_OK) != 0) throw InputError(path, 0, "", "", "cannot be read");
    if (SourceFile(path).text(most_bytes).empty()) throw InputError(path, 0, "", "", "the file is empty");
}

void require_points(const std::string& path, long long points)
{
    if (points == 0) throw InputError(path, 0, "points", "0", "expected at least one point");
}

void require_extent(const std::string& path, const Positions& points)
{
    constexpr double least_extent_m = 1e-9;
    const double extent = (points.colwise().maxCoeff() - points.colwise().minCoeff()).stableNorm();
    if (!(extent >= least_extent_m))
        throw InputError(path, 0, "extent", number_text(extent), "expected at least 1e-9 m");
}

int checked_index(const std::string& path, long long tet, long long index, long long points)
{
    require_points(path, points);
    if (index < 0 || index >= points)
        throw InputError(path, 0, "tet " + std::to_string(tet) + " vertex", std::to_string(index),
                         expected_whole("an index", 0, points - 1));
    return static_cast<int>(index);
}

namespace {

// |V| / (longest edge)^3 is 0.118 for the regular tet. Rounding of the coordinates alone leaves some 1e-16 D / l of it,
// D the distance from the origin: 1e-10 keeps clear of that for every mesh with D / l < 1e5.
constexpr double flat_tet = 1e-10;
// Height over length is 1e-4 and less: gradients of barycentric coordinates, which are its inverse, leave a float 3
// digits of 7, and the condition number of an energy's Hessian grows with their square.
constexpr double sliver = 1e-5;
constexpr double smallest_m = 1e-3, largest_m = 100.0;  // of a character

std::string numbered(const char* what, Eigen::Index i)
{
    return what + std::string(" ") + std::to_string(i);
}

// "(0, 0.5, 1)"
template <typename Row>
std::string listed(const Row& row, int digits = 17)
{
    std::ostringstream text;
    text.precision(digits);
    text << '(';
    for (Eigen::Index i = 0; i < row.size(); ++i) text << (i ? ", " : "") << row(i);
    return text.str() + ')';
}

double longest_edge(const TetMesh& mesh, Eigen::Index t)
{
    double longest = 0.0;
    for (int a = 0; a < 4; ++a)
        for (int b = a + 1; b < 4; ++b)
            longest = std::max(longest, (mesh.rest.row(mesh.tets(t, a)) - mesh.rest.row(mesh.tets(t, b))).norm());
    return longest;
}

// flattest: the tet with the least |V| / (longest edge)^3, and this number.
int normalise_orientation(const std::string& path, TetMesh& mesh, std::pair<Eigen::Index, double>& flattest)
{
    int flipped = 0;
    flattest.second = std::numeric_limits<double>::infinity();
    const Eigen::VectorXd volumes = tet_volumes(mesh.rest, mesh.tets);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const double length = longest_edge(mesh, t), flatness = std::abs(volumes(t)) / (length * length * length);
        if (flatness < flattest.second) flattest = {t, flatness};
        if (!(std::abs(volumes(t)) > flat_tet * length * length * length))
            throw InputError(path, 0, numbered("tet", t), listed(mesh.tets.row(t)),
                             "expected a volume; its four vertices are in one plane");
        if (volumes(t) > 0.0) continue;
        std::swap(mesh.tets(t, 2), mesh.tets(t, 3));
        ++flipped;
    }
    return flipped;
}

// Vertices of the file in one place, each with the one before it there; an unused one may be anywhere.
std::vector<std::array<int, 2>> doubled_vertices(const MeshReading& reading)
{
    const Positions& points = reading.mesh.rest;
    std::vector<Eigen::Index> order(static_cast<std::size_t>(points.rows()));
    std::iota(order.begin(), order.end(), Eigen::Index(0));
    const auto key = [&](Eigen::Index i) { return std::array{points(i, 0), points(i, 1), points(i, 2)}; };
    std::sort(order.begin(), order.end(),
              [&](Eigen::Index a, Eigen::Index b) { return std::pair(key(a), a) < std::pair(key(b), b); });
    std::vector<std::array<int, 2>> doubled;
    for (std::size_t i = 1; i < order.size(); ++i) {
        const int vertex = reading.file_vertex[static_cast<std::size_t>(order[i])];
        const int before = reading.file_vertex[static_cast<std::size_t>(order[i - 1])];
        if (vertex != before && key(order[i - 1]) == key(order[i])) doubled.push_back({before, vertex});
    }
    return doubled;
}

void check_places(const std::string& path, const Positions& points)
{
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        if (!points.row(i).allFinite())
            throw InputError(path, 0, numbered("vertex", i), listed(points.row(i)), "expected finite coordinates [m]");
        if (!(points.row(i).cwiseAbs().maxCoeff() <= farthest_m))
            throw InputError(path, 0, numbered("vertex", i), listed(points.row(i)),
                             "expected within 1e9 m of the origin");
    }
}

// Two tets that share a face lie on either side of it; both positively oriented, they list it in opposite order.
void check_faces(const std::string& path, const TetMesh& mesh)
{
    const std::vector<TetFace> faces = sorted_faces(mesh.tets);
    for (std::size_t i = 1; i < faces.size(); ++i) {
        const TetFace &face = faces[i], &before = faces[i - 1];
        if (face.sorted != before.sorted) continue;
        if (face.even == before.even)
            throw InputError(path, 0, numbered("tet", face.tet), listed(mesh.tets.row(face.tet)),
                             "expected to lie beside " + numbered("tet", before.tet) +
                                 ", with which it shares a face; they overlap");
        if (i >= 2 && face.sorted == faces[i - 2].sorted)
            throw InputError(path, 0, numbered("tet", face.tet), listed(mesh.tets.row(face.tet)),
                             "expected faces of at most two tets; one face is in three");
    }
}

// The first triangle of the boundary that meets another one; nothing: there is none. Where tets were separated and
// where vertices of the file are in one place, triangles share a place but not all vertices.
std::optional<int> overlapping_triangle([[maybe_unused]] const MeshReading& reading,
                                        [[maybe_unused]] const Triangles& boundary)
{
#ifdef PBS_WITH_CGAL
    std::vector<int> place(static_cast<std::size_t>(reading.file_vertices));
    std::iota(place.begin(), place.end(), 0);
    for (const auto& [before, vertex] : reading.doubled_vertices) place[vertex] = place[before];
    const auto place_of = [&](int vertex) { return place[reading.file_vertex[vertex]]; };
    for (const auto& [a, b] : self_intersections(reading.mesh.rest, boundary)) {
        bool share_a_place = false;
        for (const int of_a : boundary.row(a))
            for (const int of_b : boundary.row(b))
                share_a_place = share_a_place || (of_a != of_b && place_of(of_a) == place_of(of_b));
        if (!share_a_place) return a;
    }
#endif
    return std::nullopt;
}

// The number of triangles at each edge.
std::map<std::pair<int, int>, int> triangles_at_edges(const Triangles& triangles)
{
    std::map<std::pair<int, int>, int> triangles_at;
    for (const auto& triangle : triangles.rowwise())
        for (int k = 0; k < 3; ++k) ++triangles_at[std::minmax({triangle(k), triangle((k + 1) % 3)})];
    return triangles_at;
}

template <typename Value>
std::string remark(const std::string& path, const std::string& field, const Value& value, const std::string& treatment)
{
    std::ostringstream text;
    text << path << ": " << field << " = " << value << ": " << treatment;
    return text.str();
}

std::string shown(int vertex)
{
    return std::to_string(vertex);
}
std::string shown(const std::array<int, 2>& edge)
{
    return shown(edge[0]) + "-" + shown(edge[1]);
}

// The first few vertices or edges by number.
template <typename Item>
void add_list(const std::string& path, const std::string& field, const std::vector<Item>& items,
              const std::string& treatment, std::vector<std::string>& remarks)
{
    if (items.empty()) return;
    constexpr std::size_t most = 20;
    std::string list;
    for (std::size_t i = 0; i < items.size() && i < most; ++i) list += (i ? ", " : "") + shown(items[i]);
    if (items.size() > most) list += ", ...";
    remarks.push_back(remark(path, field, std::to_string(items.size()) + " (" + list + ")", treatment));
}

void add_size(const std::string& path, const Positions& points, std::vector<std::string>& remarks)
{
    const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
    if (!(size >= smallest_m && size <= largest_m))
        remarks.push_back(remark(path, "extent [m]", size, "taken as it is; are the coordinates in metres?"));
}

// Edges that are not in two triangles: what the mesher wraps.
void add_open_and_joined_edges(const std::string& path, const SurfaceMesh& surface, std::vector<std::string>& remarks)
{
    const auto triangles_at = triangles_at_edges(surface.triangles);
    if (const auto holes =
            std::count_if(triangles_at.begin(), triangles_at.end(), [](const auto& edge) { return edge.second == 1; }))
        remarks.push_back(remark(path, "edges of one triangle", holes, "its holes are wrapped over"));
    const auto is_joint = [](const auto& edge) { return edge.second > 2; };
    const auto first = std::find_if(triangles_at.begin(), triangles_at.end(), is_joint);
    if (first == triangles_at.end()) return;
    remarks.push_back(remark(
        path, "edges of three or more triangles", std::count_if(triangles_at.begin(), triangles_at.end(), is_joint),
        "not manifold there, first from " + listed(surface.points.row(first->first.first), 6) + " to " +
            listed(surface.points.row(first->first.second), 6) + "; the surface is wrapped"));
}

// The parts of a surface that no point joins and that are closed.
std::vector<Triangles> closed_shells(const SurfaceMesh& surface)
{
    Classes parts(static_cast<std::size_t>(surface.points.rows()));
    for (const auto& triangle : surface.triangles.rowwise())
        for (int k = 1; k < 3; ++k) parts.unite(triangle(k), triangle(0));
    std::map<int, std::vector<Eigen::Index>> rows;
    for (Eigen::Index f = 0; f < surface.triangles.rows(); ++f) rows[parts.find(surface.triangles(f, 0))].push_back(f);
    std::vector<Triangles> shells;
    for (const auto& [part, members] : rows) {
        const Triangles shell = surface.triangles(members, Eigen::all);
        const auto triangles_at = triangles_at_edges(shell);
        if (std::ranges::all_of(triangles_at, [](const auto& edge) { return edge.second == 2; }))
            shells.push_back(shell);
    }
    return shells;
}

// A shell inside another one that faces the other way is the skin of a cavity.
void add_cavities(const std::string& path, const SurfaceMesh& surface, std::vector<std::string>& remarks)
{
    const std::vector<Triangles> shells = closed_shells(surface);
    int cavities = 0;
    double volume = 0.0;
    for (const Triangles& inner : shells) {
        const double of_inner = fan_volume(surface.points, inner);
        const Vec3 point = surface.points.row(inner(0, 0));
        const bool is_cavity = std::ranges::any_of(shells, [&](const Triangles& outer) {
            return of_inner * fan_volume(surface.points, outer) < 0.0 &&
                   std::abs(winding_number(surface.points, outer, point)) > 0.5;
        });
        if (!is_cavity) continue;
        ++cavities;
        volume += std::abs(of_inner);
    }
    if (cavities > 0)
        remarks.push_back(remark(
            path, "closed cavities", cavities,
            number_text(volume) + " m^3 in all, filled by tets: the mesher wraps the outside alone; for a hollow body, "
                                  "mesh it with another program and use its tets"));
}

// Skins of characters do so: MakeHuman's at lips and lids. Without CGAL this is not checked, and never for tet meshes.
void add_crossings([[maybe_unused]] const std::string& path, [[maybe_unused]] const SurfaceMesh& surface,
                   [[maybe_unused]] std::vector<std::string>& remarks)
{
#ifdef PBS_WITH_CGAL
    const std::vector<std::array<int, 2>> crossings = self_intersections(surface.points, surface.triangles);
    if (crossings.empty()) return;
    Vec3 middle = Vec3::Zero();  // of the first one's first triangle
    for (const int point : surface.triangles.row(crossings.front()[0]))
        middle += surface.points.row(point).transpose() / 3.0;
    remarks.push_back(
        remark(path, "pairs of triangles that meet", crossings.size(),
               "it intersects or touches itself, first at " + listed(middle, 6) + "; what is outside is kept"));
#endif
}

}  // namespace

void check_frame(const std::string& path, const TetMesh& mesh)
{
    if (mesh.tets.rows() == 0) throw InputError(path, 0, "tets", "0", "expected at least one tetrahedron");
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner) checked_index(path, t, mesh.tets(t, corner), mesh.rest.rows());
    check_places(path, mesh.rest);
}

MeshReading check_rest(const std::string& path, TetMesh mesh, bool for_computing)
{
    check_frame(path, mesh);
    require_extent(path, mesh.rest);
    std::pair<Eigen::Index, double> flattest;
    const int flipped_tets = normalise_orientation(path, mesh, flattest);
    check_faces(path, mesh);
    MeshReading reading = repaired(mesh);
    reading.doubled_vertices = doubled_vertices(reading);
    if (for_computing && !reading.doubled_vertices.empty()) {
        const auto [before, vertex] = reading.doubled_vertices.front();
        throw InputError(
            path, 0, numbered("vertex", vertex), listed(mesh.rest.row(vertex)),
            "expected a point of its own; " + numbered("vertex", before) + " is there already: merge the two");
    }
    const Triangles boundary = boundary_of(reading.mesh.tets);
    if (const auto triangle = overlapping_triangle(reading, boundary))
        reading.overlapping = reading.file_vertex[boundary(*triangle, 0)];
    if (for_computing && reading.overlapping >= 0)
        throw InputError(path, 0, "boundary", "vertex " + std::to_string(reading.overlapping),
                         "expected a surface that does not intersect itself; it does near this vertex: mesh the body "
                         "anew (pbskin mesh)");
    if (!for_computing) {
        MeshReading kept = repaired(mesh, false);
        kept.doubled_vertices = std::move(reading.doubled_vertices);
        kept.overlapping = reading.overlapping;
        reading = std::move(kept);
    }
    reading.flipped_tets = flipped_tets;
    reading.flattest_tet = static_cast<int>(flattest.first);
    reading.flatness = flattest.second;
    reading.touching_edges = touching_edges(mesh.tets);
    return reading;
}

std::vector<std::array<int, 2>> touching_edges(const Tets& tets)
{
    std::vector<std::array<int, 2>> edges;
    for (const auto& [edge, count] : triangles_at_edges(boundary_of(tets)))
        if (count > 2) edges.push_back({edge.first, edge.second});
    return edges;
}

std::string remark_on_name(const std::string& path, const std::string& content_extension)
{
    return remark(path, "format of the content", content_extension, "read as such, whatever the file is called");
}

std::vector<std::string> remarks_on(const std::string& path, const MeshReading& reading)
{
    std::vector<std::string> remarks;
    if (!reading.read_as.empty()) remarks.push_back(remark_on_name(path, reading.read_as));
    if (!reading.listed_at.empty())
        remarks.push_back(remark(
            path, "nodes", reading.file_vertices,
            "not listed by their tags; vertices are numbered from 0 by ascending tag, as weights and frames must be"));
    if (reading.repeated_tets > 0)
        remarks.push_back(remark(path, "tets listed more than once", reading.repeated_tets, "counted once"));
    if (reading.flipped_tets > 0)
        remarks.push_back(
            remark(path, "inverted tets", reading.flipped_tets, "turned, so that every rest volume is positive"));
    if (reading.flatness < sliver)
        remarks.push_back(remark(
            path, numbered("flattest tet", reading.flattest_tet), number_text(reading.flatness, 2),
            "a sliver by its volume over its longest edge cubed, which is 0.118 for a regular tet; the methods that "
            "minimise an energy may end far from its minimum, and FEM may reach no pose: mesh the body anew "
            "(pbskin mesh)"));
    add_list(path, "unused vertices", reading.unused_vertices, "left out; no tet uses them", remarks);
    const bool is_split = !reading.split_vertices.empty();
    add_list(path, "edges at which parts touch", reading.touching_edges,
             is_split ? "split, so that each side has its own" : "kept: no metric needs a manifold boundary", remarks);
    add_list(path, "vertices at which parts touch", reading.split_vertices, "split, so that each part has its own",
             remarks);
    if (reading.cut_faces > 0)
        remarks.push_back(remark(path, "faces that were cut", reading.cut_faces, "they joined parts that touch"));
    add_list(path, "vertices in one place", reading.doubled_vertices,
             "kept, as at a crack or where bodies touch: no metric needs them joined", remarks);
    if (reading.overlapping >= 0)
        remarks.push_back(remark(path, "boundary that intersects itself, near vertex", reading.overlapping,
                                 "kept: the volume where bodies overlap counts for each of them"));
    const int parts = topology_of(reading.mesh.tets, reading.mesh.rest.rows()).components;
    if (parts > 1) remarks.push_back(remark(path, "parts", parts, "kept; no face joins them"));
    add_size(path, reading.mesh.rest, remarks);
    return remarks;
}

std::vector<std::string> remarks_on(const std::string& path, const SurfaceMesh& surface, int unused_points,
                                    int triangles_without_area)
{
    std::vector<std::string> remarks;
    if (unused_points > 0)
        remarks.push_back(remark(path, "unused points", unused_points, "left out; no triangle uses them"));
    if (triangles_without_area > 0)
        remarks.push_back(remark(path, "triangles without area", triangles_without_area, "left out"));
    add_open_and_joined_edges(path, surface, remarks);
    add_crossings(path, surface, remarks);
    add_cavities(path, surface, remarks);
    if (const double volume = fan_volume(surface.points, surface.triangles); volume < 0.0)
        remarks.push_back(
            remark(path, "enclosed volume [m^3]", volume, "inside out; taken as the body that it encloses"));
    add_size(path, surface.points, remarks);
    return remarks;
}

}  // namespace pbs
