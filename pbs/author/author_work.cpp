#include "pbs/author/author_work.hpp"

namespace pbs {
namespace {

using namespace flop_counts;

constexpr double index_bytes_of_author = 4, number_bytes = 8;

// Three edges; V through the normal of three corners; C; the other gradients; the sum of their squares; lambda; four corrections.
constexpr double author_volume = 3 * sum + (cross + dot + 1) + 1 + (2 * cross + 2 * sum) + (4 * dot + 3) + 2 + 4 * scaled_and_added;
// The bone's axis and its square; the parameter of the nearest point, and that point; the way to it and its length; C; the correction.
constexpr double author_bind = (sum + dot) + (sum + dot + 1) + scaled_and_added + (sum + dot + 1) + 1 + 3 + scaled_and_added;
// The edge and its length; C; the correction, which both ends take.
constexpr double author_stretch = sum + (dot + 1) + 1 + (3 + scaled) + 2 * sum;

// Indices and the value at rest.
constexpr double data_bytes(int indices)
{
    return indices * index_bytes_of_author + number_bytes;
}

}  // namespace

// A group is a pass. No vertex occurs twice in it, so each constraint brings its own vertices, in and out.
IterationWork work_of_author(const BodyCounts& body)
{
    const double data = data_bytes(4) * body.tets + data_bytes(2) * (body.vertices + body.edges);
    const double vertices_of_constraints = 4 * body.tets + body.vertices + 2 * body.edges;
    return {author_volume * body.tets + author_bind * body.vertices + author_stretch * body.edges,
            data + 2 * 3 * number_bytes * vertices_of_constraints, data + 3 * number_bytes * body.vertices};
}

}  // namespace pbs
