// The layout that the packed solvers of this folder have in common: the tets of each slab of the mesh, and the rows of vertices and
// dummies.
#pragma once

#include "pbs/packed/batch.hpp"
#include "pbs/packed/vertex_order.hpp"

#include <array>
#include <vector>

namespace pbs {

inline constexpr int dummies_of_slab = 4 * batch_size;

// Rows of `vertices` in whole batches and, behind them, of the dummies of each slab.
int rows_with_dummies(int vertices, int slabs);

// vertex: of each tet. Returns indices of the tets of each slab; a tet belongs to the slab of the first of its vertices in memory. Within a
// slab, clusters of neighbours follow each other, and each cluster goes colour by colour (groups.hpp), so that BatchScheduler
// fills its batches.
std::vector<std::vector<int>> slabs_of_tets(const std::vector<std::array<int, 4>>& vertex, const VertexOrder& order);

}  // namespace pbs
