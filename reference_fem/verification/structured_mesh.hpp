// Meshes of boxes, bent and joined to the shapes of the benchmarks: no mesher, so that every run has the same tets.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace reference_fem {

using Divisions = std::array<int, 3>;  // cells along x, y, z

std::string text_of(const Divisions& divisions);  // 48 x 6 x 6

// A box of cells, each split into six tets about one diagonal (Kuhn). Corners [m].
pbs::TetMesh box_mesh(const pbs::Vec3& lower, const pbs::Vec3& upper, const Divisions& divisions);

// The unit cube of n^3 cells, its inner vertices moved at random by up to half of `share` of a cell along each axis.
pbs::TetMesh jittered_cube(int n, double share);

// Every vertex moved to map(vertex). Where the map mirrors a tet, two of its corners change places.
pbs::TetMesh mapped(pbs::TetMesh mesh, const std::function<pbs::Vec3(const pbs::Vec3&)>& map);

// One mesh of all; vertices closer than 1e-7 m are one.
pbs::TetMesh joined(const std::vector<pbs::TetMesh>& meshes);

}  // namespace reference_fem
