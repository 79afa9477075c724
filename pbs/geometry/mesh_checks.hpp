// The conditions on a tet mesh before anything is computed on it; each violation is an InputError naming the file, the vertex or tet, its
// value and the rule. Vertices and tets are counted from 0, as in VTK.
#pragma once

#include "pbs/geometry/mesh_io.hpp"
#include "pbs/geometry/tet_mesh.hpp"

#include <array>
#include <optional>
#include <vector>

namespace pbs {

// At least one tet, indices in range, coordinates finite and within 1e9 m, so that volumes are finite too.
void check_frame(const std::string& path, const TetMesh& mesh);

// check_frame, and: not smaller than 1e-9 m, no tet without volume, no two vertices in one place, no face in three tets,
// no overlap of neighbours, boundary manifold and, in a build with CGAL, free of self-intersections. Repaired by mesh_checks.hpp; the
// orientation is normalised by swapping the last two vertices.
MeshReading check_rest(const std::string& path, TetMesh mesh);

// Repairs of a tet mesh from a file that move no tet.
struct RepairedMesh {
    TetMesh mesh;
    std::vector<int> file_vertex;  // the vertex of the file that each vertex comes from, #V
    std::vector<int> unused;       // vertices of the file that no tet uses: left out
    std::vector<int> split;        // vertices of the file at which parts touch that share no face there: each part got one of its own
};

// Indices in range (unchecked). Where parts touch in an edge whose ends are joined by other tets, the boundary stays not manifold.
RepairedMesh repaired(const TetMesh& mesh);

// An edge that is in more than two triangles of the boundary; nothing where there is none.
std::optional<std::array<int, 2>> edge_that_is_not_manifold(const Tets& tets);

}  // namespace pbs
