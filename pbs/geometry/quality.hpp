// How good a tet mesh is.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

#include <array>
#include <string>

namespace pbs {

// Angles [deg] between the faces that meet at each edge: 12, 13, 14, 23, 24, 34; in [0, 180], 0 and 180 where the tet is flat.
std::array<double, 6> dihedral_angles_deg(const Vec3& p1, const Vec3& p2, const Vec3& p3, const Vec3& p4);

// Quality of the rest pose. Without a tet everything except `vertices` and `topology` is zero.
struct Quality {
    // #V; #E, each edge once; #T; #F of boundary_of.
    int vertices = 0, edges = 0, tets = 0, boundary_triangles = 0, boundary_vertices = 0;  // those in a boundary face
    double volume_m3 = 0.0;  // signed, so that an inverted tet counts against the others
    // Least of all tets' dihedral angles, in [0, 180]; 0: a flat tet.
    double min_dihedral_deg = 0.0, max_dihedral_deg = 0.0;  // largest of them, in [0, 180]; 180: a flat tet
    // Length of the shortest edge.
    double shortest_edge_m = 0.0, longest_edge_m = 0.0;  // length of the longest edge
    Topology topology;                                   // of tets and boundary
};
// Indices of tets are in range (unchecked).
Quality quality_of(const TetMesh& mesh);
std::string describe(const Quality& quality);  // three lines for the terminal, with units

}  // namespace pbs
