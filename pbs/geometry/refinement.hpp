// Uniform red refinement: every tet into eight, every edge halved; the body stays the same polyhedron.
//   const Refinement fine = refine(mesh);                            // fine.mesh: the vertices of `mesh` first, then the midpoints
//   const Positions carried = prolongated(positions, fine.parents);  // a field of the coarse vertices on the fine ones
// The four tets at the corners are similar to their parent. The octahedron between them is cut along its shortest diagonal (of equal ones
// the first of 01-23, 02-13, 03-12, numbers being the parent's corners; S. Zhang, Houston Journal of Mathematics 21, 1995; A. Liu and
// B. Joe, Mathematics of Computation 65, 1996), which bounds the mean ratio of its four tets, 12 (3 V)^(2/3) over the sum S of squared
// edges, from below by 3/4 of their parent's: of the parent's edges they have five, halved, and the diagonal, and the squares of the three
// diagonals sum to S / 4. Bey's rule (Computing 55, 1995), always 02-13, has three shapes in all but may begin with a long diagonal.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

namespace pbs {

// A refined mesh and where its vertices come from.
struct Refinement {
    TetMesh mesh;   // tets 8 t .. 8 t + 7 are the children of tet t, oriented as it is; child k < 4 lies at its corner k, which it keeps
    Edges parents;  // the two coarse vertices that new vertex #V_coarse + e lies between: each coarse edge once, sorted
};
// 8 #T tets and #V + #E vertices; positively oriented tets stay so, and their volumes add up. Indices are in range (unchecked).
Refinement refine(const TetMesh& mesh);

// A field of the coarse vertices, #V x 3, and at the new ones the mean of their parents: linear on every coarse tet. #V + #E
// rows; that the edges are those of the field's vertices is not checked.
Positions prolongated(const Positions& coarse, const Edges& parents);

}  // namespace pbs
