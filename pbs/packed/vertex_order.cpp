#include "pbs/packed/vertex_order.hpp"

#include "pbs/geometry/topology.hpp"

#include <algorithm>

namespace pbs {
namespace {

// Vertices in breadth-first order from `start`, and where each level begins in it.
struct Levels {
    std::vector<int> order, begin;
};

Levels levels_from(int start, const Adjacency& adjacency, std::vector<int>& visited_by, int visit)
{
    Levels levels{{start}, {0}};
    visited_by[start] = visit;
    for (std::size_t done = 0; done < levels.order.size();) {
        const std::size_t end = levels.order.size();
        for (; done < end; ++done)
            for (int k = adjacency.first[levels.order[done]]; k < adjacency.first[levels.order[done] + 1]; ++k) {
                const int neighbour = adjacency.neighbour[k];
                if (visited_by[neighbour] == visit) continue;
                visited_by[neighbour] = visit;
                levels.order.push_back(neighbour);
            }
        if (levels.order.size() > end) levels.begin.push_back(static_cast<int>(end));
    }
    return levels;
}

// The order runs from one end to the other: the last vertex reached from any vertex is an end, or close to one.
Levels levels_of_component(int anywhere, const Adjacency& adjacency, std::vector<int>& visited_by, int& visit)
{
    Levels levels = levels_from(anywhere, adjacency, visited_by, ++visit);
    for (int sweep = 0; sweep < 2; ++sweep) levels = levels_from(levels.order.back(), adjacency, visited_by, ++visit);
    return levels;
}

}  // namespace

int vertices_a_slab(int vertices)
{
    constexpr int least_vertices_a_slab = 3072;
    const int slabs = vertices / (4 * least_vertices_a_slab) * 4;
    return slabs == 0 ? std::max(vertices, 1) : vertices / slabs;
}

std::vector<int> VertexOrder::slab_of_new() const
{
    std::vector<int> slab_of(old_of_new.size());
    for (int slab = 0; slab < slabs(); ++slab)
        std::fill(slab_of.begin() + slab_begin[slab], slab_of.begin() + slab_begin[slab + 1], slab);
    return slab_of;
}

VertexOrder order_vertices(const Tets& tets, int vertices, int vertices_a_slab)
{
    const Adjacency adjacency = adjacency_of(tets, vertices);
    std::vector<int> visited_by(vertices, 0);
    int visit = 0;
    VertexOrder order;
    order.slab_begin.push_back(0);
    for (int i = 0, levels_in_slab = 0; i < vertices; ++i) {
        if (visited_by[i] != 0) continue;
        const Levels levels = levels_of_component(i, adjacency, visited_by, visit);
        const int before = static_cast<int>(order.old_of_new.size());
        order.old_of_new.insert(order.old_of_new.end(), levels.order.begin(), levels.order.end());
        for (const int begin : levels.begin) {
            const bool half = order.slab_begin.size() == 1 && vertices >= 2 * vertices_a_slab;
            const int least = half ? vertices_a_slab / 2 : vertices_a_slab;
            if (levels_in_slab >= 2 && before + begin - order.slab_begin.back() >= least) {
                order.slab_begin.push_back(before + begin);
                levels_in_slab = 0;
            }
            ++levels_in_slab;
        }
    }
    if (order.slab_begin.size() > 1 && vertices - order.slab_begin.back() < vertices_a_slab / 3)
        order.slab_begin.pop_back();
    order.slab_begin.push_back(vertices);
    order.new_of_old.resize(vertices);
    for (int i = 0; i < vertices; ++i) order.new_of_old[order.old_of_new[i]] = i;
    return order;
}

VertexOrder breadth_first(const Tets& tets, int vertices)
{
    return order_vertices(tets, vertices, vertices);
}

std::vector<std::vector<int>> vertex_colours(const Tets& tets, int vertices)
{
    const Adjacency adjacency = adjacency_of(tets, vertices);
    std::vector<int> colour_of(vertices, -1);
    std::vector<int> taken_by;  // the vertex that last found each colour among its neighbours
    std::vector<std::vector<int>> colours;
    for (const int vertex : breadth_first(tets, vertices).old_of_new) {
        for (int k = adjacency.first[vertex]; k < adjacency.first[vertex + 1]; ++k)
            if (const int colour = colour_of[adjacency.neighbour[k]]; colour >= 0) taken_by[colour] = vertex;
        std::size_t colour = 0;
        while (colour < colours.size() && taken_by[colour] == vertex) ++colour;
        if (colour == colours.size()) {
            colours.emplace_back();
            taken_by.push_back(-1);
        }
        colours[colour].push_back(vertex);
        colour_of[vertex] = static_cast<int>(colour);
    }
    return colours;
}

}  // namespace pbs
