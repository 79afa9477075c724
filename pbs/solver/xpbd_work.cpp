#include "pbs/solver/xpbd_work.hpp"

namespace pbs {
namespace {

using namespace flop_counts;

constexpr double index_bytes = 4;
constexpr double multiplier = 5 + 1;                       // its change by compliance over dt^2, and its sum
constexpr double corrected = 1 + scaled_and_added;         // w times the step, times the gradient
constexpr double distance = sum + (dot + 1) + 1 + scaled;  // of two points, less that at rest, and its direction
constexpr double weighed_gradient = dot + 1;               // w |g|^2

constexpr double bind = distance + weighed_gradient + multiplier + corrected;
constexpr double stretch = distance + 2 * weighed_gradient + 1 + multiplier + 2 * corrected;
// Three edges; three sixths of normals; that of the first corner; 6 V through one of them.
constexpr double volume = 3 * sum + 3 * (cross + scaled) + 2 * sum + (dot + 1) + 4 * weighed_gradient + 3 + multiplier + 4 * corrected;

// Indices, rest value and compliance in, the multiplier in and out.
double constraint_bytes(int vertices, double scalar_bytes)
{
    return vertices * index_bytes + 4 * scalar_bytes;
}

}  // namespace

// Positions pass in and out for each class; inverse masses and bind points pass in.
IterationWork work_of_xpbd(const BodyCounts& body, bool has_volumes, double scalar_bytes)
{
    const double tets = has_volumes ? body.tets : 0.0, classes = has_volumes ? 3 : 2;
    const double constraints = constraint_bytes(1, scalar_bytes) * body.vertices + constraint_bytes(2, scalar_bytes) * body.edges +
                               constraint_bytes(4, scalar_bytes) * tets;
    const double once = scalar_bytes * (body.vertices + body.edges + tets);  // a multiplier is kept once
    return {bind * body.vertices + stretch * body.edges + volume * tets,
            constraints + (classes * (2 * 3 + 1) + 3) * scalar_bytes * body.vertices,
            constraints - once + (3 + 1 + 3) * scalar_bytes * body.vertices};
}

}  // namespace pbs
