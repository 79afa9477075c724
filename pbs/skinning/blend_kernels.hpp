// Inner loops of the blends on raw arrays, built for the machine at hand; blend_skinning.hpp is what calls them. Scalar is float or double.
//   matrices: a rigid or blended transform is 16 numbers, its columns c_0, c_1, c_2 and t padded to 4: v' = c_0 x + c_1 y + c_2 z + t
//   dual quaternions: 8 numbers, real and dual part as x, y, z, w
//   rest, posed: points [m], n x 3; they do not overlap
#pragma once

namespace pbs {

// n rows of weights, sparse in bones: row i blends the transforms `transform[k]` with `weight[k]`, first[i] <= k < first[i + 1].
template <class Scalar>
struct BlendRows {
    int n;
    const int* first;
    const int* transform;
    const Scalar* weight;
};

// One matrix a point, no blending: point i is moved by matrix transform[i].
template <class Scalar>
void transform_points(int n, const int* transform, const Scalar* matrices, const Scalar* rest, Scalar* posed);

// One row of weights a point.
template <class Scalar>
void blend_points_linear(const BlendRows<Scalar>& rows, const Scalar* matrices, const Scalar* rest, Scalar* posed);
template <class Scalar>
void blend_points_dual(const BlendRows<Scalar>& rows, const Scalar* dual_quaternions, const Scalar* rest, Scalar* posed);

// The blended transforms themselves, n matrices.
template <class Scalar>
void blend_matrices_linear(const BlendRows<Scalar>& rows, const Scalar* matrices, Scalar* blended);
template <class Scalar>
void blend_matrices_dual(const BlendRows<Scalar>& rows, const Scalar* dual_quaternions, Scalar* blended);

}  // namespace pbs
