// The inner loops of packed XPBD with neo-Hookean constraints, compiled for the machine (PBS_NATIVE): raw pointers only. x: rows x, y, z
// [m] and the inverse mass w [1/m], 64 bytes aligned. See xpbd_neo_hookean.hpp for the equations.
#pragma once

#include "pbs/packed/batch.hpp"

#include <cstdint>

namespace pbs {

// Sixteen tets that share no vertex. A lane without a tet has zeros and dummy vertices of its own.
template <typename Scalar>
struct alignas(64) NeoHookeanBatch {
    std::uint32_t offset[4][batch_size];                     // 4 * row
    Scalar rest_inverse[9][batch_size];                      // by rows [1/m]
    Scalar weighted[6][batch_size];                          // S = sum_i w_i g_i g_i^T: 00 11 22 12 02 01 [1/m^3]
    Scalar hydrostatic[batch_size], deviatoric[batch_size];  // lambda V, mu V [m^3]
    Scalar multiplier[2][batch_size];                        // of C_H, of C_D [m^3]
    Scalar applied[9][batch_size];                           // P by columns [m^3]
};

// The springs of sixteen tets that share no vertex: up to four modes of each (bone_springs.hpp).
template <typename Scalar>
struct alignas(64) HoldBatch {
    std::uint32_t offset[4][batch_size];  // 4 * row
    Scalar v[4][4][batch_size];           // of each mode
    Scalar stiffness[4][batch_size];      // k [m]; zero: no mode
    Scalar share[4][batch_size];          // 1 / (1 + k sum_i w_i v_i^2)
    Scalar target[4][3][batch_size];      // d [m]
    Scalar multiplier[4][3][batch_size];  // [m^2]
};

template <typename Scalar>
void visit_holds(HoldBatch<Scalar>* batches, int count, Scalar* x);
template <typename Scalar>
void visit_tets(NeoHookeanBatch<Scalar>* batches, int count, Scalar alpha, bool with_residual, Scalar* x);

// A step begins: predicted = x + momentum (x - before), before = x, x = predicted + applied.
template <typename Scalar>
void begin_step(Scalar momentum, int rows, Scalar* x, Scalar* before, Scalar* predicted, const Scalar* applied);
// A step ends: applied = x - predicted. Returns sum_i (applied_i / w_i) . (x_i - before_i): the work of the forces, over Young's modulus.
template <typename Scalar>
double end_step(int rows, const Scalar* x, const Scalar* before, const Scalar* predicted, Scalar* applied);

}  // namespace pbs
