// Reference: the necessary conditions of a minimum and of a step of implicit Euler, computed by the plain energy (FleshEnergy).
#include "pbs/flesh/xpbd_neo_hookean.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/flesh_rounding.hpp"
#include "tests/support/held_xpbd.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using pbs::Arithmetic;
using pbs::Positions;
using pbs::XpbdMultipliers;
using test_support::HeldXpbd;

const HeldXpbd& bar()
{
    static const HeldXpbd held({8, 2, 2});
    return held;
}
const Positions& lbs()
{
    return bar().bent.lbs;
}

double gradient_after(const pbs::XpbdNeoHookeanOptions& options, Positions x = lbs())
{
    bar().minimise<double>(options, x);
    return bar().gradient(x).norm() / bar().gradient(lbs()).norm();
}

TEST(XpbdNeoHookean, EndsWhereTheGradientVanishes)
{
    for (const Arithmetic arithmetic : {Arithmetic::plain_f64, Arithmetic::packed_f64})
        EXPECT_LT(gradient_after({.iterations = 500, .arithmetic = arithmetic}), 1e-9);
}

// Multipliers that begin at zero in each iteration, or that are kept within a step only and without the residual, end elsewhere.
TEST(XpbdNeoHookean, OnlyKeptMultipliersEndWhereTheGradientVanishes)
{
    for (const XpbdMultipliers multipliers : {XpbdMultipliers::reset, XpbdMultipliers::of_step}) {
        pbs::XpbdNeoHookeanOptions options{
            .iterations = 1200, .iterations_per_step = 6, .multipliers = multipliers, .arithmetic = Arithmetic::plain_f64};
        EXPECT_GT(gradient_after(options), 1e-3);
        options.multipliers = XpbdMultipliers::kept;
        EXPECT_LT(gradient_after(options), 1e-6);
    }
}

// One step whose iterations have converged: the gradient of the energy balances the inertia to rounding. A step as published does not.
TEST(XpbdNeoHookean, TheFixedPointOfAStepIsImplicitEuler)
{
    pbs::XpbdNeoHookeanOptions options{.iterations = 300, .iterations_per_step = 300, .arithmetic = Arithmetic::plain_f64};
    Positions x = lbs();
    EXPECT_EQ(bar().minimise<double>(options, x).steps, 1);
    const double first = bar().gradient(lbs()).norm();
    EXPECT_LT(bar().gradient_with_inertia(x, lbs()).norm(), 1e-10 * first);
    EXPECT_GT(bar().gradient(x).norm(), 1e-2 * first);

    options.multipliers = XpbdMultipliers::of_step;
    Positions published = lbs();
    bar().minimise<double>(options, published);
    EXPECT_GT(bar().gradient_with_inertia(published, lbs()).norm(), 1e-3 * first);
}

// Two points with small gradients are at most the sum of these, over the lowest stiffness, from each other. Half of that stiffness leaves
// room for its change between the points.
TEST(XpbdNeoHookean, TheLimitDoesNotDependOnIterationsPerStepTimeStepOrMomentum)
{
    const double first = bar().gradient(lbs()).norm();
    Positions expected = lbs();
    bar().minimise<double>({.iterations = 800, .arithmetic = Arithmetic::plain_f64}, expected);
    const double lowest = test_support::stiffnesses(bar().energy, bar().centres, expected)(0);
    const auto expect_the_limit = [&](const HeldXpbd& held, const pbs::XpbdNeoHookeanOptions& options) {
        Positions x = lbs();
        held.minimise<double>(options, x);
        const double remaining = bar().gradient(x).norm() + bar().gradient(expected).norm();
        EXPECT_LT(remaining, 1e-6 * first);
        EXPECT_LT((x - expected).norm(), remaining / (0.5 * lowest));
    };
    for (const int per_step : {2, 5})
        expect_the_limit(bar(), {.iterations = 500 * per_step, .iterations_per_step = per_step, .arithmetic = Arithmetic::plain_f64});
    expect_the_limit(HeldXpbd({8, 2, 2}, 0.5), {.iterations = 1200, .arithmetic = Arithmetic::plain_f64});
    expect_the_limit(bar(), {.iterations = 600, .momentum = false, .arithmetic = Arithmetic::plain_f64});
}

// The multipliers are sums over the iterations, each with a rounding of its own.
TEST(XpbdNeoHookean, FloatComesAsNearAsItsRoundingAllows)
{
    constexpr int iterations = 100;
    Positions expected = lbs(), in_float = lbs();
    bar().minimise<double>({.iterations = 800, .arithmetic = Arithmetic::packed_f64}, expected);
    bar().minimise<float>({.iterations = iterations}, in_float);
    EXPECT_LT((in_float - expected).norm(), test_support::displaced_by_rounding<float>(bar().energy, bar().centres, expected, iterations));
}

// A mirrored bar and one with inverted tets are finite energies, from which the forces point back.
TEST(XpbdNeoHookean, InvertedInitialGuessesEndInTheSameMinimum)
{
    Positions mirrored = bar().bent.mesh.rest;
    mirrored.col(2) *= -1.0;
    const Positions inverted = test_support::jittered(lbs(), 0.15), collapsed = 0.01 * lbs();
    for (const Positions& from : {inverted, collapsed})
        EXPECT_LT(gradient_after({.iterations = 800, .arithmetic = Arithmetic::plain_f64}, from), 1e-6);
    Positions x = mirrored;
    bar().minimise<double>({.iterations = 800, .arithmetic = Arithmetic::plain_f64}, x);
    EXPECT_TRUE(x.allFinite());
    EXPECT_LT(bar().energy.value(x, bar().centres), bar().energy.value(mirrored, bar().centres));
}

TEST(XpbdNeoHookean, ZeroIterationsReturnTheInitialGuess)
{
    Positions x = lbs();
    EXPECT_EQ(bar().minimise<double>({.iterations = 0, .arithmetic = Arithmetic::plain_f64}, x).steps, 0);
    EXPECT_EQ(x, lbs());
}

TEST(XpbdNeoHookean, TheLastStepMayBeShort)
{
    Positions x = lbs();
    const auto summary = bar().minimise<double>({.iterations = 7, .iterations_per_step = 3, .arithmetic = Arithmetic::plain_f64}, x);
    EXPECT_EQ(summary.iterations, 7);
    EXPECT_EQ(summary.steps, 3);
}

TEST(XpbdNeoHookean, RefusesATimeStepThatIsNotPositive)
{
    EXPECT_THROW(HeldXpbd({8, 2, 2}, 0.0), pbs::InputError);
    EXPECT_THROW(HeldXpbd({8, 2, 2}, std::numeric_limits<double>::quiet_NaN()), pbs::InputError);
}

}  // namespace
