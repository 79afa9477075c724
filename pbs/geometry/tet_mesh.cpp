#include "pbs/geometry/tet_mesh.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <ranges>
#include <utility>

namespace pbs {
namespace {

// Refinement divides a tet into eight by these nodes.
using Nodes = std::array<int, 10>;  // of a tet: its corners, then the midpoints of 01, 02, 03, 12, 13, 23
constexpr std::array<std::array<int, 2>, 6> edge_corners = {{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

// The children in nodes of their parent, positively oriented.
using Children = std::array<std::array<int, 4>, 4>;
constexpr Children at_corners = {{{0, 4, 5, 6}, {4, 1, 7, 8}, {5, 7, 2, 9}, {6, 8, 9, 3}}};

// The octahedron's diagonals, and its four tets round each of them.
struct Diagonal {
    int from, to;
    Children tets;
};
constexpr std::array<Diagonal, 3> diagonals = {{{4, 9, {{{4, 9, 7, 5}, {4, 9, 8, 7}, {4, 9, 6, 8}, {4, 9, 5, 6}}}},
                                                {5, 8, {{{5, 8, 4, 7}, {5, 8, 7, 9}, {5, 8, 9, 6}, {5, 8, 6, 4}}}},
                                                {6, 7, {{{6, 7, 8, 4}, {6, 7, 9, 8}, {6, 7, 5, 9}, {6, 7, 4, 5}}}}}};

// Row of `edges`, which are sorted.
int index_of_edge(const Edges& edges, int a, int b)
{
    const std::pair<int, int> wanted = std::minmax(a, b);
    const auto vertices = [&](Eigen::Index e) { return std::pair(edges(e, 0), edges(e, 1)); };
    return static_cast<int>(
        *std::ranges::lower_bound(std::views::iota(Eigen::Index(0), edges.rows()), wanted, {}, vertices));
}

Nodes nodes_of(const TetMesh& mesh, const Edges& edges, Eigen::Index tet)
{
    Nodes nodes;
    for (int corner = 0; corner < 4; ++corner) nodes[corner] = mesh.tets(tet, corner);
    for (std::size_t e = 0; e < edge_corners.size(); ++e)
        nodes[4 + e] = static_cast<int>(mesh.rest.rows()) +
                       index_of_edge(edges, nodes[edge_corners[e][0]], nodes[edge_corners[e][1]]);
    return nodes;
}

const Diagonal& shortest_diagonal(const Positions& rest, const Nodes& nodes)
{
    const auto squared_length = [&](const Diagonal& diagonal) {
        return (rest.row(nodes[diagonal.from]) - rest.row(nodes[diagonal.to])).squaredNorm();
    };
    return *std::ranges::min_element(diagonals, {}, squared_length);
}

// A point this close to a face counts as on it.
constexpr double on_face = 1e-10;  // of a barycentric coordinate: some 1e5 roundings of a well-shaped tet

Vec3 barycentric_in(const TetMesh& mesh, Eigen::Index tet, const Vec3& point)
{
    const auto corner = [&](int c) -> Vec3 { return mesh.rest.row(mesh.tets(tet, c)); };
    Eigen::Matrix3d edges;
    edges << corner(1) - corner(0), corner(2) - corner(0), corner(3) - corner(0);
    return edges.inverse() * (point - corner(0));
}

constexpr int none = -1;                             // no neighbour, no region
using Neighbours = std::vector<std::array<int, 4>>;  // over the faces of each tet, opposite to its vertices; or none

// A face in more than two tets joins the first two.
Neighbours neighbours_over_faces(const Tets& tets)
{
    Neighbours neighbours(tets.rows(), {none, none, none, none});
    const std::vector<TetFace> faces = sorted_faces(tets);
    for (std::size_t f = 1; f < faces.size(); ++f) {
        const TetFace &a = faces[f - 1], &b = faces[f];
        if (a.sorted != b.sorted || (f > 1 && a.sorted == faces[f - 2].sorted)) continue;
        neighbours[a.tet][a.face] = b.tet;
        neighbours[b.tet][b.face] = a.tet;
    }
    return neighbours;
}

// Takes tets without a region, breadth-first from `first`, until there are `most`; calls take(tet) for each.
template <typename IsFree, typename Take>
std::vector<int> grow(int first, const Neighbours& neighbours, std::size_t most, const IsFree& is_free,
                      const Take& take)
{
    std::vector<int> grown = {first};
    take(first);
    for (std::size_t done = 0; done < grown.size(); ++done)
        for (const int t : neighbours[grown[done]]) {
            if (t == none || grown.size() == most || !is_free(t)) continue;
            take(t);
            grown.push_back(t);
        }
    return grown;
}

std::vector<int> breadth_first(const Neighbours& neighbours)
{
    std::vector<bool> visited(neighbours.size(), false);
    std::vector<int> order;
    for (std::size_t t = 0; t < neighbours.size(); ++t) {
        if (visited[t]) continue;
        const std::vector<int> part = grow(
            static_cast<int>(t), neighbours, neighbours.size(), [&](int other) { return !visited[other]; },
            [&](int other) { visited[other] = true; });
        order.insert(order.end(), part.begin(), part.end());
    }
    return order;
}

// The other region with most faces to these tets of region `own`, the first of equals; none where there is no other
// one.
int nearest_region(const std::vector<int>& part, int own, const Neighbours& neighbours, const std::vector<int>& region)
{
    std::map<int, int> faces;
    for (const int t : part)
        for (const int other : neighbours[t])
            if (other != none && region[other] != own) ++faces[region[other]];
    int nearest = none;
    for (const auto& [of, count] : faces)
        if (nearest == none || count > faces[nearest]) nearest = of;
    return nearest;
}

Vec3 nearest_on_segment(const Vec3& point, const Vec3& a, const Vec3& b, int from, int to)
{
    const double length2 = (b - a).squaredNorm();
    const double parameter = length2 > 0.0 ? std::clamp((point - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
    Vec3 barycentric = Vec3::Zero();
    barycentric(from) += 1.0 - parameter;
    barycentric(to) += parameter;
    return barycentric;
}

}  // namespace

Eigen::VectorXd tet_volumes(const Positions& positions, const Tets& tets)
{
    Eigen::VectorXd volumes(tets.rows());
    for (Eigen::Index t = 0; t < tets.rows(); ++t)
        volumes(t) = tet_volume(positions.row(tets(t, 0)), positions.row(tets(t, 1)), positions.row(tets(t, 2)),
                                positions.row(tets(t, 3)));
    return volumes;
}

Eigen::VectorXd positive_volumes(const Positions& rest, const Tets& tets)
{
    Eigen::VectorXd volumes = tet_volumes(rest, tets);
    for (Eigen::Index t = 0; t < volumes.size(); ++t)
        if (!(volumes(t) > 0.0))
            throw InputError("mesh", 0, "tet " + std::to_string(t), number_text(volumes(t)) + " m^3",
                             "expected a positive rest volume");
    return volumes;
}

Eigen::Matrix<double, 3, 4> barycentric_gradients(const TetMesh& mesh, Eigen::Index tet, double* volume_m3)
{
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.row(k) = mesh.rest.row(mesh.tets(tet, k + 1)) - mesh.rest.row(mesh.tets(tet, 0));
    if (volume_m3) *volume_m3 = edges.determinant() / 6.0;
    Eigen::Matrix<double, 3, 4> gradients;
    gradients.rightCols<3>() = edges.inverse();
    gradients.col(0) = -gradients.rightCols<3>().rowwise().sum();
    return gradients;
}

Eigen::VectorXd lumped_volumes(const Positions& rest, const Tets& tets)
{
    const Eigen::VectorXd volumes = tet_volumes(rest, tets);
    Eigen::VectorXd lumped = Eigen::VectorXd::Zero(rest.rows());
    for (Eigen::Index t = 0; t < tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner) lumped(tets(t, corner)) += volumes(t) / 4.0;
    return lumped;
}

double triangle_area(const Vec3& a, const Vec3& b, const Vec3& c)
{
    return 0.5 * (b - a).cross(c - a).norm();
}

double surface_area(const Positions& points, const Triangles& triangles)
{
    double area = 0.0;
    for (const auto& triangle : triangles.rowwise())
        area += triangle_area(points.row(triangle(0)), points.row(triangle(1)), points.row(triangle(2)));
    return area;
}

Eigen::VectorXd lumped_areas(const Positions& points, const Triangles& triangles)
{
    Eigen::VectorXd lumped = Eigen::VectorXd::Zero(points.rows());
    for (const auto& triangle : triangles.rowwise()) {
        const double area = triangle_area(points.row(triangle(0)), points.row(triangle(1)), points.row(triangle(2)));
        for (const int corner : triangle) lumped(corner) += area / 3.0;
    }
    return lumped;
}

double fan_volume(const Positions& points, const Triangles& triangles)
{
    const Vec3 middle = points.colwise().mean().transpose();
    double volume = 0.0;
    for (const auto& triangle : triangles.rowwise())
        volume += tet_volume(middle, points.row(triangle(0)), points.row(triangle(1)), points.row(triangle(2)));
    return volume;
}

Refinement refine(const TetMesh& mesh)
{
    Refinement fine;
    fine.parents = edges_of(mesh.tets);
    fine.mesh.rest = prolongated(mesh.rest, fine.parents);
    fine.mesh.tets.resize(8 * mesh.tets.rows(), 4);
    Eigen::Index next = 0;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const Nodes nodes = nodes_of(mesh, fine.parents, t);
        for (const Children* children : {&at_corners, &shortest_diagonal(fine.mesh.rest, nodes).tets})
            for (const auto& [a, b, c, d] : *children)
                fine.mesh.tets.row(next++) << nodes[a], nodes[b], nodes[c], nodes[d];
    }
    return fine;
}

Positions prolongated(const Positions& coarse, const Edges& parents)
{
    Positions fine(coarse.rows() + parents.rows(), 3);
    fine.topRows(coarse.rows()) = coarse;
    for (Eigen::Index e = 0; e < parents.rows(); ++e)
        fine.row(coarse.rows() + e) = 0.5 * (coarse.row(parents(e, 0)) + coarse.row(parents(e, 1)));
    return fine;
}

PointLocation::PointLocation(const TetMesh& mesh) : mesh_(mesh), low_(mesh.rest.colwise().minCoeff())
{
    const Vec3 size = mesh.rest.colwise().maxCoeff().transpose() - low_;
    const double cell_m = std::cbrt(size.prod() / static_cast<double>(mesh.tets.rows()));  // about one cell per tet
    for (int axis = 0; axis < 3; ++axis) cells_(axis) = std::clamp(static_cast<int>(size(axis) / cell_m), 1, 1000);
    cell_size_m_ = size.cwiseQuotient(cells_.cast<double>());

    first_.assign(cells_.prod() + 1, 0);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) for_each_cell_of_tet(t, [&](int cell) { ++first_[cell + 1]; });
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    tet_in_cell_.resize(first_.back());
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for_each_cell_of_tet(t, [&](int cell) { tet_in_cell_[next[cell]++] = static_cast<int>(t); });
}

PointLocation::Cell PointLocation::cell_of(const Vec3& point) const
{
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
        const double place = std::floor((point(axis) - low_(axis)) / cell_size_m_(axis));
        cell(axis) = static_cast<int>(std::clamp(place, 0.0, cells_(axis) - 1.0));
    }
    return cell;
}

template <typename Visit>
void PointLocation::for_each_cell_of_tet(Eigen::Index tet, Visit visit) const
{
    Eigen::AlignedBox3d box;
    for (const int vertex : mesh_.tets.row(tet)) box.extend(Vec3(mesh_.rest.row(vertex)));
    const Vec3 margin = on_face * box.sizes();  // so that a point taken for on the face is looked for here
    const Cell first = cell_of(box.min() - margin), last = cell_of(box.max() + margin);
    for (int k = first(2); k <= last(2); ++k)
        for (int j = first(1); j <= last(1); ++j)
            for (int i = first(0); i <= last(0); ++i) visit(index_of({i, j, k}));
}

Location PointLocation::locate(const Vec3& point) const
{
    if (!point.allFinite()) return {};
    const int cell = index_of(cell_of(point));
    for (int k = first_[cell]; k < first_[cell + 1]; ++k) {
        const Vec3 barycentric = barycentric_in(mesh_, tet_in_cell_[k], point);
        if (std::min(barycentric.minCoeff(), 1.0 - barycentric.sum()) >= -on_face)
            return {tet_in_cell_[k], barycentric};
    }
    return {};
}

std::vector<int> tet_regions(const Tets& tets, int region_size)
{
    const Neighbours neighbours = neighbours_over_faces(tets);
    std::vector<int> region(tets.rows(), none);
    int regions = 0;
    for (const int first : breadth_first(neighbours)) {
        if (region[first] != none) continue;
        const std::vector<int> part = grow(
            first, neighbours, region_size, [&](int t) { return region[t] == none; },
            [&](int t) { region[t] = regions; });
        const bool is_small = 2 * part.size() < static_cast<std::size_t>(region_size);
        const int nearest = is_small ? nearest_region(part, regions, neighbours, region) : none;
        if (nearest == none)
            ++regions;
        else
            for (const int t : part) region[t] = nearest;
    }
    return region;
}

std::vector<Triangles> region_surfaces(const Tets& tets, const std::vector<int>& region)
{
    std::vector<std::vector<int>> members;
    for (std::size_t t = 0; t < region.size(); ++t) {
        if (region[t] >= static_cast<int>(members.size())) members.resize(region[t] + 1);
        members[region[t]].push_back(static_cast<int>(t));
    }
    std::vector<Triangles> surfaces;
    for (const std::vector<int>& of_region : members) surfaces.push_back(boundary_of(tets(of_region, Eigen::all)));
    return surfaces;
}

Vec3 nearest_in_triangle(const Vec3& point, const Eigen::Matrix3d& corners)
{
    const Vec3 a = corners.row(0), b = corners.row(1), c = corners.row(2), normal = (b - a).cross(c - a);
    const double area2 = normal.squaredNorm();
    if (area2 > 0.0) {
        const Vec3 barycentric(normal.dot((c - b).cross(point - b)) / area2,
                               normal.dot((a - c).cross(point - c)) / area2,
                               normal.dot((b - a).cross(point - a)) / area2);
        if (barycentric.minCoeff() >= 0.0) return barycentric / barycentric.sum();
    }
    Vec3 best = Vec3::UnitX();
    double least = std::numeric_limits<double>::max();
    for (const Vec3& candidate : {nearest_on_segment(point, a, b, 0, 1), nearest_on_segment(point, b, c, 1, 2),
                                  nearest_on_segment(point, c, a, 2, 0)}) {
        const double distance = (corners.transpose() * candidate - point).squaredNorm();
        if (distance >= least) continue;
        least = distance;
        best = candidate;
    }
    return best;
}

}  // namespace pbs
