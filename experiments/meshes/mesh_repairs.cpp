// Repairs of a tet mesh that move no tet: unused vertices are left out, and tets that touch in a vertex or an edge
// alone are separated.
#include "experiments/meshes/mesh_io_formats.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace pbs {
namespace {

using Edge = std::array<int, 2>;  // vertices, ascending

// The tets around a vertex and the triangles opposite to it, its link. An edge of the link is a face at the vertex, in
// one tet or two.
struct Star {
    std::vector<std::set<int>> vertices;  // of the triangle of each tet
    std::vector<std::set<Edge>> edges;    // of the same
    std::map<Edge, std::vector<int>> at;  // the places of an edge in these lists
    std::set<int> all;                    // vertices of the link

    // Vertices - edges + triangles of a link that faces join: 1 for a disc, 2 for a sphere; a further hole and each
    // vertex at which the link touches itself take 1 away.
    bool is_disc_or_sphere() const { return all.size() + vertices.size() > at.size(); }
};

template <typename Item>
int common(const std::set<Item>& a, const std::set<Item>& b)
{
    return static_cast<int>(std::count_if(a.begin(), a.end(), [&](const Item& item) { return b.contains(item); }));
}

Classes joined_by_faces(const Star& star)
{
    Classes joined(star.vertices.size());
    for (const auto& [face, members] : star.at)
        for (const int member : members) joined.unite(member, members.front());
    return joined;
}

// Discs, no two of which form a larger one. Two discs form one if what they share is connected: its vertices - edges
// = 1.
Classes joined_to_discs(Star star)
{
    Classes joined(star.vertices.size());
    const auto grows_over = [&](const auto& face) {
        const int one = joined.find(face.second.front()), other = joined.find(face.second.back());
        if (one == other ||
            common(star.vertices[one], star.vertices[other]) - common(star.edges[one], star.edges[other]) != 1)
            return false;
        joined.unite(other, one);
        star.vertices[one].merge(star.vertices[other]);
        star.edges[one].merge(star.edges[other]);
        return true;
    };
    while (std::any_of(star.at.begin(), star.at.end(), grows_over)) {
    }
    return joined;
}

// Gives classes of a vertex's tets vertices of their own, until the boundary is manifold: until each link is a disc or
// a sphere.
struct VertexSplitting {
    Tets tets;
    std::vector<int> file_vertex;           // of each vertex; copies come last
    std::vector<std::vector<int>> tets_of;  // of each vertex

    explicit VertexSplitting(const TetMesh& mesh)
        : tets(mesh.tets), file_vertex(mesh.rest.rows()), tets_of(mesh.rest.rows())
    {
        std::iota(file_vertex.begin(), file_vertex.end(), 0);
        for (int t = 0; t < tets.rows(); ++t)
            for (const int vertex : tets.row(t)) tets_of[vertex].push_back(t);
    }

    int vertices() const { return static_cast<int>(file_vertex.size()); }

    void make_manifold()
    {
        if (topology_of(tets, vertices()).boundary_manifold) return;
        for (int vertex = 0, of_file = vertices(); vertex < of_file; ++vertex)
            split(vertex, joined_by_faces(star_of(vertex)));
        std::vector<int> pending(file_vertex.size());
        std::iota(pending.begin(), pending.end(), 0);
        for (std::size_t next = 0; next < pending.size(); ++next) cut(pending[next], pending);
    }

    Star star_of(int vertex) const
    {
        Star star;
        for (const int t : tets_of[vertex]) {
            std::set<int> triangle(tets.row(t).begin(), tets.row(t).end());
            triangle.erase(vertex);
            std::set<Edge> edges;
            for (const int low : triangle)
                for (const int high : triangle)
                    if (low < high) edges.insert({low, high});
            for (const Edge& edge : edges) star.at[edge].push_back(static_cast<int>(star.vertices.size()));
            star.all.insert(triangle.begin(), triangle.end());
            star.vertices.push_back(std::move(triangle));
            star.edges.push_back(std::move(edges));
        }
        return star;
    }

    // The class of the first tet keeps the vertex.
    void split(int vertex, Classes classes)
    {
        const std::vector<int> around = std::exchange(tets_of[vertex], {});
        std::map<int, int> own;  // the vertex of each class
        for (std::size_t member = 0; member < around.size(); ++member) {
            const auto [found, is_new] =
                own.emplace(classes.find(static_cast<int>(member)), own.empty() ? vertex : vertices());
            if (is_new && member > 0) {
                file_vertex.push_back(file_vertex[vertex]);
                tets_of.emplace_back();
            }
            tets_of[found->second].push_back(around[member]);
            for (int& corner : tets.row(around[member]))
                if (corner == vertex) corner = found->second;
        }
    }

    // Where faces join tets that touch, or the outside touches itself, some of these faces are cut. That may separate
    // tets at their other vertices and let the outside touch itself there.
    void cut(int vertex, std::vector<int>& pending)
    {
        const Star star = star_of(vertex);
        if (star.is_disc_or_sphere()) return;
        const int first_copy = vertices();
        split(vertex, joined_to_discs(star));
        if (vertices() == first_copy) return;
        for (const int near : star.all) split(near, joined_by_faces(star_of(near)));
        pending.insert(pending.end(), star.all.begin(), star.all.end());
        for (int copy = first_copy; copy < vertices(); ++copy) pending.push_back(copy);
    }
};

}  // namespace

MeshReading repaired(const TetMesh& mesh, bool separates)
{
    VertexSplitting splitting(mesh);
    if (separates) splitting.make_manifold();
    MeshReading result;
    result.file_vertices = static_cast<int>(mesh.rest.rows());
    std::vector<int> order, number(splitting.file_vertex.size());  // copies directly behind the vertex of the file
    for (int vertex = 0; vertex < splitting.vertices(); ++vertex)
        (splitting.tets_of[vertex].empty() ? result.unused_vertices : order).push_back(vertex);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return splitting.file_vertex[a] < splitting.file_vertex[b]; });
    for (const int vertex : order) {
        const int of_file = splitting.file_vertex[vertex];
        const bool is_copy = !result.file_vertex.empty() && result.file_vertex.back() == of_file;
        if (is_copy && (result.split_vertices.empty() || result.split_vertices.back() != of_file))
            result.split_vertices.push_back(of_file);
        number[vertex] = static_cast<int>(result.file_vertex.size());
        result.file_vertex.push_back(of_file);
    }
    result.mesh = {mesh.rest(result.file_vertex, Eigen::all),
                   splitting.tets.unaryExpr([&](int vertex) { return number[vertex]; })};
    result.cut_faces = static_cast<int>(boundary_of(splitting.tets).rows() - boundary_of(mesh.tets).rows()) / 2;
    return result;
}

}  // namespace pbs
