// Inner loops of the blends on raw arrays, compiled for the present machine; blend.hpp calls them. Scalar is float or double.
//   rest, posed: points [m], n x 3, that do not overlap; one number behind the last rest point is read as well, and not used
#pragma once

namespace pbs {

// v' = c_0 x + c_1 y + c_2 z + t: the columns c_0, c_1, c_2, t of a rigid or blended transform, padded to four numbers each.
template <class Scalar>
struct alignas(64) PaddedMatrix {
    Scalar numbers[16];  // column by column; the fourth of each is not used
};

// Real and dual part as x, y, z, w.
template <class Scalar>
struct alignas(8 * sizeof(Scalar)) PackedDualQuaternion {
    Scalar numbers[8];  // real x, y, z, w, then dual
};

// n rows of weights, sparse in bones: row i blends the transforms `transform[k]` with `weight[k]`, first[i] <= k < first[i + 1].
template <class Scalar>
struct BlendRows {
    int n;                 // 0 or more
    const int* first;      // n + 1
    const int* transform;  // #entries
    const Scalar* weight;  // #entries
};

// No blending: all points by one matrix, or point i by matrix transform[i].
template <class Scalar>
void transform_points(int n, const PaddedMatrix<Scalar>& matrix, const Scalar* rest, Scalar* posed);
// Every point has its own matrix.
template <class Scalar>
void transform_points(int n, const int* transform, const PaddedMatrix<Scalar>* matrices, const Scalar* rest, Scalar* posed);

// Every point has its own row of weights.
template <class Scalar>
void blend_points(const BlendRows<Scalar>& rows, const PaddedMatrix<Scalar>* matrices, const Scalar* rest, Scalar* posed);
// The same for dual quaternions, each with the sign that agrees with the heaviest of its row (TurnedBone).
template <class Scalar>
void blend_points(const BlendRows<Scalar>& rows, const PackedDualQuaternion<Scalar>* dual_quaternions, const Scalar* rest, Scalar* posed);

// The blended transforms themselves, one per row.
template <class Scalar>
void blend_matrices(const BlendRows<Scalar>& rows, const PaddedMatrix<Scalar>* matrices, PaddedMatrix<Scalar>* blended);
// The same for dual quaternions; the results are rigid.
template <class Scalar>
void blend_matrices(const BlendRows<Scalar>& rows, const PackedDualQuaternion<Scalar>* dual_quaternions, PaddedMatrix<Scalar>* blended);

}  // namespace pbs
