// Reference: properties of linear elasticity (superposition, reciprocity, independence of Young's modulus and of the numbering) and of the
// program (a stored factorisation gives the same as a new one; two solvers agree). Tolerances: rounding of a direct solve, cond(K) eps with
// a condition number of some 1e5 here: 1e-10.
#include "reference_fem/linear_elasticity.hpp"

#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace {

using namespace reference_fem;
using pbs::Positions;
using pbs::Vec3;

const pbs::TetMesh bar =
    test_support::jittered(test_support::structured_bar({0, -0.25, -0.25}, {1, 0.25, 0.25}, {8, 4, 4}), Vec3::Constant(0.125), 0.25);

// Points on two short lines inside the two ends, and one beyond the bar.
Positions tied_points()
{
    Positions points(9, 3);
    points << 0.1, 0, 0, 0.2, 0.03, 0, 0.15, 0, 0.05, 0.12, -0.1, 0.02, 0.9, 0, 0, 0.8, 0.03, 0, 0.85, 0, 0.05, 0.88, -0.1, 0.02, 3, 0, 0;
    return points;
}

Attachment springs(double factor = 1.0)
{
    return {tied_points(), factor * Eigen::VectorXd::LinSpaced(9, 1e4, 2e5), {}};
}

Positions moved_points(double x, double y)
{
    Positions targets = tied_points();
    targets.bottomRows(5).rowwise() += Eigen::RowVector3d(x, y, 0.02);
    return targets;
}

double relative_difference(const Positions& a, const Positions& b)
{
    return (a - b).norm() / (b - bar.rest).norm();
}

class LinearResponse : public testing::TestWithParam<int> {
protected:
    LinearOptions options{.element_order = GetParam(), .gravity_m_s2 = {0, -9.81, 0}};
};

TEST_P(LinearResponse, CholmodAndUmfpackAgree)
{
    LinearOptions second = options;
    second.solver = LinearSolver::umfpack;
    LinearElasticity cholmod(bar, options, springs()), umfpack(bar, second, springs());
    const SolveSummary first = cholmod.solve(moved_points(0.1, 0.1), bar.rest), other = umfpack.solve(moved_points(0.1, 0.1), bar.rest);
    EXPECT_LT(relative_difference(cholmod.positions(), umfpack.positions()), 1e-10);
    EXPECT_LT(first.residual, 1e-12);
    EXPECT_LT(other.residual, 1e-12);
}

// |e| / |u| <= cond(K) |r| / |f|: 1e5 times the tolerance of conjugate gradients, 1e-10.
TEST_P(LinearResponse, ConjugateGradientsAgreeWithCholmod)
{
    LinearOptions second = options;
    second.solver = LinearSolver::cg_ml;
    LinearElasticity cholmod(bar, options, springs()), iterative(bar, second, springs());
    cholmod.solve(moved_points(0.1, 0.1), bar.rest);
    const SolveSummary summary = iterative.solve(moved_points(0.1, 0.1), bar.rest);
    EXPECT_TRUE(summary.finite);
    EXPECT_GT(summary.iterations, 0);
    EXPECT_LT(summary.residual, 1.01e-10);
    EXPECT_LT(relative_difference(cholmod.positions(), iterative.positions()), 1e-5);
}

TEST_P(LinearResponse, DisplacementsSuperpose)
{
    LinearElasticity fem(bar, options, springs());
    const auto displacement = [&](const Positions& targets, const Vec3& gravity) -> Positions {
        fem.solve(targets, bar.rest, gravity);
        return fem.positions() - bar.rest;
    };
    const Positions pull = displacement(moved_points(0.1, 0.0), Vec3::Zero());
    const Positions weight = displacement(tied_points(), Vec3(0, -9.81, 0));
    const Positions both = displacement(tied_points() + 2.0 * (moved_points(0.1, 0.0) - tied_points()), Vec3(0, -9.81, 0));
    EXPECT_LT((2.0 * pull + weight - both).norm() / both.norm(), 1e-10);
}

TEST_P(LinearResponse, WithoutLoadsYoungsModulusCancels)
{
    LinearOptions stiff = options, soft = options;
    stiff.gravity_m_s2 = soft.gravity_m_s2 = Vec3::Zero();
    stiff.young_pa = 1e3 * soft.young_pa;
    LinearElasticity hard(bar, stiff, springs(1e3)), weak(bar, soft, springs());
    hard.solve(moved_points(0.1, 0.1), bar.rest);
    weak.solve(moved_points(0.1, 0.1), bar.rest);
    EXPECT_LT(relative_difference(hard.positions(), weak.positions()), 1e-10);
}

TEST_P(LinearResponse, AKeptFactorGivesWhatAFreshOneGivesToTheBit)
{
    LinearElasticity kept(bar, options, springs()), fresh(bar, options, springs());
    for (const double x : {0.3, -0.2, 0.0}) kept.solve(moved_points(x, x), bar.rest);
    kept.solve(moved_points(0.1, 0.1), bar.rest);
    fresh.solve(moved_points(0.1, 0.1), bar.rest);
    EXPECT_EQ(kept.positions(), fresh.positions());
}

TEST_P(LinearResponse, TheRestPoseIsReturnedToTheBit)
{
    LinearOptions weightless = options;
    weightless.gravity_m_s2 = Vec3::Zero();
    LinearElasticity fem(bar, weightless, springs());
    fem.solve(moved_points(0.1, 0.1), bar.rest);
    const SolveSummary summary = fem.solve(tied_points(), bar.rest);
    EXPECT_EQ(fem.positions(), bar.rest);
    EXPECT_EQ(summary.residual, 0.0);
}

TEST_P(LinearResponse, NumberingOfVerticesAndTetsDoesNotMatter)
{
    std::vector<int> order(bar.rest.rows()), tet_order(bar.tets.rows());
    std::iota(order.begin(), order.end(), 0);
    std::iota(tet_order.begin(), tet_order.end(), 0);
    std::mt19937 random(5);
    std::shuffle(order.begin(), order.end(), random);
    std::shuffle(tet_order.begin(), tet_order.end(), random);
    pbs::TetMesh shuffled = bar;
    for (Eigen::Index v = 0; v < bar.rest.rows(); ++v) shuffled.rest.row(order[v]) = bar.rest.row(v);
    for (Eigen::Index t = 0; t < bar.tets.rows(); ++t) {
        const auto corners = bar.tets.row(tet_order[t]);
        shuffled.tets.row(t) << order[corners(1)], order[corners(2)], order[corners(0)], order[corners(3)];  // an even permutation
    }
    LinearElasticity plain(bar, options, springs()), other(shuffled, options, springs());
    plain.solve(moved_points(0.1, 0.1), bar.rest);
    other.solve(moved_points(0.1, 0.1), shuffled.rest);
    Positions back(bar.rest.rows(), 3);
    for (Eigen::Index v = 0; v < bar.rest.rows(); ++v) back.row(v) = other.positions().row(order[v]);
    EXPECT_LT(relative_difference(back, plain.positions()), 1e-10);
}

// A higher element order changes the solution, but not the problem: the same points are tied to the same targets.
TEST_P(LinearResponse, TheSamePointsAreGrippedByEveryElementOrder)
{
    LinearOptions other = options;
    other.element_order = 3 - options.element_order;
    const LinearElasticity one(bar, options, springs()), two(bar, other, springs());
    EXPECT_EQ(one.setup().spring_tet, two.setup().spring_tet);
    EXPECT_EQ(one.setup().spring_tet.back(), -1);
}

INSTANTIATE_TEST_SUITE_P(ElementOrder, LinearResponse, testing::Values(1, 2));

}  // namespace
