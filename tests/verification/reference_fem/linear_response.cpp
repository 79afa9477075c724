// Reference: properties of linear elasticity (superposition, reciprocity, independence of Young's modulus and of the
// numbering) and of the program (a kept factor gives what a fresh one gives; two solvers agree). Tolerances: rounding
// of direct solves, by cond(K).
#include "reference_fem/linear_elasticity.hpp"

#include "tests/support/fem_rounding.hpp"
#include "tests/support/structured_bar.hpp"

namespace linear_response_tests {
namespace {

using namespace reference_fem;
using pbs::Positions;
using pbs::Vec3;

const pbs::TetMesh bar = test_support::jittered(
    test_support::structured_bar({0, -0.25, -0.25}, {1, 0.25, 0.25}, {8, 4, 4}), Vec3::Constant(0.125), 0.25);

// Points on two short lines inside the two ends, and one beyond the bar.
const Positions tied_points{{0.1, 0, 0},    {0.2, 0.03, 0},  {0.15, 0, 0.05},    {0.12, -0.1, 0.02}, {0.9, 0, 0},
                            {0.8, 0.03, 0}, {0.85, 0, 0.05}, {0.88, -0.1, 0.02}, {3, 0, 0}};

Attachment springs(double factor = 1.0)
{
    return {tied_points, factor * Eigen::VectorXd::LinSpaced(9, 1e4, 2e5), {}};
}

Positions moved_points(double x, double y)
{
    Positions targets = tied_points;
    targets.bottomRows(5).rowwise() += Eigen::RowVector3d(x, y, 0.02);
    return targets;
}

class LinearResponse : public testing::TestWithParam<int> {
protected:
    // The bound for one solve under this test's springs and options.
    test_support::SolveRounding rounding_of(const LinearElasticity& solved) const
    {
        return test_support::rounding_of(solved, bar, options, springs());
    }

    LinearOptions options{.element_order = GetParam(), .gravity_m_s2 = {0, -9.81, 0}};
};

TEST_P(LinearResponse, CholmodAndUmfpackAgree)
{
    LinearOptions second = options;
    second.solver = LinearSolver::umfpack;
    LinearElasticity cholmod(bar, options, springs()), umfpack(bar, second, springs());
    const SolveSummary first = cholmod.solve(moved_points(0.1, 0.1), bar.rest),
                       other = umfpack.solve(moved_points(0.1, 0.1), bar.rest);
    const test_support::SolveRounding rounding = rounding_of(cholmod);
    EXPECT_LT((cholmod.positions() - umfpack.positions()).norm(), 2.0 * rounding.error_m());
    EXPECT_LT(rounding.relative(), 1e-6) << "a bound that would let an error of a percent pass proves nothing";
    // |r| <= c |K| |u| and |u| <= |K^-1| |f|: the residual relative to |f| has the same bound as the solution's error.
    EXPECT_LT(first.residual, rounding.relative());
    EXPECT_LT(other.residual, rounding.relative());
}

TEST_P(LinearResponse, DisplacementsSuperpose)
{
    LinearElasticity fem(bar, options, springs());
    const auto displacement = [&](const Positions& targets, const Vec3& gravity) {
        fem.solve(targets, bar.rest, gravity);
        return fem.displacement();
    };
    const Eigen::VectorXd pull = displacement(moved_points(0.1, 0.0), Vec3::Zero());
    const Eigen::VectorXd weight = displacement(tied_points, Vec3(0, -9.81, 0));
    const Eigen::VectorXd both =
        displacement(tied_points + 2.0 * (moved_points(0.1, 0.0) - tied_points), Vec3(0, -9.81, 0));
    const double sizes_m = 2.0 * pull.norm() + weight.norm() + both.norm();
    EXPECT_LT((2.0 * pull + weight - both).norm(), rounding_of(fem).relative() * sizes_m);
}

// If gravity is given at the solve instead of in the options, nothing else changes; nor does the element order change
// which points are tied.
TEST_P(LinearResponse, GravityMayTurnBetweenFramesAndEveryElementOrderGripsTheSamePoints)
{
    LinearElasticity fixed(bar, options, springs()), given(bar, {.element_order = GetParam()}, springs());
    fixed.solve(tied_points, bar.rest);
    given.solve(tied_points, bar.rest, options.gravity_m_s2);
    EXPECT_EQ(fixed.positions(), given.positions());
    const LinearElasticity other(bar, {.element_order = 3 - GetParam()}, springs());
    EXPECT_EQ(fixed.setup().spring_tet, other.setup().spring_tet);
    EXPECT_EQ(fixed.setup().spring_tet.back(), -1);
}

TEST_P(LinearResponse, WithoutLoadsYoungsModulusCancels)
{
    LinearOptions stiff = options, soft = options;
    stiff.gravity_m_s2 = soft.gravity_m_s2 = Vec3::Zero();
    stiff.young_pa = 1e3 * soft.young_pa;
    LinearElasticity hard(bar, stiff, springs(1e3)), weak(bar, soft, springs());
    hard.solve(moved_points(0.1, 0.1), bar.rest);
    weak.solve(moved_points(0.1, 0.1), bar.rest);
    EXPECT_LT((hard.positions() - weak.positions()).norm(), 2.0 * rounding_of(weak).error_m());
}

TEST_P(LinearResponse, AKeptFactorGivesWhatAFreshOneGivesAndTheRestPoseToTheBit)
{
    LinearElasticity kept(bar, options, springs()), fresh(bar, options, springs());
    for (const double x : {0.3, -0.2, 0.0}) kept.solve(moved_points(x, x), bar.rest);
    kept.solve(moved_points(0.1, 0.1), bar.rest);
    fresh.solve(moved_points(0.1, 0.1), bar.rest);
    EXPECT_EQ(kept.positions(), fresh.positions());
    const SolveSummary weightless = fresh.solve(tied_points, bar.rest, Vec3::Zero());
    EXPECT_EQ(fresh.positions(), bar.rest);
    EXPECT_EQ(weightless.residual, 0.0);
}

TEST_P(LinearResponse, NumberingOfVerticesAndTetsDoesNotMatter)
{
    const auto [shuffled, vertex] = test_support::renumbered(bar, 5);
    LinearElasticity plain(bar, options, springs()), other(shuffled, options, springs());
    plain.solve(moved_points(0.1, 0.1), bar.rest);
    other.solve(moved_points(0.1, 0.1), shuffled.rest);
    const Positions back = other.positions()(vertex, Eigen::all);
    EXPECT_LT((back - plain.positions()).norm(), 2.0 * rounding_of(plain).error_m());
}

INSTANTIATE_TEST_SUITE_P(ElementOrder, LinearResponse, testing::Values(1, 2));

}  // namespace
}  // namespace linear_response_tests
