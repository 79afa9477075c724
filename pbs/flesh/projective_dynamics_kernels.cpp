#include "pbs/flesh/flesh_kernels.hpp"

#include "pbs/flesh/local_shape_formula.hpp"
#include "pbs/packed/lanes.hpp"

namespace pbs {
namespace {

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
        f.m[j] = column.x, f.m[3 + j] = column.y, f.m[6 + j] = column.z;
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
    const Symmetric3<Number> v = {s.a00 - g.a00, s.a01 - g.a01, s.a02 - g.a02, s.a11 - g.a11, s.a12 - g.a12, s.a22 - g.a22};
    const Number a00 = strain * e.a00 + volume * v.a00, a01 = strain * e.a01 + volume * v.a01, a02 = strain * e.a02 + volume * v.a02;
    const Number a11 = strain * e.a11 + volume * v.a11, a12 = strain * e.a12 + volume * v.a12, a22 = strain * e.a22 + volume * v.a22;
    Stress<Scalar> result;
    result.sound = determinant > Number(rotation_formula::least_determinant<Scalar>) && stretches.beyond < Number(8 * rounding) &&
                   stretches.least_of_p23 > Number(Scalar(least_share));
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
[[gnu::always_inline]] inline void add_spring(const Lanes<Scalar>& w, const Vertices<Scalar>& a, const Vertices<Scalar>& b,
                                              Vertices<Scalar>& on_a, Vertices<Scalar>& on_b, Lanes<Scalar>& energy)
{
    const LaneVector<Scalar> edge = b - a;
    add(Lanes<Scalar>(-w), edge, on_a);
    add(w, edge, on_b);
    energy += Scalar(0.5) * w * dot(edge, edge);
}

// As many tets as there are lanes; returns their energy. ProjectiveEnergy, line by line.
template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> add_gradient_of_part(const ProjectiveBatch<Scalar>& batch, int first, Scalar strain,
                                                                 Scalar volume, const Scalar* x, Scalar* gradient,
                                                                 LaneMask<Scalar>& refused)
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
double add_gradient_of_projective_tets(const ProjectiveBatch<Scalar>* batches, int count, Scalar strain, Scalar volume, const Scalar* x,
                                       Scalar* gradient, int* refused, int* refused_count)
{
    return sum_of_parts<Scalar>(count, [&](int b, int first) {
        LaneMask<Scalar> in_part;
        const Lanes<Scalar> energy = add_gradient_of_part(batches[b], first, strain, volume, x, gradient, in_part);
        for (int lane = 0; any_of(in_part) && lane < lanes<Scalar>; ++lane)
            if (in_part[lane]) refused[(*refused_count)++] = batch_size * b + first + lane;
        return energy;
    });
}

template double add_gradient_of_projective_tets(const ProjectiveBatch<float>*, int, float, float, const float*, float*, int*, int*);
template double add_gradient_of_projective_tets(const ProjectiveBatch<double>*, int, double, double, const double*, double*, int*, int*);

}  // namespace pbs
