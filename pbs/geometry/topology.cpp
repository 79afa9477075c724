#include "pbs/geometry/topology.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iomanip>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>
#include <tuple>
#include <utility>

namespace pbs {
namespace {

// Faces of a positively oriented tet, outward.
constexpr std::array<std::array<int, 3>, 4> outward_faces = {{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

struct BoundaryEdge {
    std::array<int, 2> vertex;  // first < second
    std::array<int, 2> corner;  // 3 * triangle + corner, of the first and the second vertex
};

// Calls body(first, last) for each run of entries with the same key.
template <typename Entry, typename Key, typename Body>
void for_each_run(const std::vector<Entry>& entries, Key key, Body body)
{
    std::size_t first = 0;
    for (std::size_t last = 1; last <= entries.size(); ++last)
        if (last == entries.size() || key(entries[last]) != key(entries[first])) {
            body(first, last);
            first = last;
        }
}

// Everything that each(add) adds, twice the same, sorted by `less`, which compares vertex(entry) first: into one bucket
// per vertex, and then within each bucket, all of which are short. Linear in the entries.
template <typename Entry, typename Each, typename Vertex, typename Less>
std::vector<Entry> sorted_by_vertex(const Each& each, const Vertex& vertex, const Less& less)
{
    std::vector<std::size_t> first(1, 0);  // of each vertex's bucket
    each([&](const Entry& entry) {
        const std::size_t bucket = vertex(entry);
        if (first.size() < bucket + 2) first.resize(bucket + 2, 0);
        ++first[bucket + 1];
    });
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Entry> entries(first.back());
    std::vector<std::size_t> next = first;
    each([&](const Entry& entry) { entries[next[vertex(entry)]++] = entry; });
    for (std::size_t v = 0; v + 1 < first.size(); ++v)
        std::sort(entries.begin() + first[v], entries.begin() + first[v + 1], less);
    return entries;
}

std::vector<BoundaryEdge> sorted_edges(const Triangles& triangles)
{
    std::vector<BoundaryEdge> edges;
    edges.reserve(3 * triangles.rows());
    for (int t = 0; t < triangles.rows(); ++t)
        for (int side = 0; side < 3; ++side) {
            BoundaryEdge edge{{triangles(t, side), triangles(t, (side + 1) % 3)},
                              {3 * t + side, 3 * t + (side + 1) % 3}};
            if (edge.vertex[0] > edge.vertex[1]) {
                std::swap(edge.vertex[0], edge.vertex[1]);
                std::swap(edge.corner[0], edge.corner[1]);
            }
            edges.push_back(edge);
        }
    std::sort(edges.begin(), edges.end(),
              [](const BoundaryEdge& a, const BoundaryEdge& b) { return a.vertex < b.vertex; });
    return edges;
}

int count_used(const std::vector<bool>& used)
{
    return static_cast<int>(std::count(used.begin(), used.end(), true));
}

// Components, Euler characteristic and manifoldness of the boundary. A fan is a class of triangle corners round a
// vertex.
void examine_boundary(const Triangles& boundary, int boundary_vertex_count, Topology& topology)
{
    const std::vector<BoundaryEdge> edges = sorted_edges(boundary);
    Classes components(boundary.rows()), fans(3 * boundary.rows());
    int edge_count = 0;
    bool two_triangles_an_edge = true;
    const auto examine_edge = [&](std::size_t first, std::size_t last) {
        ++edge_count;
        two_triangles_an_edge = two_triangles_an_edge && last - first == 2;
        for (std::size_t e = first + 1; e < last; ++e) {
            components.unite(edges[first].corner[0] / 3, edges[e].corner[0] / 3);
            for (int end = 0; end < 2; ++end) fans.unite(edges[first].corner[end], edges[e].corner[end]);
        }
    };
    for_each_run(
        edges, [](const BoundaryEdge& edge) { return edge.vertex; }, examine_edge);

    topology.boundary_manifold = two_triangles_an_edge && fans.count() == boundary_vertex_count;
    topology.boundary_components = components.count();
    topology.boundary_euler = boundary_vertex_count - edge_count + static_cast<int>(boundary.rows());
}

Triangles boundary_in(const std::vector<TetFace>& faces, const Tets& tets)
{
    std::vector<std::pair<int, int>> boundary;  // tet, face: in the order of the tets
    for_each_run(
        faces, [](const TetFace& face) { return face.sorted; },
        [&](std::size_t first, std::size_t last) {
            if (last - first == 1) boundary.emplace_back(faces[first].tet, faces[first].face);
        });
    std::sort(boundary.begin(), boundary.end());

    Triangles triangles(boundary.size(), 3);
    for (std::size_t b = 0; b < boundary.size(); ++b)
        for (int corner = 0; corner < 3; ++corner)
            triangles(b, corner) = tets(boundary[b].first, outward_faces[boundary[b].second][corner]);
    return triangles;
}

template <typename Cells>
std::vector<bool> vertices_of(const Cells& cells, Eigen::Index vertices)
{
    std::vector<bool> used(vertices, false);
    for (const int vertex : cells.reshaped()) used[vertex] = true;
    return used;
}

// The tets in classes of those that faces join.
Classes joined_by_faces(const std::vector<TetFace>& faces, Eigen::Index tets)
{
    Classes classes(tets);
    for (std::size_t f = 1; f < faces.size(); ++f)
        if (faces[f].sorted == faces[f - 1].sorted) classes.unite(faces[f - 1].tet, faces[f].tet);
    return classes;
}

// The edges of all triangles, sorted.
std::vector<DirectedEdge> directed_edges(const Triangles& triangles, bool reversed)
{
    std::vector<DirectedEdge> edges;
    for (Eigen::Index f = 0; f < triangles.rows(); ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = triangles(f, k), b = triangles(f, (k + 1) % 3);
            edges.push_back(reversed ? DirectedEdge{b, a} : DirectedEdge{a, b});
        }
    std::sort(edges.begin(), edges.end());
    return edges;
}

// The six edges of a tet, each with the two corners that are not on it.
constexpr std::array<std::array<int, 4>, 6> edge_corners = {
    {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}}};

void examine_dihedrals(const TetMesh& mesh, Quality& quality)
{
    quality.min_dihedral_deg = 180.0;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const std::array<double, 6> angles_deg =
            dihedral_angles_deg(mesh.rest.row(mesh.tets(t, 0)), mesh.rest.row(mesh.tets(t, 1)),
                                mesh.rest.row(mesh.tets(t, 2)), mesh.rest.row(mesh.tets(t, 3)));
        const auto [smallest, largest] = std::minmax_element(angles_deg.begin(), angles_deg.end());
        quality.min_dihedral_deg = std::min(quality.min_dihedral_deg, *smallest);
        quality.max_dihedral_deg = std::max(quality.max_dihedral_deg, *largest);
    }
}

void examine_edges(const TetMesh& mesh, Quality& quality)
{
    const Edges edges = edges_of(mesh.tets);
    quality.edges = static_cast<int>(edges.rows());
    quality.shortest_edge_m = std::numeric_limits<double>::infinity();
    for (Eigen::Index e = 0; e < edges.rows(); ++e) {
        const double length = (mesh.rest.row(edges(e, 0)) - mesh.rest.row(edges(e, 1))).norm();
        quality.shortest_edge_m = std::min(quality.shortest_edge_m, length);
        quality.longest_edge_m = std::max(quality.longest_edge_m, length);
    }
}

}  // namespace

std::vector<TetFace> sorted_faces(const Tets& tets)
{
    const auto each = [&](const auto& add) {
        for (int t = 0; t < tets.rows(); ++t)
            for (int f = 0; f < 4; ++f) {
                std::array<int, 3> v;
                for (int corner = 0; corner < 3; ++corner) v[corner] = tets(t, outward_faces[f][corner]);
                const bool even = (v[0] < v[1]) + (v[1] < v[2]) + (v[2] < v[0]) == 2;
                std::sort(v.begin(), v.end());
                add(TetFace{v, t, f, even});
            }
    };
    return sorted_by_vertex<TetFace>(
        each, [](const TetFace& face) { return face.sorted[0]; },
        [](const TetFace& a, const TetFace& b) { return std::tie(a.sorted, a.tet) < std::tie(b.sorted, b.tet); });
}

Edges edges_of(const Tets& tets)
{
    using Pair = std::array<int, 2>;
    const auto each = [&](const auto& add) {
        for (Eigen::Index t = 0; t < tets.rows(); ++t)
            for (int a = 0; a < 4; ++a)
                for (int b = a + 1; b < 4; ++b)
                    add(Pair{std::min(tets(t, a), tets(t, b)), std::max(tets(t, a), tets(t, b))});
    };
    std::vector<Pair> pairs = sorted_by_vertex<Pair>(
        each, [](const Pair& pair) { return pair[0]; }, std::less<Pair>());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());

