// The inner loops of the packed solvers of this folder, compiled for the machine (PBS_NATIVE): raw pointers only. A row
// of an array is four numbers: x, y, z and one more. Arrays are 64 bytes aligned.
#pragma once

#include "pbs/packed/batch.hpp"

#include <cstddef>
#include <cstdint>
#include <type_traits>

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

// Columns of a Cholesky factor with the same rows below them. Its values are the triangle by rows, with the reciprocal
// of each diagonal entry, and then `width` values for each row below.
inline constexpr int widest_supernode = 8;
struct Supernode {
    int column, width, rows_below;
    std::size_t first_below, first_value;
};
// Solves L L^T x = b in place. place: 4 * row of each row of L. work: rows + 1 rows.
template <typename Scalar>
void solve_supernodes(const Supernode* nodes, int count, const std::uint32_t* below, const Scalar* values,
                      const std::uint32_t* place, int rows, Scalar* b, Scalar* work);

// Columns of a Cholesky factor L of 3 x 3 blocks and the rows below them, L = [L_1; L_2], as the panel P = [L_1^-1;
// -L_2 L_1^-1]. With it both substitutions are products of a matrix with a vector. A block of rows is four numbers, the
// last of them zero. A solve takes as long as reading the values: for float a word has those of two columns, as the
// upper halves of float numbers (bfloat16), since the first matrix of a quasi-Newton method may be that coarse. Values
// are stored by columns, or pairs of columns, of 4 * blocks; a last odd column has a partner of zeros.
template <typename Scalar>
using PanelValue = std::conditional_t<std::is_same_v<Scalar, float>, std::uint32_t, Scalar>;
inline constexpr int widest_panel = 48;    // columns, a multiple of 6
inline constexpr int blocks_together = 4;  // the number of blocks is a multiple
struct Panel {
    int column_blocks;  // blocks of the columns themselves, which are the first blocks of rows
    int blocks;  // of all rows; those that fill up the multiple are the dummy behind the last block of the matrix
    std::size_t first_block, first_value;

    int columns() const { return (3 * column_blocks + 1) / 2 * 2; }  // an even number
};
// Solves L L^T x = b in place for one right-hand side. block: 4 * block of each block of rows of the panels. work:
// blocks, and the dummy, which is zero. scratch: room for the most blocks of a panel.
template <typename Scalar>
void solve_panels(const Panel* panels, int count, const std::uint32_t* block, const PanelValue<Scalar>* values,
                  Scalar* work, Scalar* scratch);

// turned_k = R_k^T rows_k, and rows_k = R_k turned_k, for the vertices k. rotations: three columns of four numbers each
// per vertex. place: 4 * row of each vertex.
template <typename Scalar>
void turn_back(const Scalar* rotations, const std::uint32_t* place, int vertices, const Scalar* rows, Scalar* turned);
template <typename Scalar>
void turn(const Scalar* rotations, const std::uint32_t* place, int vertices, const Scalar* turned, Scalar* rows);

// The kernel of projective dynamics follows.

// Sixteen tets that share no vertex; see ProjectiveTet. A lane without a tet has zeros and dummy vertices of its own.
template <typename Scalar>
struct alignas(64) ProjectiveBatch {
    std::uint32_t offset[4][batch_size];  // 4 * row
    Scalar inverse_edges[9][batch_size];  // from row to row [1/m]
    Scalar volume[batch_size];            // at rest [m^3]
    Scalar w[6][batch_size];              // of the springs on the edges 01 02 03 12 13 23 [m]
};

// Adds the gradient of `count` batches and returns their energy. strain, volume: ProjectiveWeights. Tets whose local
// shapes the formulae refuse get the part of their springs alone; their places, 16 batch + lane, are written to
// `refused`, and their number is added to refused_count.
template <typename Scalar>
double add_gradient_of_projective_tets(const ProjectiveBatch<Scalar>* batches, int count, Scalar strain, Scalar volume,
                                       const Scalar* x, Scalar* gradient, int* refused, int* refused_count);

// The kernels of vertex block descent follow.

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
void move_vertices(const VertexBatch<Scalar>* batches, int count, const VertexIncidence<Scalar>* incidences,
                   const Scalar* centres, Scalar omega, Scalar* x);

// x = before + omega (x - before), `rows` a multiple of 16.
template <typename Scalar>
void extrapolate(Scalar omega, const Scalar* before, int rows, Scalar* x);

// XPBD with neo-Hookean constraints (xpbd_neo_hookean.hpp). x: rows x, y, z [m] and the inverse mass w [1/m].

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
// A step ends: applied = x - predicted. Returns sum_i (applied_i / w_i) . (x_i - before_i): the work of the forces,
// over Young's modulus.
template <typename Scalar>
double end_step(int rows, const Scalar* x, const Scalar* before, const Scalar* predicted, Scalar* applied);

}  // namespace pbs
