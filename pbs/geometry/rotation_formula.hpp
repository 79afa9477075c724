// The rotation nearest to a 3 x 3 matrix by formulae without a branch, for one matrix or for one in each lane of a
// register. Callers use nearest_rotation.hpp, or the kernels, which also treat the matrices that are refused here.
//
// max tr(R^T M) over rotations R is the largest eigenvalue lambda = s_1 + s_2 + sign(det M) s_3 of Horn's symmetric 4 x
// 4 matrix K(M), and the eigenvector is the quaternion of R (B. K. P. Horn, J. Opt. Soc. Am. A 4, 1987); s_1 >= s_2 >=
// s_3 are the singular values of M.
//   1. lambda is the largest root of det(K - lambda 1) = lambda^4 - 2 |M|^2 lambda^2 - 8 det(M) lambda + |M|^4 - 4 |cof
//      M|^2. All roots are real, so that Laguerre's iteration from the bound sqrt(3) |M| >= lambda descends to it with
//      third order.
//   2. adj(K - lambda 1) is a multiple of q q^T: its largest column is the quaternion.
//   3. Newton's method for max tr(R^T M) removes what the small differences of step 1 have lost. With R^T M = S, the
//      correction w solves (tr(S) 1 - (S + S^T) / 2) w = (S_32 - S_23, S_13 - S_31, S_21 - S_12). It is of third order
//      as well, since S is symmetric at the end.
// The last correction proves the result: where the matrix of step 3 is positive definite and w vanishes, R is a local
// maximum, and max tr(R^T M) has no local maximum other than the largest eigenvalue. Its determinant (s_1 + s_2) (s_1 +
// s s_3) (s_2 + s s_3) of M / |M|, s = sign(det M), is zero where the nearest rotation is not unique: rank one, rank
// zero, and reflections with s_2 = s_3. An error E of M turns the rotation by at most about sqrt(2) |E| / (s_2 + s
// s_3).
#pragma once

#include <cmath>

