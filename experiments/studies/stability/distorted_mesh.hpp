// A good mesh made bad on purpose: some vertices are moved so that a tet at each is thin, and no tet is turned inside out.
//   const pbs::TetMesh spoilt = distorted(mesh, Defect::slivers, 1e-4);
#pragma once

#include "experiments/studies/stability/stability_cell.hpp"
#include "pbs/geometry/tet_mesh.hpp"

namespace experiments {

// slivers: a vertex keeps the share `thinness` of its height over the opposite face of one tet; needles: of the length of one edge. A
// twentieth of the vertices, no two of a tet; those that would turn a tet inside out are passed over. Seeded.
pbs::TetMesh distorted(const pbs::TetMesh& mesh, Defect defect, double thinness);

}  // namespace experiments
