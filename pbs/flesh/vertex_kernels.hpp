// The inner loop of packed vertex block descent, compiled for the machine (PBS_NATIVE): raw pointers only. A row of an array is four
// numbers: x, y, z and one more. Arrays are 64 bytes aligned.
#pragma once

#include "pbs/packed/batch.hpp"

#include <cstddef>
#include <cstdint>

namespace pbs {

// Sixteen vertices that share no tet. A lane without a vertex has a dummy row of its own and the diagonal 0.
template <typename Scalar>
struct alignas(64) VertexBatch {
    std::uint32_t offset[batch_size];  // 4 * row
    Scalar diagonal[batch_size];       // see VertexStar [m]
    std::size_t first = 0;             // of its incidences
    int count = 0;                     // of them: the largest number of tets at one of the vertices
};

// A tet at each of sixteen vertices; see IncidentTet. A lane without a tet has zeros, and its own vertex three times.
template <typename Scalar>
struct alignas(64) VertexIncidence {
    std::uint32_t other[3][batch_size];  // 4 * row
    Scalar w[3][batch_size];             // [m]
    Scalar kappa[batch_size];            // [1/m^3]
    Scalar d[batch_size];                // [m^3]
};

// x_i -= omega H_i^-1 g_i for the vertices of `count` batches (vbd.hpp). centres: rows c_i and a_i.
template <typename Scalar>
void move_vertices(const VertexBatch<Scalar>* batches, int count, const VertexIncidence<Scalar>* incidences, const Scalar* centres,
                   Scalar omega, Scalar* x);

// x = before + omega (x - before), `rows` a multiple of 16.
template <typename Scalar>
void extrapolate(Scalar omega, const Scalar* before, int rows, Scalar* x);

}  // namespace pbs
