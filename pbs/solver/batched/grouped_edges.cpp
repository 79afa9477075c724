// Edges in groups, the largest first: tets whose edges are nearly all free, then triangles, then pairs at a vertex, then what is left.
#include "pbs/packed/groups.hpp"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

namespace pbs {
namespace {

class EdgeGrouping {
public:
    EdgeGrouping(const std::vector<std::array<int, 2>>& edges, const Tets& mesh_tets) : edges_(edges), free_(edges.size(), true)
    {
        index_.reserve(2 * edges.size());
        for (std::size_t e = 0; e < edges.size(); ++e) index_[key(edges[e][0], edges[e][1])] = static_cast<int>(e);
        group_tets(mesh_tets, 6);
        group_tets(mesh_tets, 5);
        group_triangles(mesh_tets);
        group_wedges();
        for (std::size_t e = 0; e < edges.size(); ++e)
            if (free_[e]) add<GroupKind::edge>({edges[e][0], edges[e][1]});
    }

    std::vector<ConstraintGroup> groups;

private:
    static std::uint64_t key(int i, int j) { return std::uint64_t(std::min(i, j)) << 32 | std::uint64_t(std::max(i, j)); }

    int free_edge(int i, int j) const
    {
        const auto found = index_.find(key(i, j));
        return found != index_.end() && free_[found->second] ? found->second : -1;
    }

    template <GroupKind kind>
    void add(const std::array<int, largest_group>& vertex)
    {
        ConstraintGroup group{kind, vertex, {}};
        for (int c = 0; c < GroupShape<kind>::constraints; ++c) {
            const auto& join = GroupShape<kind>::joins[c];
            const int edge = free_edge(vertex[join[0]], vertex[join[1]]);
            group.constraint[c] = edge;
            if (edge >= 0) free_[edge] = false;
        }
        groups.push_back(group);
    }

    void group_tets(const Tets& tets, int at_least)
    {
        for (const auto tet : tets.rowwise()) {
            int count = 0;
            for (const auto& [i, j] : GroupShape<GroupKind::edge_tet>::joins) count += free_edge(tet(i), tet(j)) >= 0;
            if (count >= at_least) add<GroupKind::edge_tet>({tet(0), tet(1), tet(2), tet(3)});
        }
    }

    void group_triangles(const Tets& tets)
    {
        for (const auto tet : tets.rowwise())
            for (const auto& [i, j, k] : {std::array{0, 1, 2}, std::array{0, 1, 3}, std::array{0, 2, 3}, std::array{1, 2, 3}})
                if (free_edge(tet(i), tet(j)) >= 0 && free_edge(tet(j), tet(k)) >= 0 && free_edge(tet(k), tet(i)) >= 0)
                    add<GroupKind::edge_triangle>({tet(i), tet(j), tet(k)});
    }

    void group_wedges()
    {
        std::unordered_map<int, int> waiting;  // vertex -> other end of a free edge at it
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            if (!free_[e]) continue;
            for (const int middle : edges_[e]) {
                const int end = edges_[e][0] == middle ? edges_[e][1] : edges_[e][0];
                const auto other = waiting.find(middle);
                if (other != waiting.end() && free_edge(other->second, middle) >= 0 && other->second != end) {
                    const int other_end = other->second;
                    waiting.erase(other);
                    add<GroupKind::edge_wedge>({other_end, middle, end});
                    break;
                }
                waiting[middle] = end;
            }
        }
    }

    const std::vector<std::array<int, 2>>& edges_;
    std::unordered_map<std::uint64_t, int> index_;
    std::vector<bool> free_;
};

}  // namespace

std::vector<ConstraintGroup> grouped_edges(const std::vector<std::array<int, 2>>& edges, const Tets& mesh_tets)
{
    return EdgeGrouping(edges, mesh_tets).groups;
}

}  // namespace pbs
