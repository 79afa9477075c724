// Reference: a number that counts its operations, and counts by hand on one tet (4 vertices, 6 edges; its factor has 10 entries).
#include "pbs/flesh/flesh_work.hpp"

#include "pbs/flesh/local_shape_formula.hpp"
#include "tests/support/counted_number.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::BodyCounts;
using pbs::IterationWork;
using test_support::Counted;

// Operations of the formulae at a matrix of strains of some `strain`.
int operations_of_local_shapes(double strain, double rounding)
{
    const pbs::rotation_formula::Matrix3<Counted> f = {{1.0 + strain, 0.3 * strain, -0.2 * strain,       //
                                                        0.1 * strain, 1.0 - 0.5 * strain, 0.4 * strain,  //
                                                        -0.3 * strain, 0.2 * strain, 1.0 + 0.2 * strain}};
    pbs::rotation_formula::Matrix3<Counted> rotation;
    Counted::operations = 0;
    pbs::rotation_formula::nearest(f, Counted(1e-12), rotation);
    pbs::local_shape_formula::nearest_unit_volume(pbs::local_shape_formula::stretch_of(rotation, f), Counted(rounding));
    return Counted::operations;
}

TEST(FleshWork, LocalShapesAreCountedByANumberThatCounts)
{
    using pbs::local_shape_formula::product_rounding;
    EXPECT_EQ(operations_of_local_shapes(0.1, product_rounding<float>), pbs::flops_of_local_shapes(2));
    EXPECT_EQ(operations_of_local_shapes(0.05, product_rounding<double>), pbs::flops_of_local_shapes(3));
    EXPECT_EQ(operations_of_local_shapes(0.4, product_rounding<float>), pbs::flops_of_local_shapes(3));
}

constexpr BodyCounts one_tet = {4.0, 6.0, 1.0, {10.0}};
constexpr double solve = 12 * (10 - 4) + 6 * 4;  // both triangles for x, y, z: 6 off the diagonal, 4 on it

// Per tet: 18 for the edges, 27 for three normals, 6 + 1 for the pressure, 9 + 18 + 36 for pressure and edges on the corners, 6 for the
// first corner, 12 into the gradient, 45 for the energy.
TEST(FleshWork, OfQuasiNewtonOnOneTet)
{
    const IterationWork work = pbs::work_of_quasi_newton(one_tet, 4.0, 0);
    const double tet = 18 + 27 + 6 + 1 + 27 + 6 + 36 + 12 + 45, hold = 3 + 3 + 6, six_vectors = 6 * 6;
    EXPECT_EQ(work.flops, tet + solve + 4 * (hold + six_vectors));
    // The tet has 4 indices and 8 numbers. Rows of 16 bytes: 3 for the hold, 3 for tets, 6 for the solve, 5 for each of three products and
    // sums together, 4 for copies.
    EXPECT_EQ(work.bytes, (4 * 4 + 8 * 4) + 2 * 10 * 4 + 4 * 16 * (3 + 3 + 6 + 3 * 5 + 4));
    // A pair of L-BFGS takes two products and two sums more per vertex, and reads and writes ten rows.
    const IterationWork with_pair = pbs::work_of_quasi_newton(one_tet, 4.0, 1);
    EXPECT_EQ(with_pair.flops - work.flops, 4 * 4 * 6);
    EXPECT_EQ(with_pair.bytes - work.bytes, 4 * 16 * 10);
    EXPECT_EQ(with_pair.working_set_bytes - work.working_set_bytes, 4 * 16 * 2);
}

TEST(FleshWork, OfProjectiveDynamicsOnOneTet)
{
    const IterationWork work = pbs::work_of_projective_dynamics(one_tet, 4.0);
    const double gradient = 9 + 45, stress = 3 + 6 + 18 + 45, energy = 24 + 4 + 2, forces = 3 * (3 * 6 + 6), springs = 6 * (3 + 12 + 8);
    EXPECT_EQ(work.flops, gradient + stress + energy + forces + springs + pbs::flops_of_local_shapes(2) + solve + 4 * (12 + 3 + 6));
    EXPECT_EQ(work.bytes, (4 * 4 + 16 * 4) + 2 * 10 * 4 + 4 * 16 * (3 + 3 + 6 + 4));
}

// The tet is visited from each of its four vertices.
TEST(FleshWork, OfAVertexSweepOnOneTet)
{
    const IterationWork work = pbs::work_of_vertex_sweep(one_tet, 4.0, false);
    const double visit = 3 * (3 + 6) + 6 + 9 + 6 + 3 + 6 + 12, vertex = 3 + 6 + (3 + 3 + 2 + 1 + 5) + (6 + 9) + 6;
    EXPECT_EQ(work.flops, 4 * visit + 4 * vertex);
    EXPECT_EQ(work.bytes, 4 * (3 * 4 + 5 * 4) + 4 * (4 + 4 + 3 * 16));
    EXPECT_EQ(pbs::work_of_vertex_sweep(one_tet, 4.0, true).flops - work.flops, 4 * 9) << "before + omega (x - before)";
}

// Sums by the lines of visit_part.
TEST(FleshWork, OfNeoHookeanXpbdOnOneTet)
{
    const BodyCounts with_two_modes = {4.0, 6.0, 1.0, {2.0}};
    const double tet = 9 + 45 + 27 + 18 + 1 + 9 + 90 + 8 + 2 + 17 + 19 + 2 + 19 + 4 + 8 + 2 + 27 + 45 + 9 + 18 + 6;
    const double residual = 27 + 9 + 19 + 19 + 9 + 9, mode = 24 + 9 + 3 + 4 + 24, step = 12 + 12 + 2;
    EXPECT_EQ(pbs::work_of_neo_hookean_xpbd(with_two_modes, 4.0, false, 1).flops, tet + 2 * mode + 4 * step);
    EXPECT_EQ(pbs::work_of_neo_hookean_xpbd(with_two_modes, 4.0, true, 2).flops, tet + residual + 2 * mode + 4 * step / 2);
    // 17 numbers of a tet come in, and both multipliers in and out; of a mode 9 in and 3 in and out.
    EXPECT_EQ(pbs::work_of_neo_hookean_xpbd(with_two_modes, 4.0, false, 1).bytes,
              (4 * 4 + 17 * 4 + 4 * 4) + 2 * (4 + (9 + 6) * 4) + 4 * 16 * (4 + 10));
}

}  // namespace