    Edges edges(pairs.size(), 2);
    for (std::size_t e = 0; e < pairs.size(); ++e) edges.row(e) << pairs[e][0], pairs[e][1];
    return edges;
}

Adjacency adjacency_of(const Tets& tets, int vertices)
{
    const Edges edges = edges_of(tets);
    Adjacency adjacency{std::vector<int>(vertices + 1, 0), std::vector<int>(2 * edges.rows())};
    for (const int vertex : edges.reshaped()) ++adjacency.first[vertex + 1];
    for (int i = 0; i < vertices; ++i) adjacency.first[i + 1] += adjacency.first[i];
    std::vector<int> next(adjacency.first.begin(), adjacency.first.end() - 1);
    for (Eigen::Index e = 0; e < edges.rows(); ++e) {
        adjacency.neighbour[next[edges(e, 0)]++] = edges(e, 1);
        adjacency.neighbour[next[edges(e, 1)]++] = edges(e, 0);
    }
    return adjacency;
}

Triangles boundary_of(const Tets& tets)
{
    return boundary_in(sorted_faces(tets), tets);
}

std::vector<bool> boundary_vertices(const Tets& tets, Eigen::Index vertices)
{
    return vertices_of(boundary_of(tets), vertices);
}

Triangles joined_triangles(const Positions& points, const Triangles& triangles)
{
    std::map<std::array<double, 3>, int> first_at;
    std::vector<int> first(static_cast<std::size_t>(points.rows()));
    for (int p = 0; p < points.rows(); ++p)
        first[p] = first_at.emplace(std::array{points(p, 0), points(p, 1), points(p, 2)}, p).first->second;
    return triangles.unaryExpr([&](int p) { return first[p]; });
}

