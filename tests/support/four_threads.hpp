// Four threads in a test, whatever the number of cores. By default, oneTBB uses no more threads than the machine has cores, so that on two
// cores a test of four threads would run with two.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/batched/batch_program.hpp"

#ifdef PBS_WITH_THREADS
#include <tbb/global_control.h>
#endif

namespace test_support {

#ifdef PBS_WITH_THREADS
inline const tbb::global_control four_threads(tbb::global_control::max_allowed_parallelism, 4);
#endif

// The slabs of a mesh that the packed solvers share among threads.
inline int slabs_of(const pbs::TetMesh& mesh)
{
    const int vertices = static_cast<int>(mesh.rest.rows());
    return pbs::order_vertices(mesh.tets, vertices, pbs::vertices_a_slab(vertices)).slabs();
}

}  // namespace test_support
