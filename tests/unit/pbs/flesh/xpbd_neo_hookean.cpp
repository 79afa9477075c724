// Reference: the necessary conditions of a minimum and of a step of implicit Euler, computed by the plain energy
// (FleshEnergy).
#include "pbs/flesh/xpbd_neo_hookean.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/flesh_rounding.hpp"
#include "tests/support/held_xpbd.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace xpbd_neo_hookean_tests {
namespace {

using pbs::Positions;
using pbs::XpbdMultipliers;
using test_support::HeldXpbd;

const HeldXpbd bent_bar({8, 2, 2});
const Positions& lbs = bent_bar.bent.lbs;

double gradient_after(const pbs::XpbdNeoHookeanOptions& options, Positions x = lbs)
{
    bent_bar.minimise<double>(options, x);
    return bent_bar.gradient(x).norm() / bent_bar.gradient(lbs).norm();
}

// Multipliers that begin at zero in each iteration, or that are kept within a step only and without the residual, end
// elsewhere.
TEST(XpbdNeoHookean, OnlyKeptMultipliersEndWhereTheGradientVanishes)
{
    for (const XpbdMultipliers multipliers : {XpbdMultipliers::reset, XpbdMultipliers::of_step}) {
        pbs::XpbdNeoHookeanOptions options{
            .iterations = 1200, .iterations_per_step = 6, .multipliers = multipliers, .packed = false};
        EXPECT_GT(gradient_after(options), 1e-3);
        options.multipliers = XpbdMultipliers::kept;
        EXPECT_LT(gradient_after(options), 1e-6);
    }
}

// One step whose iterations have converged: the gradient of the energy balances the inertia to rounding. A step as
// published does not.
TEST(XpbdNeoHookean, TheFixedPointOfAStepIsImplicitEuler)
{
    pbs::XpbdNeoHookeanOptions options{.iterations = 300, .iterations_per_step = 300, .packed = false};
    Positions x = lbs;
    EXPECT_EQ(bent_bar.minimise<double>(options, x).steps, 1);
    const double first = bent_bar.gradient(lbs).norm();
    EXPECT_LT(bent_bar.gradient_with_inertia(x, lbs).norm(), 1e-10 * first);
    EXPECT_GT(bent_bar.gradient(x).norm(), 1e-2 * first);

    options.multipliers = XpbdMultipliers::of_step;
    Positions published = lbs;
    bent_bar.minimise<double>(options, published);
    EXPECT_GT(bent_bar.gradient_with_inertia(published, lbs).norm(), 1e-3 * first);
}

// Two points with small gradients are at most the sum of these, over the lowest stiffness, from each other. Half of
// that stiffness leaves room for its change between the points.
TEST(XpbdNeoHookean, TheLimitDoesNotDependOnIterationsPerStepTimeStepOrMomentum)
{
    const double first = bent_bar.gradient(lbs).norm();
    Positions expected = lbs;
    bent_bar.minimise<double>({.iterations = 800, .packed = false}, expected);
    const double lowest = test_support::stiffnesses(bent_bar.energy, bent_bar.centres, expected)(0);
    const auto expect_the_limit = [&](const HeldXpbd& held, const pbs::XpbdNeoHookeanOptions& options) {
        Positions x = lbs;
        held.minimise<double>(options, x);
        const double remaining = bent_bar.gradient(x).norm() + bent_bar.gradient(expected).norm();
        EXPECT_LT(remaining, 1e-6 * first);
        EXPECT_LT((x - expected).norm(), remaining / (0.5 * lowest));
    };
    for (const int per_step : {2, 5})
        expect_the_limit(bent_bar, {.iterations = 500 * per_step, .iterations_per_step = per_step, .packed = false});
    expect_the_limit(HeldXpbd({8, 2, 2}, 0.5), {.iterations = 1200, .packed = false});
    expect_the_limit(bent_bar, {.iterations = 600, .momentum = false, .packed = false});
}

TEST(XpbdNeoHookean, TheLastStepMayBeShort)
{
    Positions x = lbs;
    const auto summary = bent_bar.minimise<double>({.iterations = 7, .iterations_per_step = 3, .packed = false}, x);
    EXPECT_EQ(summary.iterations, 7);
    EXPECT_EQ(summary.steps, 3);
}

TEST(XpbdNeoHookean, RefusesATimeStepThatIsNotPositive)
{
    EXPECT_THROW(HeldXpbd({8, 2, 2}, 0.0), pbs::InputError);
    EXPECT_THROW(HeldXpbd({8, 2, 2}, std::numeric_limits<double>::quiet_NaN()), pbs::InputError);
}

// Reference: the equations that a visit solves, evaluated by the constraints' own values and gradients.

using Eigen::Matrix3d;

const pbs::BoneSprings no_springs{Positions(0, 3), Eigen::VectorXd(0), {}};

// The first tet of the bar alone; the other vertices have no tets.
HeldXpbd one_tet(const pbs::BoneSprings& springs)
{
    test_support::TwoBoneLimb limb = test_support::two_bone_limb({8, 2, 2}, pbs::Vec3::UnitZ(), 70.0);
    limb.mesh.tets = pbs::Tets(limb.mesh.tets.topRows(1));
    return HeldXpbd(test_support::HeldBar(limb, springs));
}

// Halfway from the middle of a tet to its vertices, so that it can neither move nor turn.
pbs::BoneSprings springs_in(const pbs::TetMesh& tet)
{
    const Positions points = (0.5 * tet.rest).rowwise() + 0.5 * tet.rest.colwise().mean();
    return {points, Eigen::VectorXd::Constant(4, 0.01), {0, 0, 1, 1}};
}

// At the default time step; the vertices of one tet share their stiffness with no other. Each iteration visits a vertex
// five times, once for the tet and once for each mode of its springs. A rounding of a position acts from then on as a
// force, since the sum of the applied forces does not contain it; such forces add up like a random walk, and move the
// tet by at most their sum over its lowest stiffness.
TEST(XpbdNeoHookean, OneTetStaysAtRestInEitherArithmeticForThousandsOfIterations)
{
    for (const double height_m : {0.1, 0.6, 3.0}) {
        const pbs::TetMesh tet = {
            Positions{{-0.1, -0.1, -0.1}, {-0.1, 0.1, -0.1}, {-0.1, 0.0, 0.1}, {height_m - 0.1, 0.0, 0.0}},
            pbs::Tets{{0, 1, 2, 3}}};
        const HeldXpbd held{test_support::HeldBar(test_support::two_bones_in(tet), springs_in(tet))};
        const double lowest = test_support::stiffnesses(held.energy, held.centres, tet.rest)(0);
        for (const int iterations : {200, 3000}) {
            const auto moved_by = [&](auto scalar) {
                Positions x = tet.rest;
                held.minimise<decltype(scalar)>({.iterations = iterations}, x);
                return (x - tet.rest).norm();
            };
            const double rounded_m = std::sqrt(5.0 * iterations) * tet.rest.norm() / held.flesh.w.minCoeff() / lowest;
            EXPECT_LT(moved_by(0.0), 0x1p-53 * rounded_m) << height_m;
            EXPECT_LT(moved_by(0.0f), 0x1p-24 * rounded_m) << height_m;
        }
    }
}

Matrix3d deformation(const pbs::NeoHookeanTet& tet, const Positions& x)
{
    const auto p = [&](int i) { return pbs::Vec3(x.row(tet.vertex[i])); };
    return pbs::deformation_gradient(tet, p(0), p(1), p(2), p(3));
}

struct Visited {
    Positions x;
    Eigen::Vector2d multipliers;
};

Visited visited(const HeldXpbd& held, const Positions& from, int times = 1, bool with_residual = false)
{
    pbs::PlainXpbd plain(held.flesh);
    pbs::Rows<double> rows = plain.rows();
    plain.set_targets(held.targets);
    plain.load(from, rows);
    for (int k = 0; k < times; ++k) plain.iterate(rows, with_residual);
    Visited result{{}, plain.multipliers_of_tet(0)};
    plain.store(rows, result.x);
    return result;
}

// k C + k dC . dx + lambda = 0 for both constraints at once, linearised where the visit began. Without the coupling, or
// without one of the constraints, this does not hold. Each term has some 100 roundings.
TEST(PlainXpbd, OneVisitSolvesBothLinearisedEquations)
{
    const HeldXpbd held = one_tet(no_springs);
    const pbs::NeoHookeanTet& tet = held.flesh.tets.front();
    const Positions from = test_support::jittered(held.bent.mesh.rest, 0.1);
    const Visited after = visited(held, from);
    const Matrix3d F = deformation(tet, from), change = deformation(tet, after.x) - F;
    const double k_H = held.material.lambda * tet.volume, k_D = held.material.mu * tet.volume;
    const double H = k_H * pbs::hydrostatic_value(F, held.material.alpha),
                 of_H = k_H * pbs::hydrostatic_gradient(F).cwiseProduct(change).sum();
    const double D = k_D * pbs::deviatoric_value(F),
                 of_D = k_D * pbs::deviatoric_gradient(F).cwiseProduct(change).sum();
    const double largest =
        std::max({std::abs(H), std::abs(of_H), D, std::abs(of_D), after.multipliers.cwiseAbs().maxCoeff()});
    EXPECT_NEAR(H + of_H + after.multipliers(0), 0.0, test_support::rounding_error(300, largest));
    EXPECT_NEAR(D + of_D + after.multipliers(1), 0.0, test_support::rounding_error(300, largest));
    EXPECT_GT(std::abs(of_H) + std::abs(of_D), 1e-3 * largest);
}

// The forces of both constraints cancel there: alpha = 1 + mu / lambda. Alone, the deviatoric one would collapse the
// tet.
TEST(PlainXpbd, ATetAtRestStaysAtRest)
{
    const HeldXpbd held = one_tet(no_springs);
    const Visited after = visited(held, held.bent.mesh.rest, 5);
    EXPECT_LE((after.x - held.bent.mesh.rest).cwiseAbs().maxCoeff(), test_support::rounding_error(500, 1.0));
    EXPECT_GT(after.multipliers.cwiseAbs().minCoeff(), 0.1 * held.material.mu * held.flesh.tets.front().volume);
}

// No constraint of a tet moves its centre of mass or turns it.
TEST(PlainXpbd, ATetKeepsItsMomenta)
{
    const HeldXpbd held = one_tet(no_springs);
    const Positions from = test_support::jittered(held.bent.mesh.rest, 0.1);
    const Visited after = visited(held, from);
    pbs::Vec3 linear = pbs::Vec3::Zero(), angular = pbs::Vec3::Zero();
    double size = 0.0;
    for (const int v : held.flesh.tets.front().vertex) {
        const pbs::Vec3 momentum = (after.x - from).row(v).transpose() / held.flesh.w(v), at = from.row(v);
        linear += momentum;
        angular += at.cross(momentum);
        size += momentum.norm();
    }
    EXPECT_GT(size, 0.0);
    EXPECT_LE(linear.norm(), test_support::rounding_error(500, size));
    EXPECT_LE(angular.norm(), test_support::rounding_error(500, size * 2.0));
}

TEST(PlainXpbd, ACollapsedTetStaysFinite)
{
    const HeldXpbd held = one_tet(no_springs);
    Positions collapsed = held.bent.mesh.rest;
    for (const int v : held.flesh.tets.front().vertex) collapsed.row(v) << 0.1, 0.2, 0.3;
    for (const bool with_residual : {false, true}) {
        const Visited after = visited(held, collapsed, 3, with_residual);
        EXPECT_EQ(after.x, collapsed);  // no gradient, no motion
        EXPECT_TRUE(after.multipliers.allFinite());
    }
}

TEST(PlainXpbd, AVertexWithoutTetsStays)
{
    const HeldXpbd held = one_tet(test_support::random_springs(60, 0.3));
    const Positions from = test_support::jittered(held.bent.mesh.rest, 0.1);
    const Positions after = visited(held, from, 3).x;
    const auto& vertex = held.flesh.tets.front().vertex;
    for (int i = 0; i < static_cast<int>(from.rows()); ++i) {
        const bool has_tet = std::find(vertex.begin(), vertex.end(), i) != vertex.end();
        EXPECT_EQ(after.row(i) == from.row(i), !has_tet) << i;
    }
}

// k C + lambda = 0 holds exactly for a linear constraint after its visit; here for the only mode.
TEST(PlainXpbd, OneVisitSolvesTheEquationOfASpring)
{
    const HeldXpbd held(test_support::HeldBar::one_tet({8, 2, 2}, 0.7, 1));
    ASSERT_EQ(held.flesh.hold.modes().size(), 1u);
    pbs::PlainXpbd plain(held.flesh, {{true, 0}});
    pbs::Rows<double> rows = plain.rows();
    plain.set_targets(held.targets);
    plain.load(held.bent.mesh.rest, rows);
    plain.iterate(rows, true);
    Positions x;
    plain.store(rows, x);
    const pbs::HoldMode& mode = held.flesh.hold.modes().front();
    Eigen::RowVector3d C = -held.targets.row(0);
    for (int i = 0; i < 4; ++i) C += mode.v(i) * x.row(held.flesh.tets.front().vertex[i]);
    EXPECT_LE((mode.stiffness * C + plain.multipliers_of_modes().row(0)).norm(), test_support::rounding_error(30, 2.0));
    EXPECT_GT(C.norm(), 1e-3);
}

}  // namespace
}  // namespace xpbd_neo_hookean_tests
