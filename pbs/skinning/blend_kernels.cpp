#include "pbs/skinning/blend_kernels.hpp"

namespace pbs {
namespace {

// Four numbers side by side: a column, a quaternion or a point; `Unaligned` is how they lie in memory.
template <class Scalar>
struct Lanes {
    using Four [[gnu::vector_size(4 * sizeof(Scalar))]] = Scalar;
    using Unaligned [[gnu::vector_size(4 * sizeof(Scalar)), gnu::aligned(alignof(Scalar)), gnu::may_alias]] = Scalar;
};
template <class Scalar>
using Four = typename Lanes<Scalar>::Four;

template <class Scalar>
Four<Scalar> load(const Scalar* numbers)
{
    return *reinterpret_cast<const typename Lanes<Scalar>::Unaligned*>(numbers);
}

template <class Scalar>
void store(Scalar* numbers, Four<Scalar> four)
{
    *reinterpret_cast<typename Lanes<Scalar>::Unaligned*>(numbers) = four;
}

template <class Scalar>
struct Matrix {
    Four<Scalar> c0, c1, c2, t;
};

template <class Scalar>
Matrix<Scalar> load_matrix(const Scalar* matrix)
{
    return {load(matrix), load(matrix + 4), load(matrix + 8), load(matrix + 12)};
}

template <class Scalar>
Four<Scalar> moved(const Matrix<Scalar>& matrix, const Scalar* point)
{
    return matrix.c0 * point[0] + (matrix.c1 * point[1] + (matrix.c2 * point[2] + matrix.t));
}

// A blended dual quaternion, not unit: `twice` = 2 / |real|^2 takes its length out without a square root.
template <class Scalar>
struct DualQuaternion {
    Four<Scalar> real, dual;
    Scalar twice;
};

// a x b of the first three; the fourth is zero.
template <class Scalar>
Four<Scalar> cross(Four<Scalar> a, Four<Scalar> b)
{
    return __builtin_shufflevector(a, a, 1, 2, 0, 3) * __builtin_shufflevector(b, b, 2, 0, 1, 3) -
           __builtin_shufflevector(a, a, 2, 0, 1, 3) * __builtin_shufflevector(b, b, 1, 2, 0, 3);
}

// R v - v with R v = v + 2 r x (r x v + r_w v) (Kavan 2007, Algorithm 1).
template <class Scalar>
Four<Scalar> turned(const DualQuaternion<Scalar>& q, Four<Scalar> point)
{
    return q.twice * cross<Scalar>(q.real, cross<Scalar>(q.real, point) + q.real[3] * point);
}

// 2 (r_w d - d_w r + r x d)
template <class Scalar>
Four<Scalar> translation(const DualQuaternion<Scalar>& q)
{
    return q.twice * (q.real[3] * q.dual - q.dual[3] * q.real + cross<Scalar>(q.real, q.dual));
}

template <class Scalar>
Four<Scalar> moved(const DualQuaternion<Scalar>& q, const Scalar* point)
{
    const Four<Scalar> v = {point[0], point[1], point[2], 0};
    return v + (turned(q, v) + translation(q));
}

template <class Scalar>
Matrix<Scalar> matrix_of(const DualQuaternion<Scalar>& q)
{
    const Four<Scalar> x = {1, 0, 0, 0}, y = {0, 1, 0, 0}, z = {0, 0, 1, 0};
    return {x + turned(q, x), y + turned(q, y), z + turned(q, z), translation(q)};
}

// sum_j w_j P_j R_j^-1 of Eq. 1
template <class Scalar>
Matrix<Scalar> blended_matrix(const BlendRows<Scalar>& rows, int row, const Scalar* matrices)
{
    Matrix<Scalar> sum = {};
    for (int k = rows.first[row]; k < rows.first[row + 1]; ++k) {
        const Matrix<Scalar> bone = load_matrix(matrices + 16L * rows.transform[k]);
        const Scalar weight = rows.weight[k];
        sum = {sum.c0 + weight * bone.c0, sum.c1 + weight * bone.c1, sum.c2 + weight * bone.c2, sum.t + weight * bone.t};
    }
    return sum;
}

template <class Scalar>
DualQuaternion<Scalar> blended_dual_quaternion(const BlendRows<Scalar>& rows, int row, const Scalar* dual_quaternions)
{
    DualQuaternion<Scalar> sum = {};
    for (int k = rows.first[row]; k < rows.first[row + 1]; ++k) {
        const Scalar* bone = dual_quaternions + 8L * rows.transform[k];
        sum.real += rows.weight[k] * load(bone);
        sum.dual += rows.weight[k] * load(bone + 4);
    }
    const Four<Scalar> squares = sum.real * sum.real;
    sum.twice = 2 / ((squares[0] + squares[1]) + (squares[2] + squares[3]));
    return sum;
}

// Four numbers are stored for each point but the last; the next point overwrites the fourth.
template <class Scalar, class MovedPoint>
void store_points(int n, Scalar* posed, const MovedPoint& moved_point)
{
    if (n <= 0) return;
    for (int i = 0; i + 1 < n; ++i) store(posed + 3L * i, moved_point(i));
    const Four<Scalar> last = moved_point(n - 1);
    for (int axis = 0; axis < 3; ++axis) posed[3L * (n - 1) + axis] = last[axis];
}

template <class Scalar>
void store_matrix(Scalar* numbers, const Matrix<Scalar>& matrix)
{
    store(numbers, matrix.c0);
    store(numbers + 4, matrix.c1);
    store(numbers + 8, matrix.c2);
    store(numbers + 12, matrix.t);
}

}  // namespace

template <class Scalar>
void transform_points(int n, const int* transform, const Scalar* matrices, const Scalar* rest, Scalar* posed)
{
    store_points(n, posed, [=](int i) { return moved(load_matrix(matrices + 16L * transform[i]), rest + 3L * i); });
}

template <class Scalar>
void blend_points_linear(const BlendRows<Scalar>& rows, const Scalar* matrices, const Scalar* rest, Scalar* posed)
{
    store_points(rows.n, posed, [=](int i) { return moved(blended_matrix(rows, i, matrices), rest + 3L * i); });
}

template <class Scalar>
void blend_points_dual(const BlendRows<Scalar>& rows, const Scalar* dual_quaternions, const Scalar* rest, Scalar* posed)
{
    store_points(rows.n, posed, [=](int i) { return moved(blended_dual_quaternion(rows, i, dual_quaternions), rest + 3L * i); });
}

template <class Scalar>
void blend_matrices_linear(const BlendRows<Scalar>& rows, const Scalar* matrices, Scalar* blended)
{
    for (int i = 0; i < rows.n; ++i) store_matrix(blended + 16L * i, blended_matrix(rows, i, matrices));
}

template <class Scalar>
void blend_matrices_dual(const BlendRows<Scalar>& rows, const Scalar* dual_quaternions, Scalar* blended)
{
    for (int i = 0; i < rows.n; ++i) store_matrix(blended + 16L * i, matrix_of(blended_dual_quaternion(rows, i, dual_quaternions)));
}

#define PBS_BLEND_KERNELS(Scalar)                                                                               \
    template void transform_points<Scalar>(int, const int*, const Scalar*, const Scalar*, Scalar*);             \
    template void blend_points_linear<Scalar>(const BlendRows<Scalar>&, const Scalar*, const Scalar*, Scalar*); \
    template void blend_points_dual<Scalar>(const BlendRows<Scalar>&, const Scalar*, const Scalar*, Scalar*);   \
    template void blend_matrices_linear<Scalar>(const BlendRows<Scalar>&, const Scalar*, Scalar*);              \
    template void blend_matrices_dual<Scalar>(const BlendRows<Scalar>&, const Scalar*, Scalar*);
PBS_BLEND_KERNELS(float)
PBS_BLEND_KERNELS(double)

}  // namespace pbs
