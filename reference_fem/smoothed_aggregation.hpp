// How Trilinos ML builds its hierarchy for elasticity: P. Vanek, J. Mandel, M. Brezina, Algebraic multigrid by smoothed aggregation for
// second and fourth order elliptic problems, Computing 56, 1996.
#pragma once

#include <Teuchos_ParameterList.hpp>

namespace reference_fem {

// `modes`: near-null space on this rank's rows, column after column, #rows x #modes; outlives the set-up. `block_size`: 3 where whole
// nodes are contiguous, 1 otherwise.
Teuchos::ParameterList smoothed_aggregation(double* modes, int number_of_modes, int block_size);

}  // namespace reference_fem
