// What a tet mesh's connectivity says: edges, boundary, manifoldness, Euler characteristic.
#pragma once

#include "pbs/geometry/types.hpp"

#include <vector>

namespace pbs {

Edges edges_of(const Tets& tets);                                              // each edge once, sorted, #E x 2
Triangles boundary_of(const Tets& tets);                                       // faces of one tet only, oriented outward, #F x 3
std::vector<bool> boundary_vertices(const Tets& tets, Eigen::Index vertices);  // #V

// Neighbours of vertex i by edges: first[i] .. first[i + 1] - 1 of `neighbour`.
struct Adjacency {
    std::vector<int> first, neighbour;
};
Adjacency adjacency_of(const Tets& tets, int vertices);

struct Topology {
    // Every boundary edge in two triangles, every boundary vertex in one fan, every face in at most two tets.
    bool boundary_manifold = false;
    int boundary_components = 0;
    int boundary_euler = 0;  // V - E + F of the boundary; 2 for a ball
    int components = 0;      // of the tets, over shared faces
    int unused_vertices = 0;
};
Topology topology_of(const Tets& tets, Eigen::Index vertices);

}  // namespace pbs
