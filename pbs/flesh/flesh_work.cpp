#include "pbs/flesh/flesh_work.hpp"

namespace pbs {
namespace {

using namespace flop_counts;

constexpr double index_bytes = 4;
constexpr double numbers_of_row = 4;
constexpr double of_rows = 6;  // operations of an inner product, or of a sum a + s b, per vertex

// set_gradient_of_hold: x - c; times a; the energy.
constexpr double hold = sum + scaled + dot + 1;
constexpr double rows_of_hold = 3;  // centres and x in, the gradient out
constexpr double rows_of_tets = 3;  // x in, the gradient in and out

// add_gradient_of_tets: six edges; three normals; 6 V - d; the pressure; its forces and those of three edges on the other corners; their
// sum on the first one; the other edges on both ends; into the gradient; the energy.
constexpr double flesh_tet = 6 * sum + 3 * cross + (dot + 1) + 1 + 3 * (scaled + scaled_and_added) + 2 * sum + 6 * scaled_and_added +
                             4 * sum + (6 * (dot + 1) + 5 + 4);
constexpr double flesh_tet_numbers = 8;

// add_gradient_of_projective_tets without the local shapes: three edges; F; S - 1; S - g(S); both weighed; both squared; the energy; P;
// three forces, into the gradient twice; six springs with their energy; the sum of energies.
constexpr double projective_tet = 3 * sum + 9 * dot + 3 + 6 + 6 * 3 + 2 * 12 + 4 + 9 * dot + 3 * (3 * (dot + 1) + 2 * sum) +
                                  6 * (sum + 2 * scaled_and_added + dot + 3) + 2;
constexpr double projective_tet_numbers = 16;
// Counted by a number that counts: tests/unit/pbs/flesh/flesh_work.cpp.
constexpr double nearest_rotation = 691, stretch = 51, eigenvalues = 93, first_guess = 14, unit_product = 17, newton_step = 12,
                 polynomial = 65;

// add_incidence: three differences with their springs; two edges and their normal; 6 V - d; kappa n; its force; the block.
constexpr double incidence = 3 * (sum + scaled_and_added) + 2 * sum + cross + (dot + 1) + scaled + scaled_and_added + 6 * 2;
constexpr double incidence_numbers = 5, incidence_indices = 3;
// The hold; the factors of the block (3 + 3 + 2 + 1 + 5); both triangular solves (6 + 9); the step.
constexpr double moved_vertex = (sum + scaled_and_added) + 14 + 15 + scaled_and_added;

// visit_part of a tet: three edges; F; H; |F| and its inverse; D; H S and D S; both right-hand sides; three inner products with S; the
// 2 x 2 system (2 + 1 + 1 + 2 + 4); changes and multipliers; the matrix that is applied; forces; positions.
constexpr double inner = 3 * dot + 2, combination = 5 * 3;
constexpr double neo_hookean_tet = 3 * sum + 3 * combination + 3 * cross + (inner + 2) + 9 + 6 * combination + (dot + 3 + 2) + 3 * inner +
                                   10 + 8 + 2 + 27 + 3 * (combination + sum) + 4 * scaled_and_added;
constexpr double neo_hookean_numbers = 9 + 6 + 2 + 2 * 2;  // multipliers in and out
constexpr double residual_tet = 27 + 9 + 2 * (inner + 2) + 2 * 9, residual_numbers = 2 * 9;
// C in x, y and z; the change; the multiplier; w v; four corrections.
constexpr double mode = 3 * 8 + 9 + 3 + 4 + 4 * scaled_and_added, mode_numbers = 4 + 1 + 1 + 3 + 2 * 3;
// begin_step and end_step.
constexpr double step_vertex = 3 * 4 + 3 * 4 + 2, step_rows = 6 + 4;

double row_bytes(double scalar_bytes)
{
    return numbers_of_row * scalar_bytes;
}

double tet_bytes(double numbers, double scalar_bytes)
{
    return 4 * index_bytes + numbers * scalar_bytes;
}

// Both triangles, for three right-hand sides; diagonal entries multiply. The rows in and out, and twice those in L's order in and out.
IterationWork solve(const BodyCounts& body, double scalar_bytes)
{
    return {12 * (body.kept.entries - body.vertices) + 6 * body.vertices,
            2 * body.kept.entries * scalar_bytes + 6 * row_bytes(scalar_bytes) * body.vertices,
            body.kept.entries * scalar_bytes + row_bytes(scalar_bytes) * body.vertices};
}

}  // namespace

// Inner products: two per pair, the slope, the norm, and that of the new pair. Sums: two per pair, the step, and two for the new pair.
// Copies of rows: the gradient to the direction, and x to the next x.
IterationWork work_of_quasi_newton(const BodyCounts& body, double scalar_bytes, int history)
{
    IterationWork work = solve(body, scalar_bytes);
    const double row = row_bytes(scalar_bytes), products = 2 * history + 3, sums = 2 * history + 3;
    work.flops += flesh_tet * body.tets + (hold + of_rows * (products + sums)) * body.vertices;
    work.bytes += tet_bytes(flesh_tet_numbers, scalar_bytes) * body.tets +
                  row * (rows_of_hold + rows_of_tets + 2 * products + 3 * sums + 2 * 2) * body.vertices;
    const double vectors = 6 + 2 * history;  // centres, x, gradient, both of the next point, direction, pairs
    work.working_set_bytes += tet_bytes(flesh_tet_numbers, scalar_bytes) * body.tets + row * vectors * body.vertices;
    return work;
}

double flops_of_local_shapes(int evaluations)
{
    return nearest_rotation + stretch + eigenvalues + first_guess + unit_product * evaluations + newton_step * (evaluations - 1) +
           polynomial;
}

// x <- x - step, and the norm of the step.
IterationWork work_of_projective_dynamics(const BodyCounts& body, double scalar_bytes)
{
    IterationWork work = solve(body, scalar_bytes);
    const double row = row_bytes(scalar_bytes), shapes = flops_of_local_shapes(scalar_bytes < 8 ? 2 : 3);
    work.flops += (projective_tet + shapes) * body.tets + (hold + 2 * of_rows - 3) * body.vertices;  // a factor of one
    work.bytes += tet_bytes(projective_tet_numbers, scalar_bytes) * body.tets + row * (rows_of_hold + rows_of_tets + 3 + 1) * body.vertices;
    work.working_set_bytes += tet_bytes(projective_tet_numbers, scalar_bytes) * body.tets + row * 3 * body.vertices;
    return work;
}

// Each tet is visited once for each of its vertices. A vertex brings its row of the block, its centre, and its position, which is also
// written.
IterationWork work_of_vertex_sweep(const BodyCounts& body, double scalar_bytes, bool chebyshev)
{
    const double visits = 4 * body.tets, row = row_bytes(scalar_bytes);
    const double of_visit = incidence_indices * index_bytes + incidence_numbers * scalar_bytes, of_vertex = index_bytes + scalar_bytes;
    const double extrapolated_rows = chebyshev ? 3 : 0;
    return {incidence * visits + (moved_vertex + 3 * extrapolated_rows) * body.vertices,
            of_visit * visits + (of_vertex + (3 + extrapolated_rows) * row) * body.vertices,
            of_visit * visits + (of_vertex + (2 + extrapolated_rows / 3) * row) * body.vertices};
}

// Positions pass in and out for the springs and for the tets.
IterationWork work_of_neo_hookean_xpbd(const BodyCounts& body, double scalar_bytes, bool with_residual, int iterations_per_step)
{
    const double row = row_bytes(scalar_bytes), steps = 1.0 / iterations_per_step;
    const double numbers = neo_hookean_numbers + (with_residual ? residual_numbers : 0);
    const double kept = numbers - 2 - (with_residual ? 9 : 0);                   // what passes in and out is kept once
    const double of_mode = (4 * index_bytes) / 4 + mode_numbers * scalar_bytes;  // four modes of a tet share its indices
    return {
        (neo_hookean_tet + (with_residual ? residual_tet : 0)) * body.tets + mode * body.kept.entries + step_vertex * steps * body.vertices,
        tet_bytes(numbers, scalar_bytes) * body.tets + of_mode * body.kept.entries + row * (4 + step_rows * steps) * body.vertices,
        tet_bytes(kept, scalar_bytes) * body.tets + (of_mode - 3 * scalar_bytes) * body.kept.entries + row * 4 * body.vertices};
}

}  // namespace pbs
