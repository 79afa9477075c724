// The connectivity of a tet mesh: edges, boundary, manifoldness, Euler characteristic. vertices: #V; indices of tets
// lie from 0 to #V - 1 (unchecked).
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <array>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pbs {

Edges edges_of(const Tets& tets);  // each edge once, sorted, #E x 2
// faces of one tet only, oriented outward, #F x 3
Triangles boundary_of(const Tets& tets);
// whether a vertex is in one of boundary_of's faces, #V
std::vector<bool> boundary_vertices(const Tets& tets, Eigen::Index vertices);

// Neighbours of vertex i by edges: first[i] .. first[i + 1] - 1 of `neighbour`.
struct Adjacency {
    // #V + 1, of all vertices, including those without a tet; 2 #E, those of a vertex ascending
    std::vector<int> first, neighbour;
};
Adjacency adjacency_of(const Tets& tets, int vertices);

// The triangles with each corner replaced by the first point at its place. Files of models repeat points along texture
// seams.
Triangles joined_triangles(const Positions& points, const Triangles& triangles);

// The vertices that the cells use, ascending, after which the cells name them by their places among these.
template <typename Cells>
std::vector<int> renumbered(Cells& cells, Eigen::Index vertices)
{
    std::vector<int> used, place(static_cast<std::size_t>(vertices), -1);
    for (const int vertex : cells.reshaped()) place[static_cast<std::size_t>(vertex)] = 0;
    for (std::size_t v = 0; v < place.size(); ++v) {
        if (place[v] < 0) continue;
        place[v] = static_cast<int>(used.size());
        used.push_back(static_cast<int>(v));
    }
    for (int& vertex : cells.reshaped()) vertex = place[static_cast<std::size_t>(vertex)];
    return used;
}

// A face of a tet: its vertices, ascending, and whether they are an even permutation of its outward order.
struct TetFace {
    std::array<int, 3> sorted;
    int tet, face;  // opposite to corner `face` of the tet
    bool even;
};
std::vector<TetFace> sorted_faces(const Tets& tets);  // of all tets, by their vertices and then by their tets

// An edge with its direction in a triangle.
using DirectedEdge = std::pair<int, int>;
// The smallest edge, sorted by vertices, that the triangles do not use equally often in both directions; nothing: there
// is none.
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
// Without a tet the boundary is manifold, by the letter, and all counts except unused_vertices are zero.
Topology topology_of(const Tets& tets, Eigen::Index vertices);

// The part of each tet, from 0 in the order of first tets, #T. Tets belong together if they share a face.
std::vector<int> parts_of(const Tets& tets);

// The tets for which `kept` is true, #T, and the vertices that they use, in their order.
TetMesh kept_tets(const TetMesh& mesh, const std::vector<bool>& kept);

// Angles [deg] between the faces that meet at each edge: 12, 13, 14, 23, 24, 34; in [0, 180], 0 and 180 where the tet
// is flat.
std::array<double, 6> dihedral_angles_deg(const Vec3& p1, const Vec3& p2, const Vec3& p3, const Vec3& p4);

// Quality of the rest pose. Without a tet everything except `vertices` and `topology` is zero.
struct Quality {
    int vertices = 0, edges = 0, tets = 0;              // #V; #E, each edge once; #T
    int boundary_triangles = 0, boundary_vertices = 0;  // #F of boundary_of; those in a boundary face
    double volume_m3 = 0.0;                             // signed, so that an inverted tet counts against the others
    double min_dihedral_deg = 0.0,
           max_dihedral_deg = 0.0;  // of all tets' dihedral angles, in [0, 180]; 0 and 180: a flat tet
    double shortest_edge_m = 0.0, longest_edge_m = 0.0;
    Topology topology;  // of tets and boundary
};
// Indices of tets are in range (unchecked).
Quality quality_of(const TetMesh& mesh);
std::string describe(const Quality& quality);  // three lines for the terminal, with units

// Numbers from 0, united into classes: union-find with path halving.
class Classes {
public:
    explicit Classes(std::size_t members) : parent_(members) { std::iota(parent_.begin(), parent_.end(), 0); }

    int find(int member)
    {
        while (parent_[member] != member) member = parent_[member] = parent_[parent_[member]];
        return member;
    }
    void unite(int first, int second) { parent_[find(first)] = find(second); }
    int count()
    {
        int roots = 0;
        for (int member = 0; member < static_cast<int>(parent_.size()); ++member) roots += find(member) == member;
        return roots;
    }

private:
    std::vector<int> parent_;
};

}  // namespace pbs
