#include "pbs/geometry/mesh_remarks.hpp"

#include "pbs/geometry/meshing.hpp"
#include "pbs/geometry/number_text.hpp"
#include "pbs/geometry/tet_volume.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <utility>

namespace pbs {
namespace {

constexpr double smallest_m = 1e-3, largest_m = 100.0;  // of a character

template <typename Value>
std::string remark(const std::string& path, const std::string& field, const Value& value, const std::string& treatment)
{
    std::ostringstream text;
    text << path << ": " << field << " = " << value << ": " << treatment;
    return text.str();
}

// The first few by number.
void add_vertices(const std::string& path, const std::string& field, const std::vector<int>& vertices, const std::string& treatment,
                  std::vector<std::string>& remarks)
{
    if (vertices.empty()) return;
    constexpr std::size_t most = 20;
    std::string list;
    for (std::size_t v = 0; v < vertices.size() && v < most; ++v) list += (v ? ", " : "") + std::to_string(vertices[v]);
    if (vertices.size() > most) list += ", ...";
    remarks.push_back(remark(path, field, std::to_string(vertices.size()) + " (" + list + ")", treatment));
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
    std::map<std::pair<int, int>, int> triangles_at;
    for (const auto& triangle : surface.triangles.rowwise())
        for (int k = 0; k < 3; ++k) ++triangles_at[std::minmax({triangle(k), triangle((k + 1) % 3)})];
    if (const auto holes = std::count_if(triangles_at.begin(), triangles_at.end(), [](const auto& edge) { return edge.second == 1; }))
        remarks.push_back(remark(path, "edges of one triangle", holes, "its holes are wrapped over"));
    const auto is_joint = [](const auto& edge) { return edge.second > 2; };
    const auto first = std::find_if(triangles_at.begin(), triangles_at.end(), is_joint);
    if (first == triangles_at.end()) return;
    remarks.push_back(remark(path, "edges of three or more triangles", std::count_if(triangles_at.begin(), triangles_at.end(), is_joint),
                             "not manifold there, first from " + place_text(surface.points.row(first->first.first)) + " to " +
                                 place_text(surface.points.row(first->first.second)) + "; the surface is wrapped"));
}

// Skins of characters do so: MakeHuman's at lips and lids. Without CGAL this is not checked, and never for tet meshes.
void add_crossings([[maybe_unused]] const std::string& path, [[maybe_unused]] const SurfaceMesh& surface,
                   [[maybe_unused]] std::vector<std::string>& remarks)
{
#ifdef PBS_WITH_CGAL
    const std::vector<std::array<int, 2>> crossings = self_intersections(surface.points, surface.triangles);
    if (crossings.empty()) return;
    Vec3 middle = Vec3::Zero();  // of the first one's first triangle
    for (const int point : surface.triangles.row(crossings.front()[0])) middle += surface.points.row(point).transpose() / 3.0;
    remarks.push_back(remark(path, "pairs of triangles that meet", crossings.size(),
                             "it intersects or touches itself, first at " + place_text(middle) + "; what is outside is kept"));
#endif
}

// Volume of the body enclosed by outward triangles [m^3]; negative where they face inward.
double signed_volume(const SurfaceMesh& surface)
{
    const Vec3 middle = surface.points.colwise().mean().transpose();
    double volume = 0.0;
    for (const auto& triangle : surface.triangles.rowwise())
        volume += tet_volume(middle, surface.points.row(triangle(0)), surface.points.row(triangle(1)), surface.points.row(triangle(2)));
    return volume;
}

}  // namespace

std::string remark_on_name(const std::string& path, const std::string& content_extension)
{
    return remark(path, "format of the content", content_extension, "read as such, whatever the file is called");
}

std::vector<std::string> remarks_on(const std::string& path, const MeshReading& reading)
{
    std::vector<std::string> remarks;
    if (!reading.read_as.empty()) remarks.push_back(remark_on_name(path, reading.read_as));
    if (reading.flipped_tets > 0)
        remarks.push_back(remark(path, "inverted tets", reading.flipped_tets, "turned, so that every rest volume is positive"));
    add_vertices(path, "unused vertices", reading.unused_vertices, "left out; no tet uses them", remarks);
    add_vertices(path, "vertices at which parts touch", reading.split_vertices, "split, so that each part has its own", remarks);
    const int parts = topology_of(reading.mesh.tets, reading.mesh.rest.rows()).components;
    if (parts > 1) remarks.push_back(remark(path, "parts", parts, "kept; no face joins them"));
    add_size(path, reading.mesh.rest, remarks);
    return remarks;
}

std::vector<std::string> remarks_on(const std::string& path, const SurfaceMesh& surface, int unused_points, int triangles_without_area)
{
    std::vector<std::string> remarks;
    if (unused_points > 0) remarks.push_back(remark(path, "unused points", unused_points, "left out; no triangle uses them"));
    if (triangles_without_area > 0) remarks.push_back(remark(path, "triangles without area", triangles_without_area, "left out"));
    add_open_and_joined_edges(path, surface, remarks);
    add_crossings(path, surface, remarks);
    if (const double volume = signed_volume(surface); volume < 0.0)
        remarks.push_back(remark(path, "enclosed volume [m^3]", volume, "inside out; taken as the body that it encloses"));
    add_size(path, surface.points, remarks);
    return remarks;
}

}  // namespace pbs