namespace pbs {

// The functions that the formulae need. A type of numbers that is not built in, such as a register, has a
// specialisation with the same functions.
template <class Number>
struct NumberFunctions {
    static Number of(double a) { return static_cast<Number>(a); }
    static Number root(Number a) { return std::sqrt(a); }
    static Number magnitude(Number a) { return std::abs(a); }
    static Number larger(Number a, Number b) { return a < b ? b : a; }
    static Number where_less(Number a, Number b, Number then, Number otherwise) { return a < b ? then : otherwise; }
    static bool any_less(Number a, Number b) { return a < b; }
};

namespace rotation_formula {

// A result is taken where the determinant of step 3 is above the first and the last |w / 2|^2 is below the second. The
// first bounds how far rounding is amplified. Below the second, the part |w|^3 / (12 (s_2 + s s_3)) that a third
// correction would remove is below rounding.
template <class Scalar>
inline constexpr Scalar least_determinant = sizeof(Scalar) == 4 ? Scalar(1e-3) : Scalar(1e-7);
template <class Scalar>
inline constexpr Scalar largest_correction = sizeof(Scalar) == 4 ? Scalar(1e-6) : Scalar(1e-12);

// Entries of M from row to row.
template <class Number>
struct Matrix3 {
    Number m[9];
};

template <class Number>
struct Quaternion {
    Number w, x, y, z;
};

// The upper triangle of a symmetric 4 x 4 matrix.
template <class Number>
struct Symmetric4 {
    Number a00, a01, a02, a03, a11, a12, a13, a22, a23, a33;
};

template <class Number>
[[gnu::always_inline]] inline Number squares(const Matrix3<Number>& a)
{
    const Number* m = a.m;
    return (m[0] * m[0] + m[1] * m[1] + m[2] * m[2]) + (m[3] * m[3] + m[4] * m[4] + m[5] * m[5]) +
           (m[6] * m[6] + m[7] * m[7] + m[8] * m[8]);
}

// M / |M|. The largest entry divides first, so that no square overflows or vanishes.
template <class Number>
[[gnu::always_inline]] inline Matrix3<Number> normalized(const Matrix3<Number>& a)
{
    using Of = NumberFunctions<Number>;
    Number largest = Of::magnitude(a.m[0]);
    for (int i = 1; i < 9; ++i) largest = Of::larger(largest, Of::magnitude(a.m[i]));
    Matrix3<Number> result;
    const Number scale = Number(1) / largest;
    for (int i = 0; i < 9; ++i) result.m[i] = a.m[i] * scale;
    const Number length = Number(1) / Of::root(squares(result));
    for (int i = 0; i < 9; ++i) result.m[i] = result.m[i] * length;
    return result;
}

template <class Number>
[[gnu::always_inline]] inline Matrix3<Number> cofactors(const Matrix3<Number>& a)
{
    const Number* m = a.m;
    return {{m[4] * m[8] - m[5] * m[7], m[5] * m[6] - m[3] * m[8], m[3] * m[7] - m[4] * m[6],  //
             m[2] * m[7] - m[1] * m[8], m[0] * m[8] - m[2] * m[6], m[1] * m[6] - m[0] * m[7],  //
             m[1] * m[5] - m[2] * m[4], m[2] * m[3] - m[0] * m[5], m[0] * m[4] - m[1] * m[3]}};
}

// Step 1, for |M| = 1.
template <class Number>
[[gnu::always_inline]] inline Number largest_eigenvalue(const Matrix3<Number>& a)
{
    using Of = NumberFunctions<Number>;
    const Matrix3<Number> cofactor = cofactors(a);
    const Number det = a.m[0] * cofactor.m[0] + a.m[1] * cofactor.m[1] + a.m[2] * cofactor.m[2];
    const Number c1 = Number(-8) * det, c0 = Number(1) - Number(4) * squares(cofactor);
    Number x = Of::of(1.7320508075688772);
    for (int step = 0; step < 6; ++step) {
        const Number x2 = x * x;
        const Number p = (x2 - Number(2)) * x2 + (c1 * x + c0), slope = Number(4) * x * (x2 - Number(1)) + c1;
        const Number curvature = Number(12) * x2 - Number(4);
        const Number under_root = Number(9) * slope * slope - Number(12) * p * curvature;
        x = x - Number(4) * p / (slope + Of::root(Of::larger(under_root, Number(0))));
    }
    return x;
}

// K(M) - lambda 1 for q = (w, x, y, z).
template <class Number>
[[gnu::always_inline]] inline Symmetric4<Number> horn_matrix(const Matrix3<Number>& a, Number lambda)
{
    const Number* m = a.m;
    return {m[0] + m[4] + m[8] - lambda, m[7] - m[5], m[2] - m[6], m[3] - m[1],  //
            m[0] - m[4] - m[8] - lambda, m[1] + m[3], m[2] + m[6],               //
            m[4] - m[0] - m[8] - lambda, m[5] + m[7],                            //
            m[8] - m[0] - m[4] - lambda};
}

// By the 2 x 2 minors of the first and of the last two rows.
template <class Number>
[[gnu::always_inline]] inline Symmetric4<Number> adjugate(const Symmetric4<Number>& k)
{
    const Number s0 = k.a00 * k.a11 - k.a01 * k.a01, s1 = k.a00 * k.a12 - k.a01 * k.a02,
                 s2 = k.a00 * k.a13 - k.a01 * k.a03;
    const Number s3 = k.a01 * k.a12 - k.a11 * k.a02, s4 = k.a01 * k.a13 - k.a11 * k.a03,
                 s5 = k.a02 * k.a13 - k.a12 * k.a03;
    const Number c1 = k.a02 * k.a23 - k.a03 * k.a22, c2 = k.a02 * k.a33 - k.a03 * k.a23,
                 c3 = k.a12 * k.a23 - k.a13 * k.a22;
    const Number c4 = k.a12 * k.a33 - k.a13 * k.a23, c5 = k.a22 * k.a33 - k.a23 * k.a23;
    return {k.a11 * c5 - k.a12 * c4 + k.a13 * c3, k.a02 * c4 - k.a01 * c5 - k.a03 * c3,
            k.a13 * s5 - k.a23 * s4 + k.a33 * s3, k.a22 * s4 - k.a12 * s5 - k.a23 * s3,
            k.a00 * c5 - k.a02 * c2 + k.a03 * c1, k.a23 * s2 - k.a03 * s5 - k.a33 * s1,
            k.a02 * s5 - k.a22 * s2 + k.a23 * s1, k.a03 * s4 - k.a13 * s2 + k.a33 * s0,
            k.a12 * s2 - k.a02 * s4 - k.a23 * s0, k.a02 * s3 - k.a12 * s1 + k.a22 * s0};
}

template <class Number>
[[gnu::always_inline]] inline Quaternion<Number> normalized(const Quaternion<Number>& q)
{
    const Number length = Number(1) / NumberFunctions<Number>::root((q.w * q.w + q.x * q.x) + (q.y * q.y + q.z * q.z));
    return {q.w * length, q.x * length, q.y * length, q.z * length};
}

// The column of the largest diagonal entry, which is at least a quarter of their sum. All four have one sign.
template <class Number>
[[gnu::always_inline]] inline Quaternion<Number> largest_column(const Symmetric4<Number>& k)
{
    using Of = NumberFunctions<Number>;
    Number largest = Of::magnitude(k.a00);
    Quaternion<Number> q = {k.a00, k.a01, k.a02, k.a03};
    const auto take = [&](Number diagonal, Number w, Number x, Number y, Number z) {
        const Number size = Of::magnitude(diagonal);
        q = {Of::where_less(largest, size, w, q.w), Of::where_less(largest, size, x, q.x),
             Of::where_less(largest, size, y, q.y), Of::where_less(largest, size, z, q.z)};
        largest = Of::larger(largest, size);
    };
    take(k.a11, k.a01, k.a11, k.a12, k.a13);
    take(k.a22, k.a02, k.a12, k.a22, k.a23);
    take(k.a33, k.a03, k.a13, k.a23, k.a33);
    return normalized(q);
}

template <class Number>
[[gnu::always_inline]] inline Matrix3<Number> matrix_of(const Quaternion<Number>& q)
{
    const Number x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
    const Number xx = q.x * x2, yy = q.y * y2, zz = q.z * z2, xy = q.x * y2, xz = q.x * z2, yz = q.y * z2;
    const Number wx = q.w * x2, wy = q.w * y2, wz = q.w * z2, one = Number(1);
    return {{one - (yy + zz), xy - wz, xz + wy, xy + wz, one - (xx + zz), yz - wx, xz - wy, yz + wx, one - (xx + yy)}};
}

// The result of step 3.
template <class Number>
struct Correction {
    Quaternion<Number> q;  // q (1, w / 2), normalized
    Number definite;       // the determinant of the matrix of step 3 if that is positive definite, else not positive
    Number half_turn;      // |w / 2|^2
};

template <class Number>
[[gnu::always_inline]] inline Correction<Number> corrected(const Matrix3<Number>& a, const Quaternion<Number>& q)
{
    using Of = NumberFunctions<Number>;
    const Matrix3<Number> r = matrix_of(q);
    Number s[3][3];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) s[i][j] = r.m[i] * a.m[j] + r.m[3 + i] * a.m[3 + j] + r.m[6 + i] * a.m[6 + j];
    const Number half = Of::of(0.5);
    const Number h00 = s[1][1] + s[2][2], h11 = s[0][0] + s[2][2], h22 = s[0][0] + s[1][1];
    const Number h01 = -half * (s[0][1] + s[1][0]), h02 = -half * (s[0][2] + s[2][0]),
                 h12 = -half * (s[1][2] + s[2][1]);
    const Number b0 = s[2][1] - s[1][2], b1 = s[0][2] - s[2][0], b2 = s[1][0] - s[0][1];
    const Number c00 = h11 * h22 - h12 * h12, c01 = h02 * h12 - h01 * h22, c02 = h01 * h12 - h02 * h11;
    const Number c11 = h00 * h22 - h02 * h02, c12 = h01 * h02 - h00 * h12, c22 = h00 * h11 - h01 * h01;
    const Number det = h00 * c00 + h01 * c01 + h02 * c02, half_over_det = half / det;
    const Number x = half_over_det * (c00 * b0 + c01 * b1 + c02 * b2),
                 y = half_over_det * (c01 * b0 + c11 * b1 + c12 * b2),
                 z = half_over_det * (c02 * b0 + c12 * b1 + c22 * b2);
    const Number zero = Number(0), definite = Of::where_less(zero, h00, Of::where_less(zero, c22, det, zero), zero);
    return {normalized(Quaternion<Number>{q.w - q.x * x - q.y * y - q.z * z, q.x + q.w * x + q.y * z - q.z * y,
                                          q.y + q.w * y + q.z * x - q.x * z, q.z + q.w * z + q.x * y - q.y * x}),
            definite, x * x + y * y + z * z};
}

// `rotation`: the nearest rotation. Returns the determinant of step 3, or a number that is not positive where the
// result is not proved: not a number where M is zero or not finite, and zero where the last |w / 2|^2 is not below
// `largest`.
template <class Number>
[[gnu::always_inline]] inline Number nearest(const Matrix3<Number>& matrix, Number largest, Matrix3<Number>& rotation)
{
    const Matrix3<Number> a = normalized(matrix);
    const Quaternion<Number> first = largest_column(adjugate(horn_matrix(a, largest_eigenvalue(a))));
    const Correction<Number> last = corrected(a, corrected(a, first).q);
    rotation = matrix_of(last.q);
    return NumberFunctions<Number>::where_less(last.half_turn, largest, last.definite, Number(0) * last.half_turn);
}

}  // namespace rotation_formula
}  // namespace pbs
