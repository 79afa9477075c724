// 3 x 3 matrices in every lane: the arithmetic of a constraint on deformation gradients. For kernels alone.
#pragma once

#include "pbs/packed/batch.hpp"
#include "pbs/solver/batched/pbs_kernels.cpp"

namespace pbs {

// A 3 x 3 matrix in every lane, by columns.
template <typename Scalar>
struct LaneMatrix {
    LaneVector<Scalar> column[3];
};

template <typename Scalar>
[[gnu::always_inline]] inline LaneVector<Scalar> times(const Lanes<Scalar>& factor, const LaneVector<Scalar>& a)
{
    return {factor * a.x, factor * a.y, factor * a.z};
}

// A b with b = (b0, b1, b2).
template <typename Scalar>
[[gnu::always_inline]] inline LaneVector<Scalar> combined(const LaneMatrix<Scalar>& A, const Lanes<Scalar>& b0, const Lanes<Scalar>& b1,
                                                          const Lanes<Scalar>& b2)
{
    return times(b0, A.column[0]) + (times(b1, A.column[1]) + times(b2, A.column[2]));
}

// A : B, the sum of the products of corresponding entries.
template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> inner(const LaneMatrix<Scalar>& A, const LaneMatrix<Scalar>& B)
{
    return dot(A.column[0], B.column[0]) + dot(A.column[1], B.column[1]) + dot(A.column[2], B.column[2]);
}

// a A + b B.
template <typename Scalar>
[[gnu::always_inline]] inline LaneMatrix<Scalar> sum(const Lanes<Scalar>& a, const LaneMatrix<Scalar>& A, const Lanes<Scalar>& b,
                                                     const LaneMatrix<Scalar>& B)
{
    LaneMatrix<Scalar> result;
    for (int j = 0; j < 3; ++j) result.column[j] = times(a, A.column[j]) + times(b, B.column[j]);
    return result;
}

// A S with the symmetric S: 00 11 22 12 02 01.
template <typename Scalar>
[[gnu::always_inline]] inline LaneMatrix<Scalar> times_symmetric(const LaneMatrix<Scalar>& A, const Lanes<Scalar> (&S)[6])
{
    return {{combined(A, S[0], S[5], S[4]), combined(A, S[5], S[1], S[3]), combined(A, S[4], S[3], S[2])}};
}

template <typename Scalar>
[[gnu::always_inline]] inline void store(const Lanes<Scalar>& from, Scalar* to)
{
    from.copy_to(to, std::experimental::vector_aligned);
}

// Entry (i, j) of each matrix is in columns[3 j + i], from lane `first` on.
template <typename Scalar>
[[gnu::always_inline]] inline LaneMatrix<Scalar> load_matrix(const Scalar (&columns)[9][batch_size], int first)
{
    LaneMatrix<Scalar> result;
    for (int j = 0; j < 3; ++j)
        result.column[j] = {load(columns[3 * j] + first), load(columns[3 * j + 1] + first), load(columns[3 * j + 2] + first)};
    return result;
}

template <typename Scalar>
[[gnu::always_inline]] inline void store_matrix(const LaneMatrix<Scalar>& from, Scalar (&columns)[9][batch_size], int first)
{
    for (int j = 0; j < 3; ++j) {
        store(from.column[j].x, columns[3 * j] + first);
        store(from.column[j].y, columns[3 * j + 1] + first);
        store(from.column[j].z, columns[3 * j + 2] + first);
    }
}

}  // namespace pbs
