// The inner loops of the orders `ordered` and `grouped`, compiled for the machine (PBS_NATIVE): raw pointers only.
// vertices: x, y, z [m] and w, the inverse mass, of each, 16 bytes aligned in float, 32 in double.
#pragma once

#include "pbs/packed/batch.hpp"

namespace pbs {

// Projects `count` batches, Batch<Scalar, kind>, one after the other.
template <typename Scalar>
void project_batches(GroupKind kind, const void* batches, int count, Scalar* vertices);

// Projects the bind constraints of vertices 0 .. 16 count - 1.
template <typename Scalar>
void project_bind_batches(const BindBatch<Scalar>* batches, int count, Scalar* vertices);

// Sum over the constraints of (l / l0 - 1)^2, (V / V0 - 1)^2, and of bind's C^2 [m^2].
template <typename Scalar>
double sum_squared_errors(GroupKind kind, const void* batches, int count, const Scalar* vertices);
// The largest |l / l0 - 1| or |V / V0 - 1| of each group, batch_size a batch; zero for lanes without one.
template <typename Scalar>
void largest_errors(GroupKind kind, const void* batches, int count, const Scalar* vertices, Scalar* errors);
// Residuals of the bind constraints of vertices 0 .. 16 count - 1 [m^2].
template <typename Scalar>
double sum_squared_bind_errors(const BindBatch<Scalar>* batches, int count, const Scalar* vertices);

int kernel_lanes(int bytes_of_scalar);  // numbers that these kernels work on at once
const char* kernel_instructions();      // AVX-512, AVX2, AVX, SSE2, baseline

}  // namespace pbs
