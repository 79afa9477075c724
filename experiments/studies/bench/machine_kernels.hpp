// Loops that reach a core's limits. They are compiled for the machine as the solver's kernels are (PBS_NATIVE), so they take raw pointers.
#pragma once

#include <cstddef>

namespace experiments {

// Repeats x <- x a + b `rounds` times on enough independent vectors to keep every multiplier busy, from x = start. Returns the number of
// floating-point operations, where a multiply-add counts two. `sum` is the sum of the results, so that the compiler leaves nothing out.
template <typename Scalar>
double multiply_add(std::size_t rounds, Scalar start, Scalar a, Scalar b, Scalar& sum);

// to[i] = from[i] by whole vectors. Both are aligned to 64 bytes, and `count` is a multiple of 64.
void copy_floats(const float* from, float* to, std::size_t count);

// x[i] <- factor x[i] by whole vectors. x is aligned to 64 bytes, and `count` is a multiple of 64.
void scale_floats(float factor, float* x, std::size_t count);

}  // namespace experiments
