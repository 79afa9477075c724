// The inner loop of packed projective dynamics, compiled for the machine (PBS_NATIVE): raw pointers only. See flesh_kernels.hpp for rows.
#pragma once

#include "pbs/packed/batch.hpp"

#include <cstdint>

namespace pbs {

// Sixteen tets that share no vertex; see ProjectiveTet. A lane without a tet has zeros and dummy vertices of its own.
template <typename Scalar>
struct alignas(64) ProjectiveBatch {
    std::uint32_t offset[4][batch_size];  // 4 * row
    Scalar inverse_edges[9][batch_size];  // from row to row [1/m]
    Scalar volume[batch_size];            // at rest [m^3]
    Scalar w[6][batch_size];              // of the springs on the edges 01 02 03 12 13 23 [m]
};

// Adds the gradient of `count` batches and returns their energy. strain, volume: ProjectiveWeights. Tets whose local shapes the formulae
// refuse get the part of their springs alone; their places, 16 batch + lane, are written to `refused`, and their number is added to
// refused_count.
template <typename Scalar>
double add_gradient_of_projective_tets(const ProjectiveBatch<Scalar>* batches, int count, Scalar strain, Scalar volume, const Scalar* x,
                                       Scalar* gradient, int* refused, int* refused_count);

}  // namespace pbs
