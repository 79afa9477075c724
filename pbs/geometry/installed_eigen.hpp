// Included first in programs that use an installed pbs (its targets require it). Eigen aligns what it allocates by the
// widest registers it is compiled for, and an array that the library allocates is freed by the program, or the other
// way round: both have to be compiled for the same alignment. The library is compiled for 16 bytes; only its kernels
// know more, behind raw pointers. EIGEN_MAX_ALIGN_BYTES=16 does not bring the two together: with -mavx Eigen 3.4 still
// allocates by 32 bytes, which its products rely on.
#pragma once

#include <Eigen/Core>

static_assert(EIGEN_DEFAULT_ALIGN_BYTES == 16,
              "pbs was built with Eigen's alignment of 16 bytes: compile what uses it without -mavx, "
              "-mavx512f or -march=native, or build pbs with the same CMAKE_CXX_FLAGS and without this line");
