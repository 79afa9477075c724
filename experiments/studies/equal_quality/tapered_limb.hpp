// A limb that tapers, of 2,025 vertices and 9,216 tets on a regular grid: the body on which the order of projection matters most. The
// bodies of the mesher list their tets in no particular order; here the file order is a sweep through the body.
//   (======______)    x from -1 to 1 m, radius from 0.24 to 0.12 m, bones as those of the limb: o=====o=====o
#pragma once

#include "pbs/character/character.hpp"

namespace experiments {

// 25 layers of 9 x 9 vertices; each cube is cut into six tets along a diagonal. Weights by Eq. 2.
pbs::Character tapered_limb();

}  // namespace experiments
