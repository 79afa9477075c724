// Reference: the identity of the header. A decision must hold for every exact solution within the bound, and without a decision there must
// be one within the bound that reverses the order.
#include "analysis/verdicts/pair_order.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>

namespace {

using analysis::decide;
using analysis::order_of;
using analysis::PairDecision;
using analysis::PairOrder;
using Point = Eigen::Matrix<double, 6, 1>;

Point random_point(std::mt19937& generator)
{
    std::normal_distribution<double> normal;
    return Point::NullaryExpr([&](Eigen::Index) { return normal(generator); });
}

TEST(PairOrder, HoldsForEveryExactSolutionWithinTheBoundAndForNoLargerOne)
{
    std::mt19937 generator(5);
    int decided = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const Point a = random_point(generator), b = random_point(generator), reference = random_point(generator);
        const double bound = 0.3;
        const PairOrder order = order_of({(a - reference).norm(), (b - reference).norm(), (a - b).norm(), bound});
        // The exact solution that reverses the order first lies from the reference towards the farther of the two.
        const bool a_is_closer = (a - reference).norm() < (b - reference).norm();
        const Point worst = reference + (a_is_closer ? 1.0 : -1.0) * bound * (b - a).normalized();
        const bool reversed = ((a - worst).norm() < (b - worst).norm()) != a_is_closer;
        EXPECT_EQ(order == PairOrder::undecided, reversed);
        if (order == PairOrder::undecided) continue;
        ++decided;
        EXPECT_EQ(order == PairOrder::first_is_closer, a_is_closer);
        const Point exact = reference + bound * random_point(generator).normalized();
        EXPECT_EQ((a - exact).norm() < (b - exact).norm(), a_is_closer);
    }
    EXPECT_GT(decided, 500);
}

TEST(PairOrder, IsUndecidedForEqualErrorsAndForWhatIsNotFinite)
{
    EXPECT_EQ(order_of({1.0, 1.0, 0.5, 0.0}), PairOrder::undecided);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(order_of({nan, 1.0, 0.5, 0.1}), PairOrder::undecided);
    EXPECT_EQ(order_of({2.0, 1.0, 0.5, nan}), PairOrder::undecided);
    EXPECT_EQ(order_of({std::numeric_limits<double>::infinity(), 1.0, 0.5, 0.1}), PairOrder::undecided);
    EXPECT_EQ(order_of({2.0, 1.0, 1.0, 0.0}), PairOrder::second_is_closer);
}

TEST(PairDecision, NeedsAllMembersAndTheirAgreement)
{
    constexpr auto first = PairOrder::first_is_closer, second = PairOrder::second_is_closer, open = PairOrder::undecided;
    EXPECT_EQ(decide({first, first}), PairDecision::decided);
    EXPECT_EQ(decide({first, open}), PairDecision::reference_error);
    EXPECT_EQ(decide({first, open, second}), PairDecision::models_disagree);
    EXPECT_EQ(decide({}), PairDecision::reference_error);
}

}  // namespace
