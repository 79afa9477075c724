// Reference: the identity of the header. A decision must hold for every exact solution within the bound, and without a decision there must
// be one within the bound that reverses the order.
#include "analysis/verdicts/pair_order.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace {

using namespace analysis;
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

// 12 - 10 and 9 - 10: the mean difference is 0.5, and each shift is at most 2 x 0.2.
TEST(PairOrder, OfMeansIsThatOfTheMeanDifference)
{
    const std::vector<PairDistances> cases = {{12.0, 10.0, 22.0, 0.2}, {9.0, 10.0, 19.0, 0.2}};
    EXPECT_EQ(order_of_means(cases), PairOrder::second_is_closer);
    EXPECT_EQ(order_of_means({cases[0], {9.0, 10.0, 19.0, 0.4}}), PairOrder::undecided);
    EXPECT_EQ(order_of_means({cases[0], {9.0, 10.0, 19.0, {}}}), PairOrder::undecided);
    EXPECT_EQ(order_of_means({cases[1]}), order_of(cases[1]));
}

TEST(PairOrder, IsUndecidedForEqualErrorsAndForWhatIsNotFiniteAndTakesTheSumForADistanceThatIsNotKnown)
{
    constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(order_of({2.0, 1.0, 1.0, 0.0}), PairOrder::second_is_closer);
    EXPECT_EQ(order_of({1.0, 1.0, 0.5, 0.0}), PairOrder::undecided);
    EXPECT_EQ(order_of({2.0, 1.0, 0.5, nan}), PairOrder::undecided);
    EXPECT_EQ(order_of({2.0, 1.0, 0.5, std::nullopt}), PairOrder::undecided);
    for (const std::optional<double> first : {std::optional(nan), std::optional(infinity), std::optional<double>()})
        EXPECT_EQ(order_of({first, 1.0, 0.5, 0.1}), PairOrder::undecided);
    // Without the distance the rule is that the errors differ by more than twice the bound.
    EXPECT_EQ(order_of({20.0, 33.0, std::nullopt, 6.0}), PairOrder::first_is_closer);
    EXPECT_EQ(order_of({20.0, 31.0, std::nullopt, 6.0}), PairOrder::undecided);
    EXPECT_EQ(order_of({20.0, 31.0, 40.0, 6.0}), PairOrder::first_is_closer);
}

// A and B at a and b from the reference on a line through it: moving the reference by U changes |A - x| - |B - x| by 0 on the same side of
// both and by 2 U between them. The bound must be at least that, and no more than 2 U.
TEST(ShiftOfDifference, BoundsWhatTheReferenceMayChange)
{
    EXPECT_FALSE(shift_of_difference({5.0, 6.0, 1.0, std::nullopt}));
    EXPECT_DOUBLE_EQ(*shift_of_difference({5.0, 7.0, 12.0, 0.5}), 1.0) << "on opposite sides: 2 U";
    EXPECT_LT(*shift_of_difference({5.0, 7.0, 2.0, 0.5}), 0.2) << "on the same side it is small: 2 * 2 / 11 * 0.5";
    EXPECT_DOUBLE_EQ(*shift_of_difference({0.4, 0.3, 0.1, 0.5}), 1.0) << "within the bound nothing is known";
    EXPECT_EQ(*shift_of_difference({5.0, 5.0, 0.0, 0.5}), 0.0) << "the same shape";
    EXPECT_DOUBLE_EQ(*shift_of_difference({5.0, 7.0, std::nullopt, 0.5}), 1.0) << "as on opposite sides";
}

// By sampling: two shapes in the plane, the reference moved by U into every direction.
TEST(ShiftOfDifference, HoldsForEveryDirection)
{
    const double bound = 0.7;
    for (const auto& [ax, ay, bx, by] : {std::array{3.0, 0.0, 2.0, 2.0}, {1.0, 1.0, -4.0, 0.5}, {5.0, 0.1, 4.0, -0.1}}) {
        const double one = std::hypot(ax, ay), other = std::hypot(bx, by), distance = std::hypot(ax - bx, ay - by);
        const double shift = *shift_of_difference({one, other, distance, bound});
        double largest = 0.0;
        for (int degree = 0; degree < 360; ++degree) {
            const double x = bound * std::cos(degree * M_PI / 180), y = bound * std::sin(degree * M_PI / 180);
            const double moved = std::hypot(ax - x, ay - y) - std::hypot(bx - x, by - y);
            largest = std::max(largest, std::abs(moved - (one - other)));
        }
        EXPECT_LE(largest, shift);
        EXPECT_GT(largest, 0.0);
    }
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
