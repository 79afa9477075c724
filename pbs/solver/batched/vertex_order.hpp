// The order of the vertices in memory, and the slabs into which a mesh is divided among threads.
// Vertices follow each other breadth-first: by their distance in edges from one end of the mesh (levels), neighbours near
// each other. A slab is a run of whole levels, two at least; a constraint, or a group of them round one edge, belongs to the slab of its
// first vertex and reaches into the next slab at most. So slabs 0, 2, 4 ... share no vertex and neither do 1, 3, 5 ...: either half may be
// worked off in parallel. Slabs belong to the mesh, never to the number of threads, so that every number of threads gives the same bits.
#pragma once

#include "pbs/geometry/types.hpp"

#include <vector>

namespace pbs {

// old: the mesh's numbers of vertices; new: where they lie.
struct VertexOrder {
    // #V, either the other's inverse.
    std::vector<int> old_of_new, new_of_old;  // #V
    std::vector<int> slab_begin;              // first vertex of each slab, in the new order; #slabs + 1

    int slabs() const { return static_cast<int>(slab_begin.size()) - 1; }  // #slabs
    std::vector<int> slab_of_new() const;                                  // #V
};

// A slab has at least `vertices_a_slab` vertices, the first of several half as many, so that where the middle of a body is,
// where its joint often is, no slab ends; a last one of less than a third joins the one before.
VertexOrder order_vertices(const Tets& tets, int vertices, int vertices_a_slab);

}  // namespace pbs
