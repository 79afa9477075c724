#include "pbs/packed/groups.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace pbs {
namespace {

// Earlier groups at each vertex, ascending, as one array.
struct GroupsAtVertex {
    std::vector<int> first, group;  // #V + 1; #V's groups one after the other
};

GroupsAtVertex groups_at_vertices(const std::vector<ConstraintGroup>& groups, int vertices)
{
    GroupsAtVertex at{std::vector<int>(static_cast<std::size_t>(vertices) + 1, 0), {}};
    for (const ConstraintGroup& group : groups)
        for (int v = 0; v < vertices_of(group.kind); ++v) ++at.first[group.vertex[v] + 1];
    std::partial_sum(at.first.begin(), at.first.end(), at.first.begin());
    at.group.resize(at.first.back());
    std::vector<int> next(at.first.begin(), at.first.end() - 1);
    for (std::size_t g = 0; g < groups.size(); ++g)
        for (int v = 0; v < vertices_of(groups[g].kind); ++v) at.group[next[groups[g].vertex[v]]++] = static_cast<int>(g);
    return at;
}

// First-fit colours, with marks of the colours that are taken around one group.
class Colouring {
public:
    explicit Colouring(std::size_t groups) : colour_(groups, 0) {}

    void take(int neighbour, int by)
    {
        const std::size_t colour = colour_[neighbour];
        if (colour >= taken_by_.size()) taken_by_.resize(colour + 1, -1);
        taken_by_[colour] = by;
    }
    void choose(int group)
    {
        const auto free = std::find_if(taken_by_.begin(), taken_by_.end(), [&](int by) { return by != group; });
        colour_[group] = static_cast<int>(free - taken_by_.begin());
    }
    int operator[](int group) const { return colour_[group]; }

private:
    std::vector<int> colour_;    // of each group
    std::vector<int> taken_by_;  // of each colour, the last group next to which it was found
};

}  // namespace

std::vector<int> projection_sequence(const std::vector<ConstraintGroup>& groups, int vertices)
{
    const GroupsAtVertex at = groups_at_vertices(groups, vertices);
    Colouring by_vertex(groups.size()), by_edge(groups.size()), by_face(groups.size());
    std::vector<int> shared(groups.size(), 0), neighbours;
    for (int g = 0; g < static_cast<int>(groups.size()); ++g) {
        neighbours.clear();
        for (int v = 0; v < vertices_of(groups[g].kind); ++v) {
            const int vertex = groups[g].vertex[v];
            for (int k = at.first[vertex]; at.group[k] < g; ++k)
                if (shared[at.group[k]]++ == 0) neighbours.push_back(at.group[k]);
        }
        for (const int neighbour : neighbours) {
            by_vertex.take(neighbour, g);
            if (shared[neighbour] >= 2) by_edge.take(neighbour, g);
            if (shared[neighbour] >= 3) by_face.take(neighbour, g);
            shared[neighbour] = 0;
        }
        by_vertex.choose(g), by_edge.choose(g), by_face.choose(g);
    }

    std::vector<int> sorted(groups.size()), place(groups.size());
    std::iota(sorted.begin(), sorted.end(), 0);
    const auto colours = [&](int g) {
        const int edge_colour = constraints_of(groups[g].kind) == 1 ? -by_edge[g] : 0;
        return std::tuple(by_face[g], edge_colour, by_vertex[g], g);
    };
    std::sort(sorted.begin(), sorted.end(), [&](int a, int b) { return colours(a) < colours(b); });
    for (std::size_t i = 0; i < sorted.size(); ++i) place[sorted[i]] = static_cast<int>(i);
    return place;
}

}  // namespace pbs
