// Loops that reach a core's limits, compiled for the machine as the solver's kernels are (PBS_NATIVE): raw pointers only.
#pragma once

#include <cstddef>

namespace experiments {

// `rounds` times x <- x a + b on enough independent vectors to keep every multiplier busy, from x = start; returns the floating-point
// operations done, a multiply-add counting two. The results' sum goes to `sum`, so that nothing is left out.
template <typename Scalar>
double multiply_add(std::size_t rounds, Scalar start, Scalar a, Scalar b, Scalar& sum);

// to[i] = from[i] by whole vectors, 64 bytes aligned; `count` floats, a multiple of 64.
void copy_floats(const float* from, float* to, std::size_t count);

}  // namespace experiments
