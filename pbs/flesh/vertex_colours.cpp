#include "pbs/packed/vertex_order.hpp"

#include "pbs/geometry/topology.hpp"

namespace pbs {

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
