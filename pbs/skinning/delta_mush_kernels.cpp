#include "pbs/skinning/skinning_kernels.hpp"

#include "pbs/packed/lanes.hpp"

#pragma GCC diagnostic ignored "-Wpsabi"  // wide vectors never pass from here to another file

#define PBS_INLINE [[gnu::always_inline]] inline

namespace pbs {
namespace {

constexpr int tile = 64;  // vertices whose covariances wait in the nearest cache, to be decomposed side by side

// Vertices whose rotations are computed side by side: posed = centre + R detail.
template <class Scalar>
struct Tile {
    alignas(64) Scalar covariance[9][tile];  // from row to row
    alignas(64) Scalar detail[3][tile];
    alignas(64) Scalar centre[3][tile];
    alignas(64) Scalar determinant[tile];

    PBS_INLINE void set(int i, const Four<Scalar> (&columns)[3], const Scalar* own_detail, Four<Scalar> own_centre)
    {
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) covariance[3 * row + column][i] = columns[column][row];
            detail[row][i] = own_detail[row];
            centre[row][i] = own_centre[row];
        }
    }
};

// Adds R detail to the centres, and zero where R is refused.
template <class Scalar>
void turn(Tile<Scalar>& vertices, int n)
{
    using Number = Lanes<Scalar>;
    for (int i = 0; i < n; i += lanes<Scalar>) {
        rotation_formula::Matrix3<Number> from, r;
        for (int k = 0; k < 9; ++k) from.m[k] = load(&vertices.covariance[k][i]);
        const Number determinant =
            rotation_formula::nearest(from, Number(rotation_formula::largest_correction<Scalar>), r);
        const Number d[3] = {load(&vertices.detail[0][i]), load(&vertices.detail[1][i]), load(&vertices.detail[2][i])};
        const auto sound = determinant > Number(rotation_formula::least_determinant<Scalar>);
        for (int row = 0; row < 3; ++row) {
            Number change = r.m[3 * row] * d[0] + (r.m[3 * row + 1] * d[1] + r.m[3 * row + 2] * d[2]);
            where(!sound, change) = Number(0);
            store(Number(load(&vertices.centre[row][i]) + change), &vertices.centre[row][i]);
        }
        store(determinant, &vertices.determinant[i]);
    }
}

template <class Scalar>
void hand_out(const Tile<Scalar>& vertices, int start, int n, Scalar* posed, RefusedRotations<Scalar>& refused)
{
    for (int i = 0; i < n; ++i) {
        for (int axis = 0; axis < 3; ++axis) posed[3L * (start + i) + axis] = vertices.centre[axis][i];
        if (vertices.determinant[i] > rotation_formula::least_determinant<Scalar>) continue;
        refused.vertex[refused.n] = start + i;
        for (int k = 0; k < 9; ++k) refused.covariance[refused.n][k] = vertices.covariance[k][i];
        ++refused.n;
    }
}

// fill(vertex, place in the tile) for all vertices, and their rotations tile by tile.
template <class Scalar, class Fill>
PBS_INLINE void turn_all(int vertices, Scalar* posed, RefusedRotations<Scalar>& refused, const Fill& fill)
{
    Tile<Scalar> waiting = {};
    for (int start = 0; start < vertices; start += tile) {
        const int n = vertices - start < tile ? vertices - start : tile;
        for (int i = 0; i < n; ++i) fill(start + i, i, waiting);
        turn(waiting, n);
        hand_out(waiting, start, n, posed, refused);
    }
}

template <int which, class Scalar>
PBS_INLINE Four<Scalar> everywhere(Four<Scalar> row)
{
    return __builtin_shufflevector(row, row, which, which, which, which);
}

// Adds the sum over the neighbours of (posed edge) (rest edge)^T, column by column.
template <class Scalar>
PBS_INLINE void add_edges(const NeighbourRows<Scalar>& rows, const EdgeRows<Scalar>& shape, int vertex,
                          Four<Scalar> (&columns)[3])
{
    const Four<Scalar> point = load_four(shape.posed + 4L * vertex), rest = load_four(shape.rest + 4L * vertex);
    for (int k = rows.first[vertex]; k < rows.first[vertex + 1]; ++k) {
        const Four<Scalar> edge = load_four(shape.posed + 4L * rows.neighbour[k]) - point;
        const Four<Scalar> rest_edge = load_four(shape.rest + 4L * rows.neighbour[k]) - rest;
        columns[0] += edge * everywhere<0, Scalar>(rest_edge);
        columns[1] += edge * everywhere<1, Scalar>(rest_edge);
        columns[2] += edge * everywhere<2, Scalar>(rest_edge);
    }
}

}  // namespace

