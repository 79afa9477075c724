// The work of one iteration of XPBD, counted by hand from xpbd_solver.cpp by the rules of iteration_work.hpp. A quantity that the
// code computes twice, once for the value and once for the gradient, counts once.
#pragma once

#include "pbs/geometry/iteration_work.hpp"

namespace pbs {

// has_volumes: false where Poisson's ratio is 1/4, which needs no volume constraints. scalar_bytes: 4 in float, 8 in double.
IterationWork work_of_xpbd(const BodyCounts& body, bool has_volumes, double scalar_bytes);

}  // namespace pbs
