#include "pbs/flesh/flesh_kernels.hpp"

#include "pbs/packed/lanes.hpp"

#include <utility>

namespace pbs {
namespace {

// x, y, z and one more.
template <typename Scalar>
Four<Scalar>& row(Scalar* rows, std::uint32_t offset)
{
    return *reinterpret_cast<Four<Scalar>*>(rows + offset);
}

// Adds the gradient of as many tets as there are lanes; returns their energy. FleshEnergy, line by line.
template <typename Scalar>
[[gnu::always_inline]] inline Lanes<Scalar> add_gradient_of_part(const FleshBatch<Scalar>& batch, int first,
                                                                 const Scalar* x, Scalar* gradient)
{
    Vertices<Scalar> p[4], g[4];
    for (int i = 0; i < 4; ++i) p[i] = gather(x, batch.offset[i] + first);
    for (int i = 0; i < 4; ++i) g[i] = gather(static_cast<const Scalar*>(gradient), batch.offset[i] + first);
    const LaneVector<Scalar> p21 = p[1] - p[0], p31 = p[2] - p[0], p41 = p[3] - p[0];
    const LaneVector<Scalar> p32 = p[2] - p[1], p42 = p[3] - p[1], p43 = p[3] - p[2];
    const LaneVector<Scalar> n2 = cross(p31, p41), n3 = cross(p41, p21), n4 = cross(p21, p31);
    const Lanes<Scalar> beyond = dot(n4, p41) - load(batch.d + first);
    const Lanes<Scalar> pressure = load(batch.kappa + first) * beyond;
    Lanes<Scalar> w[6];
    for (int e = 0; e < 6; ++e) w[e] = load(batch.w[e] + first);

    const LaneVector<Scalar> zero{Scalar(0), Scalar(0), Scalar(0)};
    LaneVector<Scalar> on2 = zero, on3 = zero, on4 = zero;
    add(pressure, n2, on2);
    add(pressure, n3, on3);
    add(pressure, n4, on4);
    add(w[0], p21, on2);
    add(w[1], p31, on3);
    add(w[2], p41, on4);
    const LaneVector<Scalar> to1 = on2 + (on3 + on4);  // what pulls at 1 pulls at the others in the opposite direction
    add(Lanes<Scalar>(-w[3]), p32, on2);
    add(w[3], p32, on3);
    add(Lanes<Scalar>(-w[4]), p42, on2);
    add(w[4], p42, on4);
    add(Lanes<Scalar>(-w[5]), p43, on3);
    add(w[5], p43, on4);

    add(Lanes<Scalar>(Scalar(-1)), to1, g[0]);
    add(Lanes<Scalar>(Scalar(1)), on2, g[1]);
    add(Lanes<Scalar>(Scalar(1)), on3, g[2]);
    add(Lanes<Scalar>(Scalar(1)), on4, g[3]);
    for (int i = 0; i < 4; ++i) scatter(g[i], gradient, batch.offset[i] + first);
    const Lanes<Scalar> of_edges = w[0] * dot(p21, p21) + w[1] * dot(p31, p31) + w[2] * dot(p41, p41) +
                                   w[3] * dot(p32, p32) + w[4] * dot(p42, p42) + w[5] * dot(p43, p43);
    return Scalar(0.5) * (of_edges + pressure * beyond);
}

template <typename Scalar, int width>
void forward(const Supernode& node, const std::uint32_t* below, const Scalar* value, Scalar* work)
{
    Four<Scalar> y[width];
    for (int c = 0; c < width; ++c) {
        y[c] = row(work, 4u * (node.column + c));
        for (int d = 0; d < c; ++d) y[c] -= *value++ * y[d];
        y[c] *= *value++;
        row(work, 4u * (node.column + c)) = y[c];
    }
    for (int k = 0; k < node.rows_below; ++k, value += width) {
        Four<Scalar> b = row(work, below[k]);
#pragma GCC unroll 8
        for (int c = 0; c < width; ++c) b -= value[c] * y[c];
        row(work, below[k]) = b;
    }
}

template <typename Scalar, int width>
void backward(const Supernode& node, const std::uint32_t* below, const Scalar* values, Scalar* work)
{
    Four<Scalar> x[width];
    for (int c = 0; c < width; ++c) x[c] = row(work, 4u * (node.column + c));
    const Scalar* value = values + width * (width + 1) / 2;
    for (int k = 0; k < node.rows_below; ++k, value += width) {
        const Four<Scalar> b = row(work, below[k]);
#pragma GCC unroll 8
        for (int c = 0; c < width; ++c) x[c] -= value[c] * b;
    }
    for (int c = width - 1; c >= 0; --c) {
        const Scalar* of_row = values + c * (c + 1) / 2;
        x[c] *= of_row[c];
        for (int d = 0; d < c; ++d) x[d] -= of_row[d] * x[c];
        row(work, 4u * (node.column + c)) = x[c];
    }
}

template <typename F, int... widths>
void with_width(int width, const F& f, std::integer_sequence<int, widths...>)
{
    ((width == widths + 1 ? f(std::integral_constant<int, widths + 1>()) : void()), ...);
}

}  // namespace

template <typename Scalar>
double set_gradient_of_hold(const Scalar* centres, int rows, const Scalar* x, Scalar* gradient)
{
    constexpr int rows_in_scalar = 64;  // then on in double
    double total = 0.0;
    for (int begin = 0; begin < rows; begin += rows_in_scalar) {
        Four<Scalar> sum_of_rows{};
        for (int i = begin; i < begin + rows_in_scalar && i < rows; ++i) {
            const Four<Scalar> centre = row(const_cast<Scalar*>(centres), 4u * i),
                               from = row(const_cast<Scalar*>(x), 4u * i) - centre;
            Four<Scalar> g = centre[3] * from;
            g[3] = Scalar(0);
            row(gradient, 4u * i) = g;
            sum_of_rows += g * from;
        }
        total += double(sum_of_rows[0]) + double(sum_of_rows[1]) + double(sum_of_rows[2]);
    }
    return total / 2.0;
}

template <typename Scalar>
double add_gradient_of_tets(const FleshBatch<Scalar>* batches, int count, const Scalar* x, Scalar* gradient)
{
    return sum_of_parts<Scalar>(count,
                                [&](int b, int first) { return add_gradient_of_part(batches[b], first, x, gradient); });
}

template <typename Scalar>
double dot(const Scalar* a, const Scalar* b, int rows)
{
    constexpr int numbers_in_scalar = 256;
    double total = 0.0;
    for (int begin = 0; begin < 4 * rows; begin += numbers_in_scalar) {
        Lanes<Scalar> products = Scalar(0);
        for (int i = begin; i < begin + numbers_in_scalar && i < 4 * rows; i += lanes<Scalar>)
            products += load(a + i) * load(b + i);
        total += sum_of_lanes<Scalar>(products);
    }
    return total;
}

template <typename Scalar>
void add(Scalar factor, const Scalar* a, int rows, Scalar* to)
{
    for (int i = 0; i < 4 * rows; ++i) to[i] += factor * a[i];
}

template <typename Scalar>
void solve_supernodes(const Supernode* nodes, int count, const std::uint32_t* below, const Scalar* values,
                      const std::uint32_t* place, int rows, Scalar* b, Scalar* work)
{
    constexpr std::make_integer_sequence<int, widest_supernode> widths;
    for (int k = 0; k < rows; ++k) row(work, 4u * k) = row(b, place[k]);
    for (int n = 0; n < count; ++n)
        with_width(
            nodes[n].width,
            [&](auto width) {
                forward<Scalar, width>(nodes[n], below + nodes[n].first_below, values + nodes[n].first_value, work);
            },
            widths);
    for (int n = count - 1; n >= 0; --n)
        with_width(
            nodes[n].width,
            [&](auto width) {
                backward<Scalar, width>(nodes[n], below + nodes[n].first_below, values + nodes[n].first_value, work);
            },
            widths);
    for (int k = 0; k < rows; ++k) row(b, place[k]) = row(work, 4u * k);
}

template double set_gradient_of_hold(const float*, int, const float*, float*);
template double set_gradient_of_hold(const double*, int, const double*, double*);
template double add_gradient_of_tets(const FleshBatch<float>*, int, const float*, float*);
template double add_gradient_of_tets(const FleshBatch<double>*, int, const double*, double*);
template double dot(const float*, const float*, int);
template double dot(const double*, const double*, int);
template void add(float, const float*, int, float*);
template void add(double, const double*, int, double*);
template void solve_supernodes(const Supernode*, int, const std::uint32_t*, const float*, const std::uint32_t*, int,
                               float*, float*);
template void solve_supernodes(const Supernode*, int, const std::uint32_t*, const double*, const std::uint32_t*, int,
                               double*, double*);

}  // namespace pbs
