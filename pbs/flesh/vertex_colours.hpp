// Colours of vertices: two vertices of one tet never have the same colour, so that all vertices of a colour may move at once.
//   for (const std::vector<int>& colour : vertex_colours(tets, vertices)) ...
#pragma once

#include "pbs/packed/vertex_order.hpp"

#include <vector>

namespace pbs {

VertexOrder breadth_first(const Tets& tets, int vertices);  // one slab

// The vertices of each colour, in breadth-first order. Greedy in that order: each vertex gets the first colour that none of its neighbours
// has.
std::vector<std::vector<int>> vertex_colours(const Tets& tets, int vertices);

}  // namespace pbs
