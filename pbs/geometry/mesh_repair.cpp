#include "pbs/geometry/mesh_repair.hpp"

#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace pbs {
namespace {

// The tets of each vertex, #V.
std::vector<std::vector<int>> tets_of_vertices(const TetMesh& mesh)
{
    std::vector<std::vector<int>> tets(static_cast<std::size_t>(mesh.rest.rows()));
    for (int t = 0; t < mesh.tets.rows(); ++t)
        for (const int vertex : mesh.tets.row(t)) tets[static_cast<std::size_t>(vertex)].push_back(t);
    return tets;
}

// The group of each of a vertex's tets: those that are joined by faces at that vertex.
std::vector<int> groups_at(int vertex, const std::vector<int>& around, const Tets& tets)
{
    std::vector<int> group(around.size());
    std::iota(group.begin(), group.end(), 0);
    const auto root_of = [&](int member) {
        while (group[member] != member) member = group[member] = group[group[member]];
        return member;
    };
    std::map<std::array<int, 2>, int> tet_at;  // by the other two vertices of a face
    for (int member = 0; member < static_cast<int>(around.size()); ++member) {
        std::vector<int> others;
        for (const int corner : tets.row(around[member]))
            if (corner != vertex) others.push_back(corner);
        std::sort(others.begin(), others.end());
        for (const auto& face : {std::array{others[0], others[1]}, std::array{others[0], others[2]}, std::array{others[1], others[2]}}) {
            const auto [other, added] = tet_at.emplace(face, member);
            if (!added) group[root_of(member)] = root_of(other->second);
        }
    }
    for (int member = 0; member < static_cast<int>(around.size()); ++member) group[member] = root_of(member);
    return group;
}

}  // namespace

RepairedMesh repaired(const TetMesh& mesh)
{
    RepairedMesh result;
    result.mesh.tets = mesh.tets;
    const std::vector<std::vector<int>> tets_of = tets_of_vertices(mesh);
    for (int vertex = 0; vertex < mesh.rest.rows(); ++vertex) {
        const std::vector<int>& around = tets_of[static_cast<std::size_t>(vertex)];
        if (around.empty()) {
            result.unused.push_back(vertex);
            continue;
        }
        const std::vector<int> groups = groups_at(vertex, around, mesh.tets);
        std::map<int, int> index_of_group;
        for (std::size_t member = 0; member < around.size(); ++member) {
            const auto [index, added] = index_of_group.emplace(groups[member], static_cast<int>(result.file_vertex.size()));
            if (added) result.file_vertex.push_back(vertex);
            for (int corner = 0; corner < 4; ++corner)
                if (mesh.tets(around[member], corner) == vertex) result.mesh.tets(around[member], corner) = index->second;
        }
        if (index_of_group.size() > 1) result.split.push_back(vertex);
    }
    result.mesh.rest.resize(static_cast<Eigen::Index>(result.file_vertex.size()), 3);
    for (std::size_t v = 0; v < result.file_vertex.size(); ++v)
        result.mesh.rest.row(static_cast<Eigen::Index>(v)) = mesh.rest.row(result.file_vertex[v]);
    return result;
}

std::optional<std::array<int, 2>> edge_that_is_not_manifold(const Tets& tets)
{
    const Triangles boundary = boundary_of(tets);
    std::map<std::pair<int, int>, int> triangles_at;
    for (const auto& triangle : boundary.rowwise())
        for (int k = 0; k < 3; ++k) ++triangles_at[std::minmax({triangle(k), triangle((k + 1) % 3)})];
    for (const auto& [edge, count] : triangles_at)
        if (count > 2) return std::array{edge.first, edge.second};
    return std::nullopt;
}

}  // namespace pbs
