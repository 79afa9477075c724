// Repairs of a tet mesh from a file that move no tet.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <array>
#include <optional>
#include <vector>

namespace pbs {

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
