// The registers of all kernels: as many numbers side by side (lanes) as a register of this machine holds, vectors and
// matrices in every lane, and the way of vertices from memory into registers and back.
//   Vertices<Scalar> p = gather(x, offset);                      // one vertex in every lane
//   const Lanes<Scalar> distance = length(p - gather(x, other_offset));
//   scatter(p, x, offset);
// Only the kernels' translation units include this file. They are compiled for one machine, and nothing of it may reach
// code that runs on another one.
//
// In memory a vertex is the four numbers x, y, z, w [m, m, m, inverse mass], which are loaded at once. Loads of four
// numbers and a transpose are about three times quicker than gather and scatter instructions. Four<Scalar> is one point
// or one column of a matrix. Skinning uses it, where neighbouring vertices have too little in common to stand side by
// side.
#pragma once

#include "pbs/geometry/rotation_formula.hpp"
#include "pbs/packed/batch.hpp"

#include <experimental/simd>

#include <cstdint>
#include <utility>

#ifdef __AVX512DQ__
#include <immintrin.h>
#endif

namespace pbs {

// A register of numbers.
template <typename Scalar>
using Lanes = std::experimental::native_simd<Scalar>;
// The number of lanes of a register: 4 to 16 in float and 2 to 8 in double on x86-64.
template <typename Scalar>
inline constexpr int lanes = static_cast<int>(Lanes<Scalar>::size());

// Positions [m] and inverse masses w.
template <typename Scalar>
struct Vertices {
    Lanes<Scalar> x, y, z, w;  // w: inverse mass
};

// Loads a register from memory that is aligned to a whole register.
template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> load(const Scalar* from)
{
    return Lanes<Scalar>(from, std::experimental::vector_aligned);
}

template <typename Scalar>
[[gnu::always_inline]] inline void store(const Lanes<Scalar>& from, Scalar* to)
{
    from.copy_to(to, std::experimental::vector_aligned);
}

namespace simd_detail {

// `count` numbers, as the compiler's own vectors hold them.
template <typename Scalar, int count>
using Vector [[gnu::vector_size(count * sizeof(Scalar)), gnu::may_alias]] = Scalar;

// A register as a vector of the compiler.
template <typename Scalar>
using Row = Vector<Scalar, lanes<Scalar>>;

// Patterns of a shuffle of two vectors a and b of the same width within blocks of four. at(i) is the element that
// becomes element i of the result; the elements of b are counted after those of a.
template <int width>
struct UnpackLow {
    static constexpr int at(int i) { return i / 4 * 4 + i % 4 / 2 + i % 2 * width; }
};
template <int width>
struct UnpackHigh {
    static constexpr int at(int i) { return UnpackLow<width>::at(i) + 2; }
};
template <int width>
struct LowHalves {
    static constexpr int at(int i) { return i / 4 * 4 + i % 2 + (i % 4 < 2 ? 0 : width); }
};
template <int width>
struct HighHalves {
    static constexpr int at(int i) { return LowHalves<width>::at(i) + 2; }
};

// The elements of (a, b) that the pattern chooses: element i is that with the number Pattern::at(i).
template <template <int> typename Pattern, typename V, std::size_t... i>
[[gnu::always_inline]] inline V shuffled(V a, V b, std::index_sequence<i...>)
{
    return __builtin_shufflevector(a, b, Pattern<sizeof...(i)>::at(i)...);
}

template <template <int> typename Pattern, typename Scalar>
[[gnu::always_inline]] inline Row<Scalar> shuffled(Row<Scalar> a, Row<Scalar> b)
{
    return shuffled<Pattern>(a, b, std::make_index_sequence<lanes<Scalar>>());
}

// Exchanges rows and columns of each block of four. Doing it twice changes nothing.
template <typename Scalar>
[[gnu::always_inline]] inline void transpose(Row<Scalar> (&rows)[4])
{
    const Row<Scalar> xy_01 = shuffled<UnpackLow, Scalar>(rows[0], rows[1]),
                      zw_01 = shuffled<UnpackHigh, Scalar>(rows[0], rows[1]);
    const Row<Scalar> xy_23 = shuffled<UnpackLow, Scalar>(rows[2], rows[3]),
                      zw_23 = shuffled<UnpackHigh, Scalar>(rows[2], rows[3]);
    rows[0] = shuffled<LowHalves, Scalar>(xy_01, xy_23);
    rows[1] = shuffled<HighHalves, Scalar>(xy_01, xy_23);
    rows[2] = shuffled<LowHalves, Scalar>(zw_01, zw_23);
    rows[3] = shuffled<HighHalves, Scalar>(zw_01, zw_23);
}

// Places vertex(0), vertex(4), vertex(8) ... side by side, four numbers each.
template <typename Scalar, typename Vertex>
[[gnu::always_inline]] inline Row<Scalar> side_by_side(const Vertex& vertex)
{
    if constexpr (lanes<Scalar> == 4) return vertex(0);
#ifdef __AVX512DQ__
    else if constexpr (lanes<Scalar> == 16) {
        const auto pair = [&](int lane) {
            return _mm256_insertf128_ps(_mm256_castps128_ps256((__m128)vertex(lane)), (__m128)vertex(lane + 4), 1);
        };
        return (Row<Scalar>)_mm512_insertf32x8(_mm512_castps256_ps512(pair(0)), pair(8), 1);
    } else
        return (Row<Scalar>)_mm512_insertf64x4(_mm512_castpd256_pd512((__m256d)vertex(0)), (__m256d)vertex(4), 1);
#else
    else {
        const auto pair = [&](int lane) {
            return __builtin_shufflevector(vertex(lane), vertex(lane + 4), 0, 1, 2, 3, 4, 5, 6, 7);
        };
        if constexpr (lanes<Scalar> == 8)
            return pair(0);
        else
            return __builtin_shufflevector(pair(0), pair(8), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    }
#endif
}

// One row of a transpose. With offset + k it has the vertices of the lanes k, k + 4, k + 8 ...
template <typename Scalar>
[[gnu::always_inline]] inline Row<Scalar> row(const Scalar* vertices, const std::uint32_t* offset)
{
    return side_by_side<Scalar>(
        [&](int lane) { return *reinterpret_cast<const Vector<Scalar, 4>*>(vertices + offset[lane]); });
}

// The numbers 4 which to 4 which + 3 of a row.
template <int which, typename Scalar>
[[gnu::always_inline]] inline Vector<Scalar, 4> block(Row<Scalar> row)
{
    constexpr int i = 4 * which;
#ifdef __AVX512DQ__
    if constexpr (lanes<Scalar> == 16) {
        const __m256 half = which < 2 ? _mm512_castps512_ps256((__m512)row) : _mm512_extractf32x8_ps((__m512)row, 1);
        return (Vector<Scalar, 4>)(which % 2 == 0 ? _mm256_castps256_ps128(half) : _mm256_extractf128_ps(half, 1));
    }
#endif
    return __builtin_shufflevector(row, row, i, i + 1, i + 2, i + 3);
}

// Stores the blocks of a row at the vertices from which row() took them.
template <typename Scalar, std::size_t... blocks>
[[gnu::always_inline]] inline void store_row(const Row<Scalar>& row, Scalar* vertices, const std::uint32_t* offset,
                                             std::index_sequence<blocks...>)
{
    ((*reinterpret_cast<Vector<Scalar, 4>*>(vertices + offset[4 * blocks]) = block<blocks, Scalar>(row)), ...);
}

}  // namespace simd_detail

// Loads one vertex per lane from `vertices` + offset[lane]. Offsets count numbers: 4 * vertex.
template <typename Scalar>
[[gnu::always_inline]] inline Vertices<Scalar> gather(const Scalar* vertices, const std::uint32_t* offset)
{
    if constexpr (lanes<Scalar> < 4) {
        const auto component = [&](int which) {
            return Lanes<Scalar>([&](auto lane) { return vertices[offset[lane] + which]; });
        };
        return {component(0), component(1), component(2), component(3)};
    } else {
        using namespace simd_detail;
        Row<Scalar> rows[4] = {row(vertices, offset), row(vertices, offset + 1), row(vertices, offset + 2),
                               row(vertices, offset + 3)};
        transpose<Scalar>(rows);
        const auto lane = [](Row<Scalar> row) { return reinterpret_cast<const Lanes<Scalar>&>(row); };
        return {lane(rows[0]), lane(rows[1]), lane(rows[2]), lane(rows[3])};
    }
}

// Stores vertices with their w where gather takes them from. No two offsets are equal.
template <typename Scalar>
[[gnu::always_inline]] inline void scatter(const Vertices<Scalar>& from, Scalar* vertices, const std::uint32_t* offset)
{
    if constexpr (lanes<Scalar> < 4) {
        for (int lane = 0; lane < lanes<Scalar>; ++lane) {
            Scalar* to = vertices + offset[lane];
            to[0] = from.x[lane];
            to[1] = from.y[lane];
            to[2] = from.z[lane];
            to[3] = from.w[lane];
        }
    } else {
        using namespace simd_detail;
        const auto row = [](const Lanes<Scalar>& lane) { return reinterpret_cast<const Row<Scalar>&>(lane); };
        Row<Scalar> rows[4] = {row(from.x), row(from.y), row(from.z), row(from.w)};
        transpose<Scalar>(rows);
        for (int k = 0; k < 4; ++k)
            store_row<Scalar>(rows[k], vertices, offset + k, std::make_index_sequence<lanes<Scalar> / 4>());
    }
}

// A vector in every lane.
template <typename Scalar>
struct LaneVector {
    Lanes<Scalar> x, y, z;
};

template <typename Scalar>
[[gnu::always_inline]] inline LaneVector<Scalar> operator-(const Vertices<Scalar>& a, const Vertices<Scalar>& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <typename Scalar>
[[gnu::always_inline]] inline LaneVector<Scalar> operator-(const LaneVector<Scalar>& a, const LaneVector<Scalar>& b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <typename Scalar>
[[gnu::always_inline]] inline LaneVector<Scalar> operator+(const LaneVector<Scalar>& a, const LaneVector<Scalar>& b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> dot(const LaneVector<Scalar>& a, const LaneVector<Scalar>& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename Scalar>
[[gnu::always_inline]] inline LaneVector<Scalar> cross(const LaneVector<Scalar>& a, const LaneVector<Scalar>& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// to += factor * g. `to` is a LaneVector, or Vertices whose w does not change.
template <typename Scalar, template <typename> typename To>
[[gnu::always_inline]] inline void add(const Lanes<Scalar>& factor, const LaneVector<Scalar>& g, To<Scalar>& to)
{
    to.x += factor * g.x;
    to.y += factor * g.y;
    to.z += factor * g.z;
}

// numerator / denominator, or zero in lanes in which the denominator is not above `least`.
template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> quotient(const Lanes<Scalar>& numerator, const Lanes<Scalar>& denominator,
                                                     const Lanes<Scalar>& least = Scalar(0))
{
    Lanes<Scalar> result = numerator / denominator;
    where(!(denominator > least), result) = Scalar(0);
    return result;
}

template <typename Scalar>
[[gnu::always_inline]] inline double sum_of_lanes(const Lanes<Scalar>& lanes_to_add)
{
    double total = 0.0;
    for (int lane = 0; lane < lanes<Scalar>; ++lane) total += double(lanes_to_add[lane]);
    return total;
}

// The sum of of_part(batch, first lane) over the parts of `count` batches; a part is a register of a batch. It is
// summed up in registers, and in double after every 32 parts.
template <typename Scalar, typename OfPart>
[[gnu::always_inline]] inline double sum_of_parts(int count, const OfPart& of_part)
{
    constexpr int parts_in_scalar = 32, parts_of_batch = batch_size / lanes<Scalar>;
    double total = 0.0;
    Lanes<Scalar> sum = Scalar(0);
    for (int part = 0; part < count * parts_of_batch; ++part) {
        sum += of_part(part / parts_of_batch, part % parts_of_batch * lanes<Scalar>);
        if (part % parts_in_scalar != parts_in_scalar - 1) continue;
        total += sum_of_lanes<Scalar>(sum);
        sum = Scalar(0);
    }
    return total + sum_of_lanes<Scalar>(sum);
}

template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> length(const LaneVector<Scalar>& a)
{
    return sqrt(dot(a, a));
}

// The functions that formulae without a branch need (rotation_formula.hpp and others), on a number in each lane.
template <class Scalar>
struct NumberFunctions<std::experimental::native_simd<Scalar>> {
    using Number = std::experimental::native_simd<Scalar>;
    [[gnu::always_inline]] static Number of(double a) { return Number(static_cast<Scalar>(a)); }
    [[gnu::always_inline]] static Number root(Number a) { return std::experimental::sqrt(a); }
    [[gnu::always_inline]] static Number magnitude(Number a) { return std::experimental::abs(a); }
    [[gnu::always_inline]] static Number larger(Number a, Number b) { return where_less(a, b, b, a); }
    [[gnu::always_inline]] static Number where_less(Number a, Number b, Number then, Number otherwise)
    {
        std::experimental::where(a < b, otherwise) = then;
        return otherwise;
    }
    [[gnu::always_inline]] static bool any_less(Number a, Number b) { return std::experimental::any_of(a < b); }
};

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
[[gnu::always_inline]] inline LaneVector<Scalar> combined(const LaneMatrix<Scalar>& A, const Lanes<Scalar>& b0,
                                                          const Lanes<Scalar>& b1, const Lanes<Scalar>& b2)
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
[[gnu::always_inline]] inline LaneMatrix<Scalar> sum(const Lanes<Scalar>& a, const LaneMatrix<Scalar>& A,
                                                     const Lanes<Scalar>& b, const LaneMatrix<Scalar>& B)
{
    LaneMatrix<Scalar> result;
    for (int j = 0; j < 3; ++j) result.column[j] = times(a, A.column[j]) + times(b, B.column[j]);
    return result;
}

// A S with a symmetric S, whose entries are in the order 00, 11, 22, 12, 02, 01.
template <typename Scalar>
[[gnu::always_inline]] inline LaneMatrix<Scalar> times_symmetric(const LaneMatrix<Scalar>& A,
                                                                 const Lanes<Scalar> (&S)[6])
{
    return {{combined(A, S[0], S[5], S[4]), combined(A, S[5], S[1], S[3]), combined(A, S[4], S[3], S[2])}};
}

// Loads a matrix per lane. Entry (i, j) is in columns[3 j + i], from the lane `first` of the batch on.
template <typename Scalar>
[[gnu::always_inline]] inline LaneMatrix<Scalar> load_matrix(const Scalar (&columns)[9][batch_size], int first)
{
    LaneMatrix<Scalar> result;
    for (int j = 0; j < 3; ++j)
        result.column[j] = {load(columns[3 * j] + first), load(columns[3 * j + 1] + first),
                            load(columns[3 * j + 2] + first)};
    return result;
}

template <typename Scalar>
[[gnu::always_inline]] inline void store_matrix(const LaneMatrix<Scalar>& from, Scalar (&columns)[9][batch_size],
                                                int first)
{
    for (int j = 0; j < 3; ++j) {
        store(from.column[j].x, columns[3 * j] + first);
        store(from.column[j].y, columns[3 * j + 1] + first);
        store(from.column[j].z, columns[3 * j + 2] + first);
    }
}

// Four numbers, as the compiler's own vectors hold them.
template <typename Scalar>
using Four = simd_detail::Vector<Scalar, 4>;

namespace simd_detail {

template <typename Scalar>
using UnalignedFour [[gnu::vector_size(4 * sizeof(Scalar)), gnu::aligned(alignof(Scalar)), gnu::may_alias]] = Scalar;

}  // namespace simd_detail

// Loads four numbers from any address, which need not be aligned.
template <typename Scalar>
[[gnu::always_inline]] inline Four<Scalar> load_four(const Scalar* numbers)
{
    return *reinterpret_cast<const simd_detail::UnalignedFour<Scalar>*>(numbers);
}

template <typename Scalar>
[[gnu::always_inline]] inline void store_four(Four<Scalar> from, Scalar* numbers)
{
    *reinterpret_cast<simd_detail::UnalignedFour<Scalar>*>(numbers) = from;
}

}  // namespace pbs
