// Fronts and crossings. Reference: the definitions, evaluated by hand on a few points.
#include "analysis/pareto_front.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace {

using analysis::best_within;
using analysis::nearer_from;
using analysis::pareto_front;
using analysis::WorkPrecision;
using Front = std::vector<std::size_t>;
using Points = std::vector<WorkPrecision>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

TEST(ParetoFront, OfNoPointIsEmpty)
{
    EXPECT_TRUE(pareto_front({}).empty());
    EXPECT_FALSE(best_within({}, 1.0));
}

TEST(ParetoFront, OfASinglePointIsThatPoint)
{
    EXPECT_EQ(pareto_front({{2.0, 5.0}}), Front{0});
}

TEST(ParetoFront, LeavesOutWhatIsDominatedAndRunsByCost)
{
    EXPECT_EQ(pareto_front({{3.0, 1.0}, {1.0, 9.0}, {2.0, 9.5}, {2.0, 4.0}, {4.0, 1.5}}), (Front{1, 3, 0}));
}

TEST(ParetoFront, AtEqualCostTheSmallerErrorStays)
{
    EXPECT_EQ(pareto_front({{1.0, 5.0}, {1.0, 4.0}}), Front{1});
}

TEST(ParetoFront, AtEqualErrorTheCheaperStays)
{
    EXPECT_EQ(pareto_front({{2.0, 5.0}, {1.0, 5.0}}), Front{1});
}

TEST(ParetoFront, PointsEqualInBothAreOnItTogether)
{
    EXPECT_EQ(pareto_front({{1.0, 5.0}, {2.0, 3.0}, {1.0, 5.0}}), (Front{0, 2, 1}));
}

TEST(ParetoFront, WhatIsNotFiniteNeitherStandsOnItNorDominates)
{
    EXPECT_EQ(pareto_front({{1.0, nan}, {nan, 1.0}, {-infinity, 0.0}, {2.0, 3.0}, {1.0, infinity}}), Front{3});
}

// Reference: the definition again, for many points: no point dominates one on the front, and some point dominates each other one.
TEST(ParetoFront, OfManyPointsHoldsExactlyThoseThatNoneDominates)
{
    std::mt19937 generator(7);
    std::uniform_int_distribution<int> tenth(0, 20);  // coarse, so that ties occur
    Points points;
    for (int i = 0; i < 300; ++i) points.push_back({0.1 * tenth(generator), 0.1 * tenth(generator)});
    const Front front = pareto_front(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        bool dominated = false;
        for (const WorkPrecision& other : points)
            dominated |= other.cost <= points[i].cost && other.error <= points[i].error &&
                         (other.cost != points[i].cost || other.error != points[i].error);
        EXPECT_EQ(std::count(front.begin(), front.end(), i), dominated ? 0 : 1) << i;
    }
}

TEST(BestWithin, IsTheSmallestErrorThatTheBudgetPays)
{
    const Points points = {{1.0, 9.0}, {2.0, 4.0}, {3.0, 6.0}, {4.0, 4.0}};
    EXPECT_FALSE(best_within(points, 0.5));
    EXPECT_EQ(best_within(points, 1.0), 0u);
    EXPECT_EQ(best_within(points, 2.0), 1u);
    EXPECT_EQ(best_within(points, 9.0), 1u);  // the cheaper of two equal errors
}

TEST(NearerFrom, IsTheBudgetBeyondWhichItIsAlwaysSo)
{
    // Errors of the best within 1, 2, 3, 4: for one 10 10 3 3, for the other 8 8 8 5.
    const auto crossing = nearer_from({{1.0, 10.0}, {3.0, 3.0}}, {{1.0, 8.0}, {4.0, 5.0}});
    ASSERT_TRUE(crossing);
    EXPECT_EQ(crossing->from, 3.0);
    EXPECT_EQ(crossing->one, 1u);
    EXPECT_EQ(crossing->other_error, 8.0);
    EXPECT_FALSE(crossing->from_the_start);
}

TEST(NearerFrom, IsNothingForOneThatIsOvertakenForGood)
{
    EXPECT_FALSE(nearer_from({{1.0, 5.0}}, {{2.0, 4.0}}));
}

TEST(NearerFrom, CountsTheLastTimeOfSeveral)
{
    // Errors at budgets 1 to 5: for one 9 9 2 2 1, for the other 10 3 3 2 2. One is better at 1, not at 2, better at 3, equal at 4, better
    // at 5.
    const auto crossing = nearer_from({{1.0, 9.0}, {3.0, 2.0}, {5.0, 1.0}}, {{1.0, 10.0}, {2.0, 3.0}, {4.0, 2.0}});
    ASSERT_TRUE(crossing);
    EXPECT_EQ(crossing->from, 5.0);
}

TEST(NearerFrom, HoldsFromTheStartWhereTheOtherIsNeverAsNear)
{
    const auto crossing = nearer_from({{1.0, 5.0}, {3.0, 4.0}}, {{2.0, 6.0}});
    ASSERT_TRUE(crossing);
    EXPECT_TRUE(crossing->from_the_start);
    EXPECT_EQ(crossing->from, 1.0);
    EXPECT_EQ(crossing->other_error, infinity);  // no point of the other is within that budget
}

TEST(NearerFrom, TheSameErrorIsNotNearer)
{
    EXPECT_FALSE(nearer_from({{1.0, 5.0}}, {{1.0, 5.0}}));
}

}  // namespace
