#include "pbs/skinning/skinning_work.hpp"

namespace pbs {
namespace {

using namespace flop_counts;

constexpr double index_bytes = 4;
constexpr double moved_point = 3 * scaled_and_added;  // a 3 x 4 matrix times a point
// 2 / |r|^2; u; the moved point.
constexpr double moved_by_dual_quaternion = 8 + 3 * 6 + 3 * 9;
constexpr double nearest_rotation = 691;  // see flesh_work.cpp
constexpr double matrix_entries = 12, dual_quaternion_entries = 8;

IterationWork blend(const BodyCounts& body, double scalar_bytes, double flops)
{
    const double positions = 3 * (scalar_bytes + sizeof(double)) * body.vertices;
    const double weights = (index_bytes + scalar_bytes) * body.kept.entries + index_bytes * body.vertices;
    return {flops, positions + weights, positions + weights};
}

}  // namespace

IterationWork work_of_linear_blend(const BodyCounts& body, double scalar_bytes)
{
    return blend(body, scalar_bytes, 2 * matrix_entries * body.kept.entries + moved_point * body.vertices);
}

IterationWork work_of_dual_quaternion_blend(const BodyCounts& body, double scalar_bytes)
{
    return blend(body, scalar_bytes,
                 2 * dual_quaternion_entries * body.kept.entries + moved_by_dual_quaternion * body.kept.rows +
                     moved_point * (body.vertices - body.kept.rows));
}

// A step: the sum over the neighbours, two of each edge; the mean, its difference, the share of it. At the end, for each neighbour: both
// edges and nine sums; for each vertex: the nearest rotation, R detail, the sum. Points are rows of four numbers; at the end the smoothed
// ones of both shapes and the detail come in.
IterationWork work_of_delta_mush(const BodyCounts& body, double scalar_bytes, int iterations)
{
    IterationWork work = work_of_linear_blend(body, scalar_bytes);
    const double neighbours = 2 * body.edges, row = 4 * scalar_bytes;
    const double neighbour_bytes = index_bytes * neighbours + index_bytes * body.vertices;
    work.flops += iterations * (sum * neighbours + (scaled + sum + scaled_and_added) * body.vertices) +
                  (2 * sum + 3 * scaled_and_added) * neighbours + (nearest_rotation + 3 * dot + sum) * body.vertices;
    work.bytes += iterations * (neighbour_bytes + (2 * row + scalar_bytes) * body.vertices) + neighbour_bytes +
                  (3 * row + 3 * scalar_bytes) * body.vertices;
    work.working_set_bytes += neighbour_bytes + (4 * row + scalar_bytes) * body.vertices;
    return work;
}

// A pair of vertex and bone costs the moved centre, three columns of four sums each, and the blended centre (4 multiply-adds). A vertex
// costs the origin, the nearest rotation (see flesh_work.cpp), R detail, and the sum. Moments are 13 numbers and an index; centre and
// detail are rows of four.
IterationWork work_of_direct_mush(const BodyCounts& body, double scalar_bytes)
{
    const double of_pair = (moved_point + sum) + 3 * (4 * scaled_and_added) + 4 * scaled_and_added;
    const double of_vertex = moved_point + nearest_rotation + 3 * dot + sum;
    const double bytes = (index_bytes + 13 * scalar_bytes) * body.kept.entries + (index_bytes + (8 + 3) * scalar_bytes) * body.vertices;
    return {of_pair * body.kept.entries + of_vertex * body.vertices, bytes, bytes};
}

}  // namespace pbs
