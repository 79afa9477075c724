// A good mesh made bad on purpose: some vertices are moved so that a tet at each becomes thin, without inverting any tet.
//   const pbs::TetMesh spoilt = distorted(mesh, Defect::slivers, 1e-4);
#pragma once

#include "experiments/studies/stability/stability_cell.hpp"
#include "pbs/geometry/tet_mesh.hpp"

namespace experiments {

// slivers: a vertex keeps the share `thinness` of its height over the opposite face of one tet. needles: it keeps that share of the length
// of one edge. A seeded twentieth of the vertices is moved, no two of the same tet. Vertices that would invert a tet are skipped.
pbs::TetMesh distorted(const pbs::TetMesh& mesh, Defect defect, double thinness);

}  // namespace experiments
