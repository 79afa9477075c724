// Reference: functions whose minimum is known in closed form, and the jackknife of a mean, which is its standard error.

#include "analysis/statistics/minimise.hpp"
#include "analysis/statistics/statistics.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"

#include <gsl/gsl_cdf.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace {

using namespace analysis;

// The search ends with a bracket of the minimum below its tolerance, and cannot order values whose difference c d^2 / 2 at the distance d,
// c the curvature, is below the rounding of both.
double place_error(double tolerance, double rounding_of_value, double curvature)
{
    return tolerance + std::sqrt(2.0 * 2.0 * rounding_of_value / curvature);
}

const double default_tolerance = MinimiseOptions().tolerance;

TEST(Minimise, ParabolaIsFoundToTheTolerance)
{
    const auto minimum = minimise([](double x) { return 2.0 + std::pow(x - 0.3, 2); }, 0.0, 1.0, {.tolerance = 1e-7});
    EXPECT_EQ(minimum.outcome, MinimumOutcome::converged);
    const double of_value = test_support::rounding_error(1, 2.0), of_place = place_error(1e-7, of_value, 2.0);
    EXPECT_NEAR(minimum.x, 0.3, of_place);
    EXPECT_NEAR(minimum.value, 2.0, of_place * of_place + of_value);
}

TEST(Minimise, LogarithmicValleyIsFoundToTheTolerance)
{
    // The minimum is at 1, without symmetry; value and curvature are 1 there.
    const auto minimum = minimise([](double x) { return x - std::log(x); }, 0.1, 7.0, {.tolerance = 1e-6});
    const double of_value = test_support::rounding_error(2, 1.0), of_place = place_error(1e-6 * (7.0 - 0.1), of_value, 1.0);
    EXPECT_EQ(minimum.outcome, MinimumOutcome::converged);
    EXPECT_NEAR(minimum.x, 1.0, of_place);
    EXPECT_TRUE(minimum.identifiable() == (minimum.rise >= 0.01));
    // 1.1 - log 1.1 - 1 and 0.9 - log 0.9 - 1: the smaller of the two. It changes by 0.1 times the place, whose square is negligible.
    EXPECT_NEAR(minimum.rise, 0.1 - std::log(1.1), 0.1 * of_place + of_place * of_place + 4.0 * of_value);
}

TEST(Minimise, ValueZeroIsIdentifiable)
{
    const auto minimum = minimise([](double x) { return std::abs(x - 0.25); }, 0.0, 1.0);  // 0.25 is a sample
    EXPECT_EQ(minimum.value, 0.0);
    EXPECT_TRUE(std::isinf(minimum.rise));
    EXPECT_TRUE(minimum.identifiable());
}

TEST(Minimise, TakesTheDeepestOfSeveralValleys)
{
    const auto two_valleys = [](double x) { return std::min(1.0 + 4.0 * std::pow(x - 0.2, 2), 0.5 + 4.0 * std::pow(x - 0.8, 2)); };
    EXPECT_NEAR(minimise(two_valleys, 0.0, 1.0).x, 0.8, place_error(default_tolerance, test_support::rounding_error(1, 0.5), 8.0));
}

TEST(Minimise, MonotoneEndsAtTheBound)
{
    const auto falling = minimise([](double x) { return 1.0 - x; }, 0.0, 0.5);
    EXPECT_EQ(falling.outcome, MinimumOutcome::at_upper_bound);
    EXPECT_EQ(falling.x, 0.5);
    EXPECT_FALSE(falling.identifiable());
    const auto rising = minimise([](double x) { return 1.0 + x; }, 0.0, 0.5);
    EXPECT_EQ(rising.outcome, MinimumOutcome::at_lower_bound);
    EXPECT_EQ(rising.x, 0.0);
    EXPECT_FALSE(rising.identifiable());
}

TEST(Minimise, LooksInsideTheLastCellBeforeItSaysBound)
{
    for (const double centre : {0.002, 0.4987}) {  // nearer to the bound than to any other sample
        const auto minimum = minimise([centre](double x) { return 1.0 + std::pow(x - centre, 2); }, 0.0, 0.5);
        EXPECT_EQ(minimum.outcome, MinimumOutcome::converged);
        EXPECT_NEAR(minimum.x, centre, place_error(0.5 * default_tolerance, test_support::rounding_error(1, 1.0), 2.0));
    }
}