std::optional<DirectedEdge> open_edge(const Triangles& triangles)
{
    const std::vector<DirectedEdge> forward = directed_edges(triangles, false),
                                    backward = directed_edges(triangles, true);
    const auto [one, other] = std::mismatch(forward.begin(), forward.end(), backward.begin());
    if (one == forward.end()) return std::nullopt;
    return std::min(*one, *other);
}

bool is_closed(const Triangles& triangles)
{
    return triangles.rows() > 0 && !open_edge(triangles);
}

bool is_watertight(const Triangles& triangles)
{
    const std::vector<DirectedEdge> edges = directed_edges(triangles, false);
    return is_closed(triangles) && std::adjacent_find(edges.begin(), edges.end()) == edges.end();
}

Topology topology_of(const Tets& tets, Eigen::Index vertices)
{
    Topology topology;
    const std::vector<TetFace> faces = sorted_faces(tets);
    const Triangles boundary = boundary_in(faces, tets);
    examine_boundary(boundary, count_used(vertices_of(boundary, vertices)), topology);

    for_each_run(
        faces, [](const TetFace& face) { return face.sorted; },
        [&](std::size_t first, std::size_t last) {
            if (last - first > 2) topology.boundary_manifold = false;
        });
    topology.components = joined_by_faces(faces, tets.rows()).count();
    topology.unused_vertices = static_cast<int>(vertices) - count_used(vertices_of(tets, vertices));
    return topology;
}

