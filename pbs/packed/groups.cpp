#include "pbs/packed/groups.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <unordered_map>

namespace pbs {

int vertices_of(GroupKind kind)
{
    return with_kind(kind, [](auto of_kind) { return GroupShape<of_kind()>::vertices; });
}

int constraints_of(GroupKind kind)
{
    return with_kind(kind, [](auto of_kind) { return GroupShape<of_kind()>::constraints; });
}

std::vector<ConstraintGroup> single_edges(const std::vector<std::array<int, 2>>& edges)
{
    std::vector<ConstraintGroup> groups;
    groups.reserve(edges.size());
    for (const auto& [i, j] : edges) groups.push_back({GroupKind::edge, {i, j}, {static_cast<int>(groups.size())}});
    return groups;
}

std::vector<ConstraintGroup> single_tets(const std::vector<std::array<int, 4>>& tets)
{
    std::vector<ConstraintGroup> groups;
    groups.reserve(tets.size());
    for (const auto& [i, j, k, l] : tets)
        groups.push_back({GroupKind::tet, {i, j, k, l}, {static_cast<int>(groups.size())}});
    return groups;
}

namespace {

// Edges in groups, the largest first: tets whose edges are nearly all free, then triangles, then pairs at a vertex,
// then what is left.
class EdgeGrouping {
public:
    EdgeGrouping(const std::vector<std::array<int, 2>>& edges, const Tets& mesh_tets)
        : edges_(edges), free_(edges.size(), true)
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
    static std::uint64_t key(int i, int j)
    {
        return std::uint64_t(std::min(i, j)) << 32 | std::uint64_t(std::max(i, j));
    }

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
            for (const auto& [i, j, k] :
                 {std::array{0, 1, 2}, std::array{0, 1, 3}, std::array{0, 2, 3}, std::array{1, 2, 3}})
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

using Tet = std::array<int, 4>;

// Neighbour of each tet across the face opposite to each of its corners; -1 on the boundary, #T x 4.
std::vector<std::array<int, 4>> neighbours_of(const std::vector<Tet>& tets)
{
    struct Face {
        std::array<int, 3> vertex;
        int tet, opposite;
    };
    std::vector<Face> faces;
    faces.reserve(4 * tets.size());
    for (std::size_t t = 0; t < tets.size(); ++t)
        for (int opposite = 0; opposite < 4; ++opposite) {
            Face face{{tets[t][(opposite + 1) % 4], tets[t][(opposite + 2) % 4], tets[t][(opposite + 3) % 4]},
                      static_cast<int>(t),
                      opposite};
            std::sort(face.vertex.begin(), face.vertex.end());
            faces.push_back(face);
        }
    std::sort(faces.begin(), faces.end(),
              [](const Face& a, const Face& b) { return std::tie(a.vertex, a.tet) < std::tie(b.vertex, b.tet); });
    std::vector<std::array<int, 4>> neighbour(tets.size(), {-1, -1, -1, -1});
    for (std::size_t f = 0; f + 1 < faces.size(); ++f)
        if (faces[f].vertex == faces[f + 1].vertex) {
            neighbour[faces[f].tet][faces[f].opposite] = faces[f + 1].tet;
            neighbour[faces[f + 1].tet][faces[f + 1].opposite] = faces[f].tet;
            ++f;
        }
    return neighbour;
}

// tets[i] of a fan round the edge a, b has the corners a, b, ring[i], ring[i + 1], in an order of its own orientation.
struct Fan {
    int a = 0, b = 0;
    std::vector<int> ring, tets;
};

// Tets in fans round an edge, the largest first; among several, the fan whose members have the fewest free neighbours.
class TetGrouping {
public:
    explicit TetGrouping(const std::vector<Tet>& tets)
        : tets_(tets), neighbour_(neighbours_of(tets)), free_(tets.size(), true)
    {
        for (const int size : {3, 2})
            for (std::size_t t = 0; t < tets.size(); ++t)
                if (free_[t])
                    if (const std::optional<Fan> fan = best_fan(static_cast<int>(t), size)) add(*fan);
        for (std::size_t t = 0; t < tets.size(); ++t)
            if (free_[t])
                groups.push_back(
                    {GroupKind::tet, {tets[t][0], tets[t][1], tets[t][2], tets[t][3]}, {static_cast<int>(t)}});
    }

