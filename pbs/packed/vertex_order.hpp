// The order of the vertices in memory, and the slabs into which a mesh is divided among threads.
// Vertices follow each other breadth-first: by their distance in edges from one end of the mesh (levels), neighbours
// near each other. A slab is a run of whole levels, two at least; a constraint, or a group of them round one edge,
// belongs to the slab of its first vertex and reaches into the next slab at most. So slabs 0, 2, 4 ... share no vertex
// and neither do 1, 3, 5 ...: either half may be worked off in parallel. Slabs belong to the mesh, never to the number
// of threads, so that every number of threads gives the same bits.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <vector>

namespace pbs {

// The size of the slabs of a mesh: about four of them and a half at either end, or eight ..., which two threads share
// evenly; or one. Fewer slabs are nearer to `plain`.
int vertices_a_slab(int vertices);
// Fewer slabs than these are done before a second thread has come to help.
inline constexpr int slabs_worth_threads = 3;

// old: the mesh's numbers of vertices; new: their places in memory.
struct VertexOrder {
    std::vector<int> old_of_new, new_of_old;  // each the other's inverse, #V
    std::vector<int> slab_begin;              // first vertex of each slab, in the new order; #slabs + 1

    int slabs() const { return static_cast<int>(slab_begin.size()) - 1; }
    std::vector<int> slab_of_new() const;  // #V
};

// A slab has at least `vertices_a_slab` vertices, the first of several half as many, so that where the middle of a body
// is, where its joint often is, no slab ends; a last one of less than a third joins the one before.
VertexOrder order_vertices(const Tets& tets, int vertices, int vertices_a_slab);

VertexOrder breadth_first(const Tets& tets, int vertices);  // one slab

// The vertices of each colour, in breadth-first order. Two vertices of one tet never have the same colour, so that all
// vertices of a colour may move at once. Greedy in that order: each vertex gets the first colour that none of its
// neighbours has.
//   for (const std::vector<int>& colour : vertex_colours(tets, vertices)) ...
std::vector<std::vector<int>> vertex_colours(const Tets& tets, int vertices);

}  // namespace pbs
