// How far the mesher may be from the skin of the built-in limb, for tolerances. CGAL bisects segments that cross the
// skin until one is shorter than its relative error bound, 1e-9 (experiments/meshes/meshing.cpp), times half the
// diagonal of the cube round the bounding sphere, and takes the middle (Labeled_mesh_domain_3). The sphere's radius is
// 2 m, so that half the diagonal is 2 sqrt 3 m, and the skin lies within half the length of the segment.
#pragma once

#include <cmath>

namespace test_support {

inline const double on_skin_m = std::sqrt(3.0) * 1e-9;

}  // namespace test_support
