#include "pbs/flesh/flesh_kernels.hpp"

#include "pbs/geometry/rotation_formula.hpp"
#include "pbs/packed/lanes.hpp"

// The local step of projective dynamics by formulae without a branch, for a matrix in each lane of a register: twins of
// projective_dynamics.hpp, which says what they compute and which computes what is refused here.
//
// F = R S, R by rotation_formula.hpp, and the nearest matrix of determinant one is D = R g(S). g maps each eigenvalue
// s_i of S to y_i with
//   y_i^2 - s_i y_i + kappa = 0,   y_1 y_2 y_3 = 1.
//   1. The eigenvalues of a symmetric 3 x 3 matrix are q + 2 p cos(phi + 2 pi k / 3) (O. K. Smith, Comm. ACM 4(4),
//      1961). Where two are nearly equal their difference loses half of the digits. g is symmetric in them, so that the
//      result does not.
//   2. y_3 is found by Newton's method between bounds. kappa = y_3 (s_3 - y_3), and y_1 and y_2 are the larger roots.
//   3. No eigenvector is needed: g is a polynomial in S by Newton's divided differences. The equation of y makes them
//        [s_i, s_j] = P_ij / (P_ij - kappa), P_ij = y_i y_j,
//        [s_1, s_2, s_3] = -kappa / product of all (P_ij - kappa),
//      so that nothing is divided by a difference of eigenvalues.
namespace pbs {
namespace {
namespace local_shape_formula {

using rotation_formula::Matrix3;

template <class Number>
struct Symmetric3 {
    Number a00, a01, a02, a11, a12, a22;
};

template <class Number>
struct Three {
    Number first, second, third;
};

// The share of P_23 that P_23 - kappa has at least; below it the two smaller y are nearly free to change their places.
inline constexpr double least_share = 0.1;
// Newton's method stops where y_1 y_2 y_3 is so near to one; a result that is farther away is refused.
template <class Scalar>
inline constexpr Scalar product_rounding = sizeof(Scalar) == 4 ? Scalar(2e-6) : Scalar(1e-14);

// The symmetric part of R^T F.
template <class Number>
[[gnu::always_inline]] inline Symmetric3<Number> stretch_of(const Matrix3<Number>& rotation, const Matrix3<Number>& f)
{
    const auto entry = [&](int i, int j) {
        return rotation.m[i] * f.m[j] + (rotation.m[3 + i] * f.m[3 + j] + rotation.m[6 + i] * f.m[6 + j]);
    };
    const Number half = NumberFunctions<Number>::of(0.5);
    return {entry(0, 0), half * (entry(0, 1) + entry(1, 0)), half * (entry(0, 2) + entry(2, 0)),
            entry(1, 1), half * (entry(1, 2) + entry(2, 1)), entry(2, 2)};
}

// Step 1, in descending order. cos(phi) = 1/2 + u is the largest root of 4 c^3 - 3 c = r, so that 4 u^3 + 6 u^2 = 1 +
// r.
template <class Number>
[[gnu::always_inline]] inline Three<Number> eigenvalues(const Symmetric3<Number>& s)
{
    using Of = NumberFunctions<Number>;
    const Number q = (s.a00 + s.a11 + s.a22) * Of::of(1.0 / 3.0);
    const Number d0 = s.a00 - q, d1 = s.a11 - q, d2 = s.a22 - q;
    const Number off = s.a01 * s.a01 + (s.a02 * s.a02 + s.a12 * s.a12);
    const Number p = Of::root((d0 * d0 + (d1 * d1 + d2 * d2) + (off + off)) * Of::of(1.0 / 6.0));
    const Number scale = Number(1) / Of::larger(p, Of::of(1e-18));
    const Number b0 = d0 * scale, b1 = d1 * scale, b2 = d2 * scale, b01 = s.a01 * scale, b02 = s.a02 * scale,
                 b12 = s.a12 * scale;
    const Number det = b0 * (b1 * b2 - b12 * b12) - b01 * (b01 * b2 - b12 * b02) + b02 * (b01 * b12 - b1 * b02);
    const Number one_plus_r = Of::larger(-Of::larger(Of::of(-0.5) * det - Number(1), Number(-2)), Number(0));
    // The first guess is within 4 % of u; each step squares that.
    const Number root = Of::root(one_plus_r * Of::of(1.0 / 6.0));
    Number u = root * Of::root(Number(6) / (Number(6) + Of::of(3.6) * root));
    for (int step = 0; step < 3; ++step)
        u = u - (((Number(4) * u + Number(6)) * u) * u - one_plus_r) /
                    Of::larger((Number(12) * u + Number(12)) * u, Of::of(1e-18));
    const Number cosine = Of::of(0.5) + u, sine = Of::root(Of::larger(Number(1) - cosine * cosine, Number(0)));
    const Number half_of_two_p = p * cosine, across = p * sine * Of::of(1.7320508075688772);
    return {q + (half_of_two_p + half_of_two_p), q - (half_of_two_p - across), q - (half_of_two_p + across)};
}

// The larger root of y^2 - s y + kappa = 0, and its distance 2 y - s from the middle of both, twice.
template <class Number>
struct LargerRoot {
    Number y, apart;
};
template <class Number>
[[gnu::always_inline]] inline LargerRoot<Number> larger_root(Number s, Number kappa)
{
    using Of = NumberFunctions<Number>;
    const Number apart = Of::root(Of::larger(s * s - Number(4) * kappa, Number(0)));
    return {Of::of(0.5) * (s + apart), apart};
}

template <class Number>
struct UnitProduct {
    Three<Number> y;
    Number kappa;
    Number beyond;  // |y_1 y_2 y_3 - 1|; not a number, or large, where there is no result
};

// Step 2. The product grows with y_3 between the bounds: from s_3 to 1 where s_1 s_2 s_3 < 1, and else from s_3 / 2 to
// s_3. Where it is above one at s_3 / 2, the result is not unique or nearly so, and is refused.
template <class Number>
[[gnu::always_inline]] inline UnitProduct<Number> nearest_unit_product(const Three<Number>& s, Number rounding)
{
    using Of = NumberFunctions<Number>;
    const Number zero = Number(0), one = Number(1), half = Of::of(0.5);
    const Number s12 = s.first * s.second, volume = s12 * s.third, at_least = Of::larger(s.third, zero);
    Number low = Of::where_less(volume, one, at_least, half * s.third),
           high = Of::where_less(volume, one, one, s.third);
    // kappa is (J - 1) J / |cof S|^2 to first order.
    const Number s13 = s.first * s.third, s23 = s.second * s.third;
    const Number guess = s.third - (volume - one) * s12 / (s12 * s12 + (s13 * s13 + s23 * s23));
    Number y = Of::where_less(low, guess, Of::where_less(guess, high, guess, high), high);
    UnitProduct<Number> result{{y, y, y}, zero, one};
    constexpr int most_steps = 24;
    for (int step = 0; step < most_steps; ++step) {
        const Number kappa = y * (s.third - y);
        const LargerRoot<Number> first = larger_root(s.first, kappa), second = larger_root(s.second, kappa);
        const Number others = first.y * second.y, excess = others * y - one;
        result = {{first.y, second.y, y}, kappa, Of::magnitude(excess)};
        if (!Of::any_less(rounding, result.beyond)) break;
        low = Of::where_less(excess, zero, y, low);
        high = Of::where_less(excess, zero, high, y);
        const Number change = s.third - (y + y);  // d kappa / dy; a larger root changes by -1 / apart with kappa
        const Number slope = others - y * change * (second.y / first.apart + first.y / second.apart);
        const Number next = y - excess / slope, middle = half * (low + high);
        y = Of::where_less(rounding, result.beyond,
                           Of::where_less(low, next, Of::where_less(next, high, next, middle), middle), y);
    }
    return result;
}

// S and g(S) for F = R S.
template <class Number>
struct Stretches {
    Symmetric3<Number> of_f, unit_volume;
    Number beyond;        // |det g(S) - 1|
    Number least_of_p23;  // (P_23 - kappa) / P_23, above zero; see least_share
};

// Step 3: g(S) = y_1 + [s_1, s_2] (S - s_1) + [s_1, s_2, s_3] (S - s_1) (S - s_2).
template <class Number>
[[gnu::always_inline]] inline Stretches<Number> nearest_unit_volume(const Symmetric3<Number>& s, Number rounding)
{
    const Three<Number> eigen = eigenvalues(s);
    const UnitProduct<Number> unit = nearest_unit_product(eigen, rounding);
    const Number kappa = unit.kappa, p12 = unit.y.first * unit.y.second, p13 = unit.y.first * unit.y.third;
    const Number p23 = unit.y.second * unit.y.third, q12 = p12 - kappa, q13 = p13 - kappa, q23 = p23 - kappa;
    const Number second = -kappa / (q12 * (q13 * q23)), first = p12 / q12;
    const Number a0 = s.a00 - eigen.first, a1 = s.a11 - eigen.first, a2 = s.a22 - eigen.first;
    const Number b0 = s.a00 - eigen.second, b1 = s.a11 - eigen.second, b2 = s.a22 - eigen.second;
    const Number c01 = s.a01 * s.a01, c02 = s.a02 * s.a02, c12 = s.a12 * s.a12;
    const Symmetric3<Number> g = {unit.y.first + first * a0 + second * (a0 * b0 + (c01 + c02)),
                                  first * s.a01 + second * (a0 * s.a01 + (s.a01 * b1 + s.a02 * s.a12)),
                                  first * s.a02 + second * (a0 * s.a02 + (s.a01 * s.a12 + s.a02 * b2)),
                                  unit.y.first + first * a1 + second * (a1 * b1 + (c01 + c12)),
                                  first * s.a12 + second * (s.a01 * s.a02 + (a1 * s.a12 + s.a12 * b2)),
                                  unit.y.first + first * a2 + second * (a2 * b2 + (c02 + c12))};
    return {s, g, unit.beyond, q23 / p23};
}

}  // namespace local_shape_formula

using local_shape_formula::Symmetric3;
using rotation_formula::Matrix3;

template <typename Scalar>
using LaneMask = typename Lanes<Scalar>::mask_type;

template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> squares(const Symmetric3<Lanes<Scalar>>& s)
{
    const Lanes<Scalar> off = s.a01 * s.a01 + (s.a02 * s.a02 + s.a12 * s.a12);
    return s.a00 * s.a00 + (s.a11 * s.a11 + s.a22 * s.a22) + (off + off);
}

// Row `i` of the matrix, times the vector.
template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> row_times(const Matrix3<Lanes<Scalar>>& a, int i, const Lanes<Scalar>& x,
                                                      const Lanes<Scalar>& y, const Lanes<Scalar>& z)
{
    return a.m[3 * i] * x + (a.m[3 * i + 1] * y + a.m[3 * i + 2] * z);
}

// F = edges * inverse_edges.
template <typename Scalar>
[[gnu::always_inline]] inline Matrix3<Lanes<Scalar>> deformation_gradient(const Matrix3<Lanes<Scalar>>& inverse,
                                                                          const LaneMatrix<Scalar>& edges)
{
    Matrix3<Lanes<Scalar>> f;
    for (int j = 0; j < 3; ++j) {
        const LaneVector<Scalar> column = combined(edges, inverse.m[j], inverse.m[3 + j], inverse.m[6 + j]);
        f.m[j] = column.x;
        f.m[3 + j] = column.y;
        f.m[6 + j] = column.z;
    }
    return f;
}

template <typename Scalar>
struct Stress {
    Matrix3<Lanes<Scalar>> p;  // derivative of the energy per volume by F; zero where it is refused
    Lanes<Scalar> energy;      // per volume
    LaneMask<Scalar> sound;
};

// With F = R S: weights (F - R) and (F - D) = R (S - g(S)).
template <typename Scalar>
[[gnu::always_inline]] inline Stress<Scalar> stress_of(const Matrix3<Lanes<Scalar>>& f, Scalar strain, Scalar volume)
{
    using namespace local_shape_formula;
    using Number = Lanes<Scalar>;
    constexpr Scalar rounding = product_rounding<Scalar>;
    Matrix3<Number> r;
    const Number determinant = rotation_formula::nearest(f, Number(rotation_formula::largest_correction<Scalar>), r);
    const Stretches<Number> stretches = nearest_unit_volume(stretch_of(r, f), Number(rounding));
    const Symmetric3<Number>&s = stretches.of_f, &g = stretches.unit_volume;
    const Symmetric3<Number> e = {s.a00 - Scalar(1), s.a01, s.a02, s.a11 - Scalar(1), s.a12, s.a22 - Scalar(1)};
    const Symmetric3<Number> v = {s.a00 - g.a00, s.a01 - g.a01, s.a02 - g.a02,
                                  s.a11 - g.a11, s.a12 - g.a12, s.a22 - g.a22};
    const Number a00 = strain * e.a00 + volume * v.a00, a01 = strain * e.a01 + volume * v.a01,
                 a02 = strain * e.a02 + volume * v.a02;
    const Number a11 = strain * e.a11 + volume * v.a11, a12 = strain * e.a12 + volume * v.a12,
                 a22 = strain * e.a22 + volume * v.a22;
    Stress<Scalar> result;
    result.sound = determinant > Number(rotation_formula::least_determinant<Scalar>) &&
                   stretches.beyond < Number(8 * rounding) && stretches.least_of_p23 > Number(Scalar(least_share));
    result.energy = Scalar(0.5) * (strain * squares<Scalar>(e) + volume * squares<Scalar>(v));
    where(!result.sound, result.energy) = Scalar(0);
    for (int i = 0; i < 3; ++i) {
        result.p.m[3 * i] = row_times<Scalar>(r, i, a00, a01, a02);
        result.p.m[3 * i + 1] = row_times<Scalar>(r, i, a01, a11, a12);
        result.p.m[3 * i + 2] = row_times<Scalar>(r, i, a02, a12, a22);
        for (int j = 0; j < 3; ++j) where(!result.sound, result.p.m[3 * i + j]) = Scalar(0);
    }
    return result;
}

template <typename Scalar>
[[gnu::always_inline]] inline void add_spring(const Lanes<Scalar>& w, const Vertices<Scalar>& a,
                                              const Vertices<Scalar>& b, Vertices<Scalar>& on_a, Vertices<Scalar>& on_b,
                                              Lanes<Scalar>& energy)
{
    const LaneVector<Scalar> edge = b - a;
    add(Lanes<Scalar>(-w), edge, on_a);
    add(w, edge, on_b);
    energy += Scalar(0.5) * w * dot(edge, edge);
}

// As many tets as there are lanes; returns their energy. ProjectiveEnergy, line by line.
template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> add_gradient_of_part(const ProjectiveBatch<Scalar>& batch, int first,
                                                                 Scalar strain, Scalar volume, const Scalar* x,
                                                                 Scalar* gradient, LaneMask<Scalar>& refused)
{
    using Number = Lanes<Scalar>;
    Vertices<Scalar> p[4], g[4];
    for (int i = 0; i < 4; ++i) p[i] = gather(x, batch.offset[i] + first);
    Matrix3<Number> inverse;
    for (int k = 0; k < 9; ++k) inverse.m[k] = load(batch.inverse_edges[k] + first);
    const Number rest = load(batch.volume + first);
    const LaneMatrix<Scalar> edges{{p[1] - p[0], p[2] - p[0], p[3] - p[0]}};
    const Stress<Scalar> stress = stress_of<Scalar>(deformation_gradient<Scalar>(inverse, edges), strain, volume);
    refused = !stress.sound && rest > Scalar(0);
    for (int i = 0; i < 4; ++i) g[i] = gather(static_cast<const Scalar*>(gradient), batch.offset[i] + first);
    for (int k = 0; k < 3; ++k) {
        const auto force = [&](int i) {
            return rest * row_times<Scalar>(stress.p, i, inverse.m[3 * k], inverse.m[3 * k + 1], inverse.m[3 * k + 2]);
        };
        const LaneVector<Scalar> on = {force(0), force(1), force(2)};
        add(Number(Scalar(1)), on, g[k + 1]);
        add(Number(Scalar(-1)), on, g[0]);
    }
    Number energy = rest * stress.energy;
    constexpr int ends_of_edge[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    for (int e = 0; e < 6; ++e) {
        const auto [a, b] = ends_of_edge[e];
        add_spring<Scalar>(load(batch.w[e] + first), p[a], p[b], g[a], g[b], energy);
    }
    for (int i = 0; i < 4; ++i) scatter(g[i], gradient, batch.offset[i] + first);
    return energy;
}

}  // namespace

template <typename Scalar>
double add_gradient_of_projective_tets(const ProjectiveBatch<Scalar>* batches, int count, Scalar strain, Scalar volume,
                                       const Scalar* x, Scalar* gradient, int* refused, int* refused_count)
{
    return sum_of_parts<Scalar>(count, [&](int b, int first) {
        LaneMask<Scalar> in_part;
        const Lanes<Scalar> energy = add_gradient_of_part(batches[b], first, strain, volume, x, gradient, in_part);
        for (int lane = 0; any_of(in_part) && lane < lanes<Scalar>; ++lane)
            if (in_part[lane]) refused[(*refused_count)++] = batch_size * b + first + lane;
        return energy;
    });
}

template double add_gradient_of_projective_tets(const ProjectiveBatch<float>*, int, float, float, const float*, float*,
                                                int*, int*);
template double add_gradient_of_projective_tets(const ProjectiveBatch<double>*, int, double, double, const double*,
                                                double*, int*, int*);

}  // namespace pbs