    std::vector<ConstraintGroup> groups;

private:
    // The free neighbour of t across the face that its corner `opposite` is not in; -1: none.
    int free_across(int t, int opposite) const
    {
        const auto corner = std::find(tets_[t].begin(), tets_[t].end(), opposite) - tets_[t].begin();
        const int neighbour = neighbour_[t][corner];
        return neighbour >= 0 && free_[neighbour] ? neighbour : -1;
    }

    int fourth(int t, int a, int b, int c) const
    {
        return *std::find_if(tets_[t].begin(), tets_[t].end(), [&](int v) { return v != a && v != b && v != c; });
    }

    // Whether a, b, c, d are the corners of t in an order of the same orientation.
    bool oriented(int t, int a, int b, int c, int d) const
    {
        Tet order = {a, b, c, d};
        bool even = true;
        for (int i = 0; i < 3; ++i) {
            const auto at = std::find(order.begin() + i, order.end(), tets_[t][i]);
            if (at == order.begin() + i) continue;
            std::iter_swap(at, order.begin() + i);
            even = !even;
        }
        return even;
    }

    int free_neighbours(int t) const
    {
        return static_cast<int>(
            std::count_if(neighbour_[t].begin(), neighbour_[t].end(), [&](int n) { return n >= 0 && free_[n]; }));
    }

    // Goes on round a, b from the fan's last tet; nothing where the way is closed or comes back to the first.
    std::optional<Fan> continued(Fan fan) const
    {
        const int last = fan.ring.back(), behind = fan.ring[fan.ring.size() - 2];
        const int tet = free_across(fan.tets.back(), behind);
        if (tet < 0) return {};
        const int next = fourth(tet, fan.a, fan.b, last);
        if (next == fan.ring.front() || !oriented(tet, fan.a, fan.b, last, next)) return {};
        fan.ring.push_back(next);
        fan.tets.push_back(tet);
        return fan;
    }

    std::optional<Fan> best_fan(int t, int size) const
    {
        std::optional<Fan> best;
        int fewest = std::numeric_limits<int>::max();
        for (const auto& [a, b, c, d] :
             {Tet{0, 1, 2, 3}, Tet{0, 2, 1, 3}, Tet{0, 3, 1, 2}, Tet{1, 2, 0, 3}, Tet{1, 3, 0, 2}, Tet{2, 3, 0, 1}})
            for (const bool turned : {false, true}) {
                const Tet& v = tets_[t];
                std::optional<Fan> fan =
                    Fan{v[a], v[b], turned ? std::vector{v[d], v[c]} : std::vector{v[c], v[d]}, {t}};
                if (!oriented(t, fan->a, fan->b, fan->ring[0], fan->ring[1])) std::swap(fan->a, fan->b);
                int free = 0;
                for (int more = 1; more < size && fan; ++more) {
                    fan = continued(*fan);
                    if (fan) free += free_neighbours(fan->tets.back());
                }
                if (fan && free < fewest) {
                    fewest = free;
                    best = fan;
                }
            }
        return best;
    }

    void add(const Fan& fan)
    {
        ConstraintGroup group{fan.tets.size() == 3 ? GroupKind::tet_fan_3 : GroupKind::tet_fan_2, {fan.a, fan.b}, {}};
        std::copy(fan.ring.begin(), fan.ring.end(), group.vertex.begin() + 2);
        std::copy(fan.tets.begin(), fan.tets.end(), group.constraint.begin());
        for (const int t : fan.tets) free_[t] = false;
        groups.push_back(group);
    }

    const std::vector<Tet>& tets_;
    std::vector<std::array<int, 4>> neighbour_;
    std::vector<bool> free_;
};

}  // namespace

std::vector<ConstraintGroup> grouped_edges(const std::vector<std::array<int, 2>>& edges, const Tets& mesh_tets)
{
    return EdgeGrouping(edges, mesh_tets).groups;
}

std::vector<ConstraintGroup> grouped_tets(const std::vector<std::array<int, 4>>& tets)
{
    return TetGrouping(tets).groups;
}

}  // namespace pbs
