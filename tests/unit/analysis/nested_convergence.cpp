// Reference: distances and fields made by hand as C h^p, whose order and error are known.
#include "analysis/nested_convergence.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using analysis::nested_order;

constexpr int few_roundings = 16;  // of a logarithm, a power and a quotient, on both sides

TEST(NestedConvergence, TakesTheOrderOfTheLinearSolutions)
{
    for (const double order : {0.5, 1.0, 1.7, 2.0}) {
        const auto found = nested_order({3.0 * std::exp2(order), 3.0, 0.7}, 2.0);
        EXPECT_NEAR(found.observed, order, test_support::rounding_error(few_roundings, order));
        EXPECT_EQ(found.order, found.observed);
        EXPECT_TRUE(found.reliable || order == 0.5);  // at the limit rounding decides
    }
}

// By hand: order 1 halves the error, which is then the difference; order 2 quarters it.
TEST(NestedConvergence, BoundsByRichardsonsEstimateTimesTheSafetyFactor)
{
    EXPECT_DOUBLE_EQ(nested_order({8.0, 4.0, 0.3}, 2.0).bound(0.3), 1.25 * 0.3);
    EXPECT_DOUBLE_EQ(nested_order({8.0, 2.0, 0.3}, 2.0).bound(0.3), 1.25 * 0.1);
    EXPECT_DOUBLE_EQ(nested_order({8.0, 2.0, 0.3}, 2.0).bound(0.6), 1.25 * 0.2);
}

TEST(NestedConvergence, AnOrderThatIsNotCredibleTakesTheLargerFactor)
{
    const auto high = nested_order({32.0, 1.0, 0.3}, 2.0), low = nested_order({1.1, 1.0, 0.3}, 2.0),
               away = nested_order({1.0, 2.0, 0.3}, 2.0);
    EXPECT_DOUBLE_EQ(high.observed, 5.0);
    EXPECT_EQ(high.order, 2.0);
    EXPECT_DOUBLE_EQ(high.bound(0.3), 3.0 * 0.1);
    for (const auto& found : {low, away}) {
        EXPECT_EQ(found.order, 0.5);
        EXPECT_DOUBLE_EQ(found.bound(0.3), 3.0 * 0.3 / (std::sqrt(2.0) - 1.0));
    }
    EXPECT_DOUBLE_EQ(away.observed, -1.0);
    for (const auto& found : {high, low, away}) EXPECT_FALSE(found.reliable);
}

// With stiff springs, quadratic elements can be farther from their own refined solution than refined linear ones are.
TEST(NestedConvergence, IsNotReliableWhereQuadraticElementsAreNoBetterThanRefinedLinearOnes)
{
    const auto found = nested_order({4.0, 1.0, 2.0}, 2.0);
    EXPECT_EQ(found.order, 2.0);
    EXPECT_FALSE(found.reliable);
    EXPECT_DOUBLE_EQ(found.bound(2.0), 3.0 * 2.0 / 3.0);
}

TEST(NestedConvergence, OfEqualSolutionsIsNoOrderAndNoError)
{
    const auto found = nested_order({0.0, 0.0, 0.0}, 2.0);
    EXPECT_TRUE(std::isnan(found.observed));
    EXPECT_FALSE(found.reliable);
    EXPECT_EQ(found.bound(0.0), 0.0);
}

TEST(NestedConvergence, UsesNoHigherOrderThanTheFormalOne)
{
    EXPECT_EQ(nested_order({4.0, 1.0, 0.3}, 1.0).order, 1.0);
    EXPECT_FALSE(nested_order({4.0, 1.0, 0.3}, 1.0).reliable);
    EXPECT_TRUE(nested_order({8.0, 4.0, 0.3}, 1.0).reliable);
}

// By hand: the linear solutions are 8 and 4 from the quadratic one, which is order 1, and 5 from each other. The refined linear one is then
// at most 3 * 5 from the limit.
TEST(NestedConvergence, WithoutTheFinestSolutionIsNeverReliable)
{
    const auto found = analysis::order_without_finest(8.0, 4.0, 2.0);
    EXPECT_DOUBLE_EQ(found.observed, 1.0);
    EXPECT_FALSE(found.reliable);
    EXPECT_DOUBLE_EQ(found.bound(5.0), 15.0);
    EXPECT_EQ(analysis::order_without_finest(8.0, 1.0, 2.0).order, 2.0) << "not above the formal order";
}

// x_0 + e h^p on h = 1 and 2.
TEST(NestedConvergence, ExtrapolatesToTheLimit)
{
    const pbs::Positions limit = pbs::Positions::Random(20, 3), error = pbs::Positions::Random(20, 3);
    for (const double order : {1.0, 3.0}) {
        const pbs::Positions found = analysis::extrapolated(limit + error, limit + std::exp2(order) * error, order);
        EXPECT_LT((found - limit).cwiseAbs().maxCoeff(), test_support::rounding_error(6, 16.0)) << order;
    }
}

}  // namespace