template <class Scalar>
void smooth_points(const NeighbourRows<Scalar>& rows, Scalar step, const Scalar* from, Scalar* to)
{
    for (int i = 0; i < rows.n; ++i) {
        const Four<Scalar> point = load_four(from + 4L * i);
        Four<Scalar> even = {}, odd = {};
        int k = rows.first[i];
        for (; k + 1 < rows.first[i + 1]; k += 2) {
            even += load_four(from + 4L * rows.neighbour[k]);
            odd += load_four(from + 4L * rows.neighbour[k + 1]);
        }
        if (k < rows.first[i + 1]) even += load_four(from + 4L * rows.neighbour[k]);
        const Scalar share = rows.one_over[i] > 0 ? step : 0;
        store_four<Scalar>(point + share * ((even + odd) * rows.one_over[i] - point), to + 4L * i);
    }
}

template <class Scalar>
void add_detail(const NeighbourRows<Scalar>& rows, const EdgeRows<Scalar>& smooth, const EdgeRows<Scalar>& unsmoothed,
                const Scalar* detail, Scalar* posed, RefusedRotations<Scalar>& refused)
{
    turn_all(rows.n, posed, refused, [=](int vertex, int place, Tile<Scalar>& waiting) {
        Four<Scalar> columns[3] = {}, wide[3] = {};
        add_edges<Scalar>(rows, smooth, vertex, columns);
        if (unsmoothed.share > 0) {
            add_edges<Scalar>(rows, unsmoothed, vertex, wide);
            for (int column = 0; column < 3; ++column) columns[column] += unsmoothed.share * wide[column];
        }
        waiting.set(place, columns, detail + 4L * vertex, load_four(smooth.posed + 4L * vertex));
    });
}

// The centre of a vertex is moved relative to where its first bone moves it, so that differences of nearby points lose
// no digits.
template <class Scalar>
void move_by_moments(const MomentRows<Scalar>& rows, const PaddedMatrix<Scalar>* bones, Scalar* posed,
                     RefusedRotations<Scalar>& refused)
{
    turn_all(rows.n, posed, refused, [=](int vertex, int place, Tile<Scalar>& waiting) {
        const Scalar* c = rows.centre + 4L * vertex;
        const auto moved = [c](const Scalar* matrix) {
            return load_four(matrix) * c[0] +
                   (load_four(matrix + 4) * c[1] + (load_four(matrix + 8) * c[2] + load_four(matrix + 12)));
        };
        const Four<Scalar> origin = moved(bones[rows.moments[rows.first[vertex]].bone].numbers);
        Four<Scalar> columns[3] = {}, centre = origin;
        for (int k = rows.first[vertex]; k < rows.first[vertex + 1]; ++k) {
            const BoneMoments<Scalar>& moments = rows.moments[k];
            const Scalar* matrix = bones[moments.bone].numbers;
            const Four<Scalar> x = load_four(matrix), y = load_four(matrix + 4), z = load_four(matrix + 8),
                               to = moved(matrix) - origin;
            const Scalar *p = moments.second, *m = moments.first, *share = moments.share;
            columns[0] += (x * p[0] + y * p[1]) + (z * p[2] + to * m[0]);
            columns[1] += (x * p[1] + y * p[3]) + (z * p[4] + to * m[1]);
            columns[2] += (x * p[2] + y * p[4]) + (z * p[5] + to * m[2]);
            centre += (to * moments.weight + x * share[0]) + (y * share[1] + z * share[2]);
        }
        waiting.set(place, columns, rows.detail + 4L * vertex, centre);
    });
}

#define PBS_MUSH_KERNELS(Scalar)                                                                             \
    template void smooth_points(const NeighbourRows<Scalar>&, Scalar, const Scalar*, Scalar*);               \
    template void add_detail(const NeighbourRows<Scalar>&, const EdgeRows<Scalar>&, const EdgeRows<Scalar>&, \
                             const Scalar*, Scalar*, RefusedRotations<Scalar>&);                             \
    template void move_by_moments(const MomentRows<Scalar>&, const PaddedMatrix<Scalar>*, Scalar*,           \
                                  RefusedRotations<Scalar>&);
PBS_MUSH_KERNELS(float)
PBS_MUSH_KERNELS(double)

}  // namespace pbs
