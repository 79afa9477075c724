// A division of a mesh's tets into connected regions of about equal size, the same on every machine.
//   const std::vector<int> region = tet_regions(tets, 256);
//   const std::vector<Triangles> surfaces = region_surfaces(tets, region);
// Greedy growing (C. Farhat, A simple and efficient automatic FEM domain decomposer, Computers and Structures 28, 1988): a region begins at
// the first tet, in breadth-first order over shared faces, that has no region yet, and takes neighbours breadth-first until it is full.
// A part that is cut off with less than half of the size joins the region to which it has most faces, so that a region may be larger.
#pragma once

#include "pbs/geometry/types.hpp"

#include <vector>

namespace pbs {

// The region of each tet, #T; regions are numbered from 0 in the order in which they begin. region_size: in tets, 1 or more (unchecked). A
// connected part of fewer tets than half of that, connected over faces, is a region of its own.
std::vector<int> tet_regions(const Tets& tets, int region_size);

// The surface of each region, oriented outward, #regions; region: #T, numbers from 0 without gaps.
std::vector<Triangles> region_surfaces(const Tets& tets, const std::vector<int>& region);

}  // namespace pbs
