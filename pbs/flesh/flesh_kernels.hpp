// The inner loops of the packed solvers of this folder, compiled for the machine (PBS_NATIVE): raw pointers only. A row of an array is four
// numbers: x, y, z and one more. Arrays are 64 bytes aligned.
#pragma once

#include "pbs/packed/batch.hpp"

#include <cstddef>
#include <cstdint>

namespace pbs {

// Sixteen tets that share no vertex; see FleshEnergy. A lane without a tet has zeros and dummy vertices of its own.
template <typename Scalar>
struct alignas(64) FleshBatch {
    std::uint32_t offset[4][batch_size];  // 4 * row
    Scalar w[6][batch_size];              // of the edges 01 02 03 12 13 23 [m]
    Scalar kappa[batch_size];             // [1/m^3]
    Scalar d[batch_size];                 // [m^3]
};

// Sets the gradient of the hold, a_i (x_i - c_i), and returns its energy. centres: rows c_i and a_i.
template <typename Scalar>
double set_gradient_of_hold(const Scalar* centres, int rows, const Scalar* x, Scalar* gradient);
// Adds the gradient of `count` batches and returns their energy.
template <typename Scalar>
double add_gradient_of_tets(const FleshBatch<Scalar>* batches, int count, const Scalar* x, Scalar* gradient);

// Vectors of 4 * rows numbers, `rows` a multiple of 16. The sum of products goes on in double every 256 numbers.
template <typename Scalar>
double dot(const Scalar* a, const Scalar* b, int rows);
template <typename Scalar>
void add(Scalar factor, const Scalar* a, int rows, Scalar* to);  // to += factor * a

// Columns of a Cholesky factor with the same rows below them. Its values are the triangle by rows, with the reciprocal of each diagonal
// entry, and then `width` values for each row below.
inline constexpr int widest_supernode = 8;
struct Supernode {
    int column, width, rows_below;
    std::size_t first_below, first_value;
};
// Solves L L^T x = b in place. place: 4 * row of each row of L. work: rows + 1 rows.
template <typename Scalar>
void solve_supernodes(const Supernode* nodes, int count, const std::uint32_t* below, const Scalar* values, const std::uint32_t* place,
                      int rows, Scalar* b, Scalar* work);

}  // namespace pbs