TEST(Minimise, FlatIsAnOutcome)
{
    const auto minimum = minimise([](double) { return 3.0; }, 0.0, 1.0);
    EXPECT_EQ(minimum.outcome, MinimumOutcome::flat);
    EXPECT_EQ(minimum.value, 3.0);
    EXPECT_FALSE(minimum.identifiable());
}

TEST(Minimise, FlatBottomBetweenWallsIsNotIdentifiable)
{
    const auto tub = minimise([](double x) { return 1.0 + std::max(0.0, std::abs(x - 0.5) - 0.3); }, 0.0, 1.0);
    EXPECT_EQ(tub.value, 1.0);
    EXPECT_TRUE(tub.flat_valley);
    EXPECT_FALSE(tub.identifiable());
}

TEST(Minimise, ShallowValleyIsNotIdentifiable)
{
    const auto valley = [](double depth) { return [depth](double x) { return 20.0 + depth * std::pow(x / 0.3 - 1.0, 2); }; };
    // A change of 10 % increases the value by depth / 100 of 20: 0.5 % and 5 %.
    EXPECT_FALSE(minimise(valley(10.0), 0.0, 0.5).identifiable());
    // At 1.1 x the derivative of the rise is 2 depth 0.1 1.1 / 0.3 / 20.
    const double of_place = place_error(0.5 * default_tolerance, test_support::rounding_error(1, 20.0), 2.0 * 10.0 / (0.3 * 0.3));
    EXPECT_NEAR(minimise(valley(10.0), 0.0, 0.5).rise, 0.005,
                2.0 * 10.0 * 0.1 * 1.1 / 0.3 / 20.0 * of_place + test_support::rounding_error(6, 1.0));
    EXPECT_TRUE(minimise(valley(100.0), 0.0, 0.5).identifiable());
}

TEST(Minimise, NotFiniteIsAnOutcome)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto nowhere = minimise([&](double) { return nan; }, 0.0, 1.0);
    EXPECT_EQ(nowhere.outcome, MinimumOutcome::not_finite);
    EXPECT_TRUE(std::isnan(nowhere.x));
    EXPECT_FALSE(nowhere.identifiable());
    // Only one sample is a number, so there is no bracket.
    const auto lonely = minimise([&](double x) { return x == 0.5 ? 1.0 : nan; }, 0.0, 1.0);
    EXPECT_EQ(lonely.outcome, MinimumOutcome::not_finite);
    EXPECT_EQ(lonely.x, 0.5);
    // A hole elsewhere does not matter. One that Brent's method meets is reported, and the best number is kept.
    EXPECT_EQ(minimise([&](double x) { return x > 0.9 ? nan : std::pow(x - 0.3, 2); }, 0.0, 1.0).outcome, MinimumOutcome::converged);
    const auto hole = minimise([&](double x) { return std::abs(x - 0.31) < 5e-3 ? nan : std::pow(x - 0.31, 2); }, 0.0, 1.0, {.samples = 5});
    EXPECT_EQ(hole.outcome, MinimumOutcome::not_finite);
    EXPECT_TRUE(std::isfinite(hole.value));
    EXPECT_LE(std::abs(hole.x - 0.31), 0.31 - 0.25);  // 0.25 is a sample
}

TEST(Minimise, ExhaustedIterationsAreAnOutcome)
{
    const auto minimum = minimise([](double x) { return std::pow(x - 0.31, 2); }, 0.0, 1.0, {.tolerance = 1e-9, .iterations = 1});
    EXPECT_EQ(minimum.outcome, MinimumOutcome::iterations_exhausted);
    EXPECT_EQ(minimum.iterations, 1);
}

