// The connectivity of a tet mesh: edges, boundary, manifoldness, Euler characteristic. vertices: #V; indices of tets lie from 0 to
// #V - 1 (unchecked).
#pragma once

#include "pbs/geometry/types.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace pbs {

Edges edges_of(const Tets& tets);                                              // each edge once, sorted, #E x 2
Triangles boundary_of(const Tets& tets);                                       // faces of one tet only, oriented outward, #F x 3
std::vector<bool> boundary_vertices(const Tets& tets, Eigen::Index vertices);  // whether a vertex is in one of boundary_of's faces, #V

// Neighbours of vertex i by edges: first[i] .. first[i + 1] - 1 of `neighbour`.
struct Adjacency {
    // #V + 1.
    std::vector<int> first, neighbour;  // vertex indices, 2 #E, those of a vertex ascending
};
// Counted over all vertices, including those without a tet.
Adjacency adjacency_of(const Tets& tets, int vertices);

// The triangles with each corner replaced by the first point at its place. Files of models repeat points along texture seams.
Triangles joined_triangles(const Positions& points, const Triangles& triangles);

// An edge with its direction in a triangle.
using DirectedEdge = std::pair<int, int>;
// The smallest edge, sorted by vertices, that the triangles do not use equally often in both directions; nothing: there is none.
std::optional<DirectedEdge> open_edge(const Triangles& triangles);
bool is_closed(const Triangles& triangles);      // has a triangle and no open edge; several parts may touch in an edge
bool is_watertight(const Triangles& triangles);  // closed, and each edge belongs to two triangles

// Topology of the tets and their boundary; one manifold component with Euler number 2 is a ball.
struct Topology {
    // Every boundary edge in two triangles, every boundary vertex in one fan, every face in at most two tets.
    bool boundary_manifold = false;
    int boundary_components = 0;  // of boundary triangles, over shared edges
    int boundary_euler = 0;       // V - E + F of the boundary; 2 for a ball
    int components = 0;           // of the tets, over shared faces
    int unused_vertices = 0;      // that no tet names
};
// Without a tet the boundary is manifold, by the letter, and all counts but unused_vertices are zero.
Topology topology_of(const Tets& tets, Eigen::Index vertices);

}  // namespace pbs