std::vector<int> parts_of(const Tets& tets)
{
    Classes joined = joined_by_faces(sorted_faces(tets), tets.rows());
    std::map<int, int> number;
    std::vector<int> parts;
    for (int tet = 0; tet < tets.rows(); ++tet)
        parts.push_back(number.emplace(joined.find(tet), static_cast<int>(number.size())).first->second);
    return parts;
}

TetMesh kept_tets(const TetMesh& mesh, const std::vector<bool>& kept)
{
    std::vector<int> tets;
    for (int tet = 0; tet < mesh.tets.rows(); ++tet)
        if (kept[static_cast<std::size_t>(tet)]) tets.push_back(tet);
    Tets own = mesh.tets(tets, Eigen::all);
    return {mesh.rest(renumbered(own, mesh.rest.rows()), Eigen::all), own};
}

std::array<double, 6> dihedral_angles_deg(const Vec3& p1, const Vec3& p2, const Vec3& p3, const Vec3& p4)
{
    const std::array<const Vec3*, 4> corner = {&p1, &p2, &p3, &p4};
    std::array<double, 6> angles_deg;
    for (std::size_t e = 0; e < edge_corners.size(); ++e) {
        const auto [a, b, c, d] = edge_corners[e];
        const Vec3 edge = *corner[b] - *corner[a];
        const Vec3 normal_c = edge.cross(*corner[c] - *corner[a]), normal_d = edge.cross(*corner[d] - *corner[a]);
        angles_deg[e] = std::atan2(normal_c.cross(normal_d).norm(), normal_c.dot(normal_d)) * 180.0 / std::numbers::pi;
    }
    return angles_deg;
}

Quality quality_of(const TetMesh& mesh)
{
    Quality quality;
    quality.vertices = static_cast<int>(mesh.rest.rows());
    quality.tets = static_cast<int>(mesh.tets.rows());
    quality.topology = topology_of(mesh.tets, mesh.rest.rows());
    if (quality.tets == 0) return quality;

    const Triangles boundary = boundary_of(mesh.tets);
    quality.boundary_triangles = static_cast<int>(boundary.rows());
    quality.boundary_vertices = count_used(vertices_of(boundary, mesh.rest.rows()));
    quality.volume_m3 = tet_volumes(mesh.rest, mesh.tets).sum();
    examine_dihedrals(mesh, quality);
    examine_edges(mesh, quality);
    return quality;
}

std::string describe(const Quality& quality)
{
    const Topology& topology = quality.topology;
    std::ostringstream text;
    text << quality.vertices << " vertices (" << quality.boundary_vertices << " on the boundary), " << quality.edges
         << " edges, " << quality.tets << " tets, " << quality.boundary_triangles << " boundary triangles\n";
    text << std::setprecision(6) << "volume " << quality.volume_m3 << " m^3, edges " << std::setprecision(3)
         << quality.shortest_edge_m << " to " << quality.longest_edge_m << " m, dihedral angles " << std::fixed
         << std::setprecision(1) << quality.min_dihedral_deg << " to " << quality.max_dihedral_deg << " deg\n";
    text << "boundary " << (topology.boundary_manifold ? "manifold" : "NOT manifold") << ", "
         << topology.boundary_components << " component(s), Euler characteristic " << topology.boundary_euler << "; "
         << topology.components << " component(s) of tets, " << topology.unused_vertices << " unused vertices\n";
    return text.str();
}

}  // namespace pbs