TEST(Minimise, KeepsEveryEvaluationInOrder)
{
    int calls = 0;
    const auto minimum = minimise([&](double x) { return ++calls, std::pow(x - 0.31, 2); }, 0.0, 1.0);
    ASSERT_EQ(static_cast<int>(minimum.evaluations.size()), calls);
    for (std::size_t i = 1; i < minimum.evaluations.size(); ++i)
        EXPECT_LE(minimum.evaluations[i - 1].parameter, minimum.evaluations[i].parameter);
}

TEST(Minimise, RefusesWhatIsNoInterval)
{
    const auto constant = [](double) { return 0.0; };
    EXPECT_THROW(minimise(constant, 1.0, 1.0), pbs::InputError);
    EXPECT_THROW(minimise(constant, 1.0, 0.0), pbs::InputError);
    EXPECT_THROW(minimise(constant, 0.0, std::numeric_limits<double>::infinity()), pbs::InputError);
    EXPECT_THROW(minimise(constant, 0.0, 1.0, {.samples = 2}), pbs::InputError);
    EXPECT_THROW(fit_over_cases({}, 0.0, 1.0), pbs::InputError);
}

// The minimum of the root mean square of |x - a_i| is the mean of the a_i; its jackknife error is their standard error.
TEST(FitOverCases, JackknifeOfAMeanIsItsStandardError)
{
    const std::vector<double> centres = {0.2, 0.3, 0.35, 0.55};
    std::vector<Misfit> misfits;
    for (const double centre : centres) misfits.push_back([centre](double x) { return std::abs(x - centre); });
    constexpr double tolerance = 1e-8;
    const auto fit = fit_over_cases(misfits, 0.0, 1.0, {.tolerance = tolerance});
    // The root mean square is sqrt(v + (x - mean)^2), where v is the variance: value sqrt(v) with ten roundings, curvature 1 / sqrt(v).
    const double deviation = standard_deviation(centres);
    const double of_place = place_error(tolerance, test_support::rounding_error(10, deviation), 1.0 / deviation);
    EXPECT_NEAR(fit.all.x, mean(centres), of_place);
    EXPECT_NEAR(fit.interval.estimate, mean(centres), of_place);
    const double t = gsl_cdf_tdist_Pinv(0.975, 3), half_width = t * standard_error(centres);
    // t sqrt(3 / 4 sum (x_i - mean)^2) of four places.
    EXPECT_NEAR(fit.interval.high - fit.interval.estimate, half_width, t * std::sqrt(3.0 / 4.0 * 4.0) * of_place);
    EXPECT_NEAR(fit.interval.estimate - fit.interval.low, half_width, t * std::sqrt(3.0 / 4.0 * 4.0) * of_place);
    ASSERT_EQ(fit.cases.size(), centres.size());
    for (std::size_t i = 0; i < centres.size(); ++i) EXPECT_NEAR(fit.cases[i].x, centres[i], tolerance);
}

TEST(FitOverCases, IntervalIsCutToTheBounds)
{
    const auto at = [](double centre) { return [centre](double x) { return std::abs(x - centre); }; };
    const auto fit = fit_over_cases({at(0.05), at(0.9)}, 0.0, 1.0);
    EXPECT_EQ(fit.interval.low, 0.0);
    EXPECT_EQ(fit.interval.high, 1.0);
}

TEST(FitOverCases, AsksACaseOnceAtEachParameter)
{
    std::vector<double> asked;
    const Misfit counted = [&](double x) { return asked.push_back(x), std::abs(x - 0.3); };
    fit_over_cases({counted, [](double x) { return std::abs(x - 0.4); }}, 0.0, 1.0);
    std::sort(asked.begin(), asked.end());
    EXPECT_EQ(std::adjacent_find(asked.begin(), asked.end()), asked.end());
}

TEST(FitOverCases, OneCaseHasNoInterval)
{
    const auto fit = fit_over_cases({[](double x) { return std::abs(x - 0.4); }}, 0.0, 1.0);
    EXPECT_NEAR(fit.all.x, 0.4, default_tolerance);
    EXPECT_TRUE(std::isnan(fit.interval.low));
    EXPECT_TRUE(fit.without.empty());
}

}  // namespace

// Fronts and crossings. Reference: the definitions, evaluated by hand on a few points.

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
