#include "pbs/flesh/flesh_kernels.hpp"

#include "pbs/packed/lanes.hpp"

namespace pbs {
namespace {

// The block of a vertex in every lane; the lower triangle of H.
template <typename Scalar>
struct LaneBlock {
    LaneVector<Scalar> g;
    Lanes<Scalar> h00, h10, h11, h20, h21, h22;
};

// vertex_block, line by line.
template <typename Scalar>
[[gnu::always_inline]] inline void add_incidence(const VertexIncidence<Scalar>& tet, int first, const Scalar* x,
                                                 const Vertices<Scalar>& x_i, LaneBlock<Scalar>& block)
{
    LaneVector<Scalar> to[3];
    for (int k = 0; k < 3; ++k) {
        to[k] = gather(x, tet.other[k] + first) - x_i;
        add(Lanes<Scalar>(-load(tet.w[k] + first)), to[k], block.g);
    }
    const LaneVector<Scalar> n = cross(to[1] - to[0], to[2] - to[0]);
    const Lanes<Scalar> minus_beyond = dot(n, to[0]) + load(tet.d + first);
    const Lanes<Scalar> kappa = load(tet.kappa + first);
    const LaneVector<Scalar> kappa_n = times(kappa, n);
    add(Lanes<Scalar>(-minus_beyond), kappa_n, block.g);
    block.h00 += kappa_n.x * n.x;
    block.h10 += kappa_n.y * n.x;
    block.h11 += kappa_n.y * n.y;
    block.h20 += kappa_n.z * n.x;
    block.h21 += kappa_n.z * n.y;
    block.h22 += kappa_n.z * n.z;
}

// block_step, line by line.
template <typename Scalar>
[[gnu::always_inline]] inline LaneVector<Scalar> step(const LaneBlock<Scalar>& block, const Lanes<Scalar>& diagonal)
{
    const LaneVector<Scalar>& g = block.g;
    const Lanes<Scalar> one = Scalar(1);
    const Lanes<Scalar> inverse0 = quotient<Scalar>(one, block.h00), l10 = block.h10 * inverse0,
                        l20 = block.h20 * inverse0;
    const Lanes<Scalar> inverse1 = quotient<Scalar>(one, max(Lanes<Scalar>(block.h11 - l10 * block.h10), diagonal));
    const Lanes<Scalar> below = block.h21 - l20 * block.h10, l21 = below * inverse1;
    const Lanes<Scalar> inverse2 =
        quotient<Scalar>(one, max(Lanes<Scalar>(block.h22 - l20 * block.h20 - l21 * below), diagonal));
    const Lanes<Scalar> y1 = g.y - l10 * g.x, y2 = g.z - l20 * g.x - l21 * y1;
    const Lanes<Scalar> s2 = y2 * inverse2, s1 = y1 * inverse1 - l21 * s2, s0 = g.x * inverse0 - l10 * s1 - l20 * s2;
    return {s0, s1, s2};
}

// As many vertices as there are lanes.
template <typename Scalar>
[[gnu::always_inline]] inline void move_part(const VertexBatch<Scalar>& batch, int first,
                                             const VertexIncidence<Scalar>* incidences, const Scalar* centres,
                                             Scalar omega, Scalar* x)
{
    Vertices<Scalar> x_i = gather(static_cast<const Scalar*>(x), batch.offset + first);
    const Vertices<Scalar> centre = gather(centres, batch.offset + first);
    const Lanes<Scalar> diagonal = load(batch.diagonal + first), zero = Scalar(0);
    LaneBlock<Scalar> block{{zero, zero, zero}, diagonal, zero, diagonal, zero, zero, diagonal};
    add(centre.w, x_i - centre, block.g);
    for (int k = 0; k < batch.count; ++k)
        add_incidence(incidences[batch.first + k], first, static_cast<const Scalar*>(x), x_i, block);
    Lanes<Scalar> factor = -omega;
    where(!(diagonal > Scalar(0)), factor) = Scalar(0);
    add(factor, step(block, diagonal), x_i);
    scatter(x_i, x, batch.offset + first);
}

}  // namespace

template <typename Scalar>
void move_vertices(const VertexBatch<Scalar>* batches, int count, const VertexIncidence<Scalar>* incidences,
                   const Scalar* centres, Scalar omega, Scalar* x)
{
    for (int b = 0; b < count; ++b)
        for (int first = 0; first < batch_size; first += lanes<Scalar>)
            move_part(batches[b], first, incidences, centres, omega, x);
}

template <typename Scalar>
void extrapolate(Scalar omega, const Scalar* before, int rows, Scalar* x)
{
    for (int i = 0; i < 4 * rows; ++i) x[i] = before[i] + omega * (x[i] - before[i]);
}

template void move_vertices(const VertexBatch<float>*, int, const VertexIncidence<float>*, const float*, float, float*);
template void move_vertices(const VertexBatch<double>*, int, const VertexIncidence<double>*, const double*, double,
                            double*);
template void extrapolate(float, const float*, int, float*);
template void extrapolate(double, const double*, int, double*);

}  // namespace pbs
