// The work of one iteration of the methods for elastic flesh, counted by hand from flesh_kernels.cpp, projective_dynamics_kernels.cpp,
// vbd_kernels.cpp and xpbd_neo_hookean_kernels.cpp by the rules of iteration_work.hpp.
//   const IterationWork work = work_of_quasi_newton({vertices, edges, tets, {entries_of_factor}}, sizeof(float), 5);
#pragma once

#include "pbs/geometry/iteration_work.hpp"

namespace pbs {

// One evaluation, one solve, and the vector operations of L-BFGS with all `history` pairs; a step that is shortened takes more. entries: of
// the factor.
IterationWork work_of_quasi_newton(const BodyCounts& body, double scalar_bytes, int history);

// One local and one global step. entries: of the factor.
IterationWork work_of_projective_dynamics(const BodyCounts& body, double scalar_bytes);
// The part of a tet that its local shapes take: rotation_formula::nearest and local_shape_formula, which evaluates y_1 y_2 y_3 this often.
// Stretches of up to a tenth need two evaluations in float and three in double.
double flops_of_local_shapes(int evaluations);

// One sweep over all vertices. chebyshev: with the extrapolation after it.
IterationWork work_of_vertex_sweep(const BodyCounts& body, double scalar_bytes, bool chebyshev);

// One visit of all springs and tets. with_residual: where multipliers are kept over the steps. iterations_per_step: over which the work of
// the beginning and the end of a step is shared. entries: modes of the springs.
IterationWork work_of_neo_hookean_xpbd(const BodyCounts& body, double scalar_bytes, bool with_residual, int iterations_per_step);

}  // namespace pbs
