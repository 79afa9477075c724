#include "pbs/geometry/mesh_remarks.hpp"

#include "pbs/geometry/topology.hpp"

#include <sstream>

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

void add_size(const std::string& path, const Positions& points, std::vector<std::string>& remarks)
{
    const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
    if (!(size >= smallest_m && size <= largest_m))
        remarks.push_back(remark(path, "extent [m]", size, "taken as it is; are the coordinates in metres?"));
}

}  // namespace

std::vector<std::string> remarks_on(const std::string& path, const MeshReading& reading)
{
    std::vector<std::string> remarks;
    if (reading.flipped_tets > 0)
        remarks.push_back(remark(path, "inverted tets", reading.flipped_tets, "turned, so that every rest volume is positive"));
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
    add_size(path, surface.points, remarks);
    return remarks;
}

}  // namespace pbs
