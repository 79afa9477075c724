#include "pbs/skinning/skinning_kernels.hpp"

#include "pbs/packed/lanes.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // wide vectors never pass from here to another file

// Too small to be called: the compiler would pass their vectors through memory.
#define PBS_INLINE [[gnu::always_inline]] inline

namespace pbs {
namespace {

#if defined(__AVX512F__)
constexpr int widest = 64;  // bytes of a vector register
#elif defined(__AVX__)
constexpr int widest = 32;
#else
constexpr int widest = 16;
#endif

template <class Scalar>
using Eight = simd_detail::Vector<Scalar, 8>;  // two columns of a matrix

// Used where the machine has wide enough registers: (c_0 x, c_1 y) + (c_2 z, t 1), then the halves of the sum.
template <class Scalar>
PBS_INLINE Four<Scalar> moved(const PaddedMatrix<Scalar>& matrix, const Scalar* point)
{
    if constexpr (sizeof(Eight<Scalar>) <= widest) {
        const auto* columns = reinterpret_cast<const Eight<Scalar>*>(matrix.numbers);
        Four<Scalar> v = load_four(point);
        v[3] = 1;
        const Eight<Scalar> sum = columns[0] * __builtin_shufflevector(v, v, 0, 0, 0, 0, 1, 1, 1, 1) +
                                  columns[1] * __builtin_shufflevector(v, v, 2, 2, 2, 2, 3, 3, 3, 3);
        return __builtin_shufflevector(sum, sum, 0, 1, 2, 3) + __builtin_shufflevector(sum, sum, 4, 5, 6, 7);
    } else {
        const Scalar* c = matrix.numbers;
        return load_four(c) * point[0] +
               (load_four(c + 4) * point[1] + (load_four(c + 8) * point[2] + load_four(c + 12)));
    }
}

// sum_j w_j T_j over a row, T_j all numbers of a matrix (Eq. 1) or of a dual quaternion.
template <class Scalar, class Transform>
PBS_INLINE Transform blended(const BlendRows<Scalar>& rows, int row, const Transform* transforms)
{
    constexpr int bytes = sizeof(Transform) < widest ? sizeof(Transform) : widest, parts = sizeof(Transform) / bytes;
    using Part = simd_detail::Vector<Scalar, bytes / sizeof(Scalar)>;
    Part sum[parts] = {};
    for (int k = rows.first[row]; k < rows.first[row + 1]; ++k) {
        const auto* transform = reinterpret_cast<const Part*>(transforms[rows.transform[k]].numbers);
        for (int part = 0; part < parts; ++part) sum[part] += rows.weight[k] * transform[part];
    }
    Transform blended;
    for (int part = 0; part < parts; ++part) reinterpret_cast<Part*>(blended.numbers)[part] = sum[part];
    return blended;
}

// v' = v + 2 r x (r x v + r_w v) + 2 (r_w d - d_w r + r x d) for the unit dual quaternion (Kavan 2007, Algorithm 1). A
// blended one is not unit: 2 / |r|^2 in the place of 2 takes its length out without a square root.
template <class Scalar>
PBS_INLINE void move(const PackedDualQuaternion<Scalar>& blended, const Scalar* v, Scalar* moved)
{
    const Scalar* r = blended.numbers;
    const Scalar* d = r + 4;
    const Scalar twice = 2 / ((r[0] * r[0] + r[1] * r[1]) + (r[2] * r[2] + r[3] * r[3]));
    const Scalar u[] = {r[1] * v[2] - r[2] * v[1] + r[3] * v[0] + d[0], r[2] * v[0] - r[0] * v[2] + r[3] * v[1] + d[1],
                        r[0] * v[1] - r[1] * v[0] + r[3] * v[2] + d[2]};  // r x v + r_w v + d
    const Scalar x = v[0] + twice * ((r[1] * u[2] - r[2] * u[1]) + (r[3] * d[0] - d[3] * r[0]));
    const Scalar y = v[1] + twice * ((r[2] * u[0] - r[0] * u[2]) + (r[3] * d[1] - d[3] * r[1]));
    const Scalar z = v[2] + twice * ((r[0] * u[1] - r[1] * u[0]) + (r[3] * d[2] - d[3] * r[2]));
    moved[0] = x;
    moved[1] = y;
    moved[2] = z;
}

template <class Scalar>
PaddedMatrix<Scalar> matrix_of(const PaddedMatrix<Scalar>& matrix)
{
    return matrix;
}

// Its columns are where it moves the origin to, and the axes less that with no translation.
template <class Scalar>
PaddedMatrix<Scalar> matrix_of(const PackedDualQuaternion<Scalar>& blended)
{
    PaddedMatrix<Scalar> matrix = {};
    const Scalar axes[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    move(blended, axes[3], matrix.numbers + 12);
    PackedDualQuaternion<Scalar> rotation = blended;
    for (int i = 4; i < 8; ++i) rotation.numbers[i] = 0;
    for (int axis = 0; axis < 3; ++axis) move(rotation, axes[axis], matrix.numbers + 4 * axis);
    return matrix;
}

// Four numbers are stored for each point except the last; the next point overwrites the fourth.
template <class Scalar, class MovedPoint>
PBS_INLINE void store_points(int n, Scalar* posed, const MovedPoint& moved_point)
{
    if (n <= 0) return;
    for (int i = 0; i + 1 < n; ++i) store_four<Scalar>(moved_point(i), posed + 3L * i);
    const Four<Scalar> last = moved_point(n - 1);
    for (int axis = 0; axis < 3; ++axis) posed[3L * (n - 1) + axis] = last[axis];
}

template <class Scalar>
void move_points(int n, const PackedDualQuaternion<Scalar>* __restrict dual_quaternions, const Scalar* __restrict rest,
                 Scalar* __restrict posed)
{
    for (int i = 0; i < n; ++i) move(dual_quaternions[i], rest + 3L * i, posed + 3L * i);
}

}  // namespace

template <class Scalar>
void transform_points(int n, const PaddedMatrix<Scalar>& matrix, const Scalar* rest, Scalar* posed)
{
    const Four<Scalar> c0 = load_four(matrix.numbers), c1 = load_four(matrix.numbers + 4),
                       c2 = load_four(matrix.numbers + 8), t = load_four(matrix.numbers + 12);
    store_points(n, posed, [=](int i) {
        const Scalar* v = rest + 3L * i;
        return c0 * v[0] + (c1 * v[1] + (c2 * v[2] + t));
    });
}

template <class Scalar>
void transform_points(int n, const int* transform, const PaddedMatrix<Scalar>* matrices, const Scalar* rest,
                      Scalar* posed)
{
    store_points(n, posed, [=](int i) { return moved(matrices[transform[i]], rest + 3L * i); });
}

template <class Scalar>
void blend_points(const BlendRows<Scalar>& rows, const PaddedMatrix<Scalar>* matrices, const Scalar* rest,
                  Scalar* posed)
{
    store_points(rows.n, posed, [=](int i) { return moved(blended(rows, i, matrices), rest + 3L * i); });
}

template <class Scalar>
void blend_points(const BlendRows<Scalar>& rows, const PackedDualQuaternion<Scalar>* dual_quaternions,
                  const Scalar* rest, Scalar* posed)
{
    constexpr int tile = 64;  // points whose dual quaternions wait in the nearest cache, to be used side by side
    PackedDualQuaternion<Scalar> waiting[tile];
    for (int start = 0; start < rows.n; start += tile) {
        const int n = rows.n - start < tile ? rows.n - start : tile;
        for (int i = 0; i < n; ++i) waiting[i] = blended(rows, start + i, dual_quaternions);
        move_points(n, waiting, rest + 3L * start, posed + 3L * start);
    }
}

template <class Scalar>
void blend_matrices(const BlendRows<Scalar>& rows, const PaddedMatrix<Scalar>* matrices,
                    PaddedMatrix<Scalar>* blended_matrices)
{
    for (int i = 0; i < rows.n; ++i) blended_matrices[i] = matrix_of(blended(rows, i, matrices));
}

template <class Scalar>
void blend_matrices(const BlendRows<Scalar>& rows, const PackedDualQuaternion<Scalar>* dual_quaternions,
                    PaddedMatrix<Scalar>* blended_matrices)
{
    for (int i = 0; i < rows.n; ++i) blended_matrices[i] = matrix_of(blended(rows, i, dual_quaternions));
}

#define PBS_BLEND_KERNELS(Scalar)                                                                                      \
    template void transform_points(int, const PaddedMatrix<Scalar>&, const Scalar*, Scalar*);                          \
    template void transform_points(int, const int*, const PaddedMatrix<Scalar>*, const Scalar*, Scalar*);              \
    template void blend_points(const BlendRows<Scalar>&, const PaddedMatrix<Scalar>*, const Scalar*, Scalar*);         \
    template void blend_points(const BlendRows<Scalar>&, const PackedDualQuaternion<Scalar>*, const Scalar*, Scalar*); \
    template void blend_matrices(const BlendRows<Scalar>&, const PaddedMatrix<Scalar>*, PaddedMatrix<Scalar>*);        \
    template void blend_matrices(const BlendRows<Scalar>&, const PackedDualQuaternion<Scalar>*, PaddedMatrix<Scalar>*);
PBS_BLEND_KERNELS(float)
PBS_BLEND_KERNELS(double)

}  // namespace pbs
