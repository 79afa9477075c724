#include "experiments/command_line/measure/rest_surface.hpp"

#include "experiments/command_line/measure/frame_points.hpp"
#include "experiments/meshes/meshing.hpp"
#include "experiments/rigs/surface_reader.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <numeric>
#include <set>

namespace experiments {
namespace {

using analysis::Shell;
using analysis::ShellRole;
using Edge = std::pair<int, int>;  // points, ascending

std::set<Edge> edges_in(const pbs::Triangles& triangles)
{
    std::set<Edge> edges;
    for (const auto& triangle : triangles.rowwise())
        for (int k = 0; k < 3; ++k) edges.insert(std::minmax({triangle(k), triangle((k + 1) % 3)}));
    return edges;
}

pbs::Edges edge_rows(const pbs::Triangles& triangles)
{
    const std::set<Edge> edges = edges_in(triangles);
    pbs::Edges rows(static_cast<Eigen::Index>(edges.size()), 2);
    Eigen::Index row = 0;
    for (const auto& [a, b] : edges) rows.row(row++) << a, b;
    return rows;
}

// A polygon that was cut into triangles: its points, ascending, and the number of triangles.
using Polygon = std::pair<std::vector<int>, int>;

// The triangles joined at edges that the other surface lacks, sorted.
std::vector<Polygon> polygons_in(const pbs::Triangles& triangles, const std::set<Edge>& edges_of_other)
{
    pbs::Classes classes(static_cast<std::size_t>(triangles.rows()));
    std::map<Edge, int> first_at;
    for (int f = 0; f < triangles.rows(); ++f)
        for (int k = 0; k < 3; ++k) {
            const Edge edge = std::minmax({triangles(f, k), triangles(f, (k + 1) % 3)});
            if (!edges_of_other.contains(edge)) classes.unite(f, first_at.emplace(edge, f).first->second);
        }
    std::map<int, std::pair<std::set<int>, int>> members;
    for (int f = 0; f < triangles.rows(); ++f) {
        auto& [points, count] = members[classes.find(f)];
        for (const int point : triangles.row(f)) points.insert(point);
        ++count;
    }
    std::vector<Polygon> polygons;
    for (const auto& [root, polygon] : members)
        polygons.push_back({{polygon.first.begin(), polygon.first.end()}, polygon.second});
    std::ranges::sort(polygons);
    return polygons;
}

// The same triangles, or the same polygons: of n points and n - 2 triangles, whichever diagonals a frame's reader took.
void require_same_polygons(const std::string& path, const pbs::Triangles& rest, const pbs::Triangles& frame)
{
    if (rest.rows() != frame.rows())
        throw pbs::InputError(path, 0, "triangles", std::to_string(frame.rows()),
                              fmt::format("expected the rest surface's {}", rest.rows()));
    if (rest == frame) return;
    const std::vector<Polygon> expected = polygons_in(rest, edges_in(frame)),
                               found = polygons_in(frame, edges_in(rest));
    const auto is_polygon = [](const Polygon& polygon) {
        return polygon.second == static_cast<int>(polygon.first.size()) - 2;
    };
    const auto other = std::ranges::mismatch(expected, found).in1;
    if (other == expected.end() && std::ranges::all_of(expected, is_polygon)) return;
    const std::vector<int>& points =
        (other == expected.end() ? *std::ranges::find_if_not(expected, is_polygon) : *other).first;
    throw pbs::InputError(
        path, 0, "triangles", "",
        fmt::format(
            "expected the rest surface's, on the same points; it has one on {}, and this frame does not: was the "
            "order of the vertices kept on export?",
            fmt::join(points.begin(), points.begin() + std::min<std::ptrdiff_t>(4, std::ssize(points)), " ")));
}

std::string place_text(const pbs::Positions& points, int point)
{
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", points(point, 0), points(point, 1), points(point, 2));
}

}  // namespace

RestSurface::RestSurface(std::string path, pbs::SurfaceMesh surface, analysis::Holes holes,
                         std::vector<NamedPoints> meshes)
    : path_(std::move(path)),
      surface_(std::move(surface)),
      meshes_(std::move(meshes)),
      holes_(holes),
      shells_(surface_.points, surface_.triangles, holes),
      edges_(edge_rows(shells_.triangles()))
{
    if (!shells_.counted().empty()) return;
    const auto& all = shells_.all();
    const auto largest = std::ranges::max_element(all, {}, &Shell::area_m2);
    std::string rule = "expected a surface that encloses a volume; ";
    if (largest == all.end())
        rule += "it has no triangle with an area";
    else if (largest->role == ShellRole::flat)
        rule += "its largest shell has two sides and nothing between them";
    else
        rule += fmt::format(
            "its largest shell, {}, has {} edges that do not lie between two triangles, first from {} to {}: close the "
            "holes, "
            "or measure tets (pbskin mesh wraps the surface)",
            name_of(static_cast<int>(largest - all.begin())), largest->open_edges,
            place_text(surface_.points, largest->first_open_edge.first),
            place_text(surface_.points, largest->first_open_edge.second));
    throw pbs::InputError(path_, 0, "closed shells", fmt::format("0 of {}", all.size()), rule);
}

pbs::Positions RestSurface::read_frame(const std::string& path, const std::string& displacement,
                                       std::vector<std::string>& remarks) const
{
    const pbs::SurfaceReading reading = pbs::read_surface_frame(path);
    if (reading.has_skin)
        throw pbs::InputError(
            path, 0, "skin", "",
            "expected a frame without a skin, since a mesh with one is read in its bind pose: measure the rigged model "
            "along its animation (pbskin measure MODEL), or export the posed points without a skin, as .obj");
    const pbs::SurfaceMesh& frame = reading.mesh;
    remarks = reading.remarks;
    require_as_many_points(path, frame.points.rows(), surface_.points.rows());
    require_same_polygons(path, surface_.triangles, frame.triangles);
    std::vector<int> file_point(static_cast<std::size_t>(frame.points.rows()));
    std::iota(file_point.begin(), file_point.end(), 0);
    const pbs::Positions points = shape_of_frame(path, frame.points, surface_.points, file_point, displacement);
    require_same_units(path, surface_.points, edges_, points);
    return points;
}

std::string RestSurface::mesh_of(const Shell& shell) const
{
    std::string name;
    for (const NamedPoints& mesh : meshes_)
        if (mesh.first <= shell.triangles(0, 0)) name = mesh.name;
    return name;
}

std::optional<int> RestSurface::self_intersections(const pbs::Positions& points) const
{
    pbs::Triangles triangles = shells_.triangles();
    const std::vector<int> used = pbs::renumbered(triangles, points.rows());
    try {
        return pbs::count_self_intersections(points(used, Eigen::all), triangles);
    } catch (const pbs::InputError&) {
        return std::nullopt;
    }
}

std::string RestSurface::name_of(int shell) const
{
    const std::string mesh = mesh_of(shells_.all()[shell]);
    return mesh.empty() ? std::to_string(shell + 1) : fmt::format("{} ({})", shell + 1, mesh);
}

// The first few, and the number of triangles of each.
std::string RestSurface::listed(const std::vector<int>& shells) const
{
    constexpr std::size_t most = 8;
    std::vector<std::string> names;
    for (const int s : shells) {
        if (names.size() == most) {
            names.emplace_back("...");
            break;
        }
        names.push_back(fmt::format("{} of {} triangles", name_of(s), shells_.all()[s].triangles.rows()));
    }
    return fmt::format("{}", fmt::join(names, ", "));
}

std::string RestSurface::not_whole() const
{
    const auto open = std::ranges::count(shells_.all(), ShellRole::open, &Shell::role);
    if (holes_ == analysis::Holes::leave_open || open == 0) return "";
    return fmt::format(
        "closed and capped shells are {:.0f} % of the surface's area, and {} open shell{} excluded: close the holes of "
        "the "
        "body, measure tets (pbskin mesh), or judge the closed shells alone (--closed-only)",
        100.0 * shells_.counted_share(), open, open == 1 ? " is" : "s are");
}

std::vector<std::string> RestSurface::remarks() const
{
    const auto& all = shells_.all();
    std::vector<std::string> remarks;
    const auto add = [&](const std::string& field, const std::function<bool(const Shell&)>& applies,
                         const std::string& treatment) {
        std::vector<int> shells;
        for (int s = 0; s < static_cast<int>(all.size()); ++s)
            if (applies(all[s])) shells.push_back(s);
        if (!shells.empty())
            remarks.push_back(fmt::format("{}: {} = {} of {} shells ({}): {}", path_, field, shells.size(), all.size(),
                                          listed(shells), treatment));
    };
    const auto has_role = [](ShellRole role) { return [role](const Shell& shell) { return shell.role == role; }; };
    add(
        "open shells", [](const Shell& shell) { return !shell.caps.empty(); },
        "their holes are capped (--closed-only excludes them)");
    add("open shells", has_role(ShellRole::open),
        holes_ == analysis::Holes::cap ? "excluded, for their holes are half as large as they are, or no simple loops"
                                       : "excluded");
    add("shells without thickness", has_role(ShellRole::flat), "excluded, for they enclose no volume");
    add("copies of another shell", has_role(ShellRole::copy), "excluded");
    add("cavities", has_role(ShellRole::cavity), "their volume is subtracted from that of the shell around them");
    add("closed shells inside another", has_role(ShellRole::nested),
        "their volume is added; turn their triangles round if they are cavities");
    add(
        "doubled triangles", [](const Shell& shell) { return shell.copies > 0; }, "counted once");
    add(
        "triangles turned", [](const Shell& shell) { return shell.role != ShellRole::open && shell.turned > 0; },
        "the surface was inside out, or not all of its triangles faced to one side");
    if (const double gap_m = shells_.largest_gap_m(surface_.points); gap_m > 0.0)
        remarks.push_back(
            fmt::format("{}: gap between points of a seam = {:.3g} m: joined, as if it were a rounding", path_, gap_m));
    constexpr double most_of_it = 0.5;
    if (shells_.counted_share() < most_of_it)
        remarks.push_back(
            fmt::format("{}: closed shells = {:.0f} % of the surface's area: what is measured is a small part of it; "
                        "close the holes "
                        "of the others, or measure tets (pbskin mesh)",
                        path_, 100.0 * shells_.counted_share()));
    return remarks;
}

}  // namespace experiments
