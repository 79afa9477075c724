// Reference: functions whose minimum is known in closed form, and the jackknife of a mean, which is its standard error.

#include "analysis/statistics/minimise.hpp"
#include "analysis/statistics/statistics.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/rounding_error.hpp"

#include <gsl/gsl_cdf.h>

#include <cmath>
#include <random>
#include <tuple>

namespace {

using namespace analysis;

// The search ends with a bracket of the minimum below its tolerance, and cannot order values whose difference c d^2 / 2 at the distance d,
// c the curvature, is below the rounding of both.
double place_error(double tolerance, double rounding_of_value, double curvature)
{
    return tolerance + std::sqrt(2.0 * 2.0 * rounding_of_value / curvature);
}

const double default_tolerance = MinimiseOptions().tolerance;

// A minimum without zero value or symmetry of the samples; its value and curvature there, with the roundings of the value.
struct Valley {
    const char* name;
    Misfit function;
    double low, high, x, value, curvature, roundings;
    MinimiseOptions options = {};
};

TEST(Minimise, ValleysAreFoundToTheTolerance)
{
    const auto parabola = [](double x, double value) { return [=](double at) { return value + std::pow(at - x, 2); }; };
    const auto logarithmic = [](double x) { return x - std::log(x); };
    const auto two = [](double x) { return std::min(1.0 + 4.0 * std::pow(x - 0.2, 2), 0.5 + 4.0 * std::pow(x - 0.8, 2)); };
    const std::vector<Valley> all = {{"parabola", parabola(0.3, 2.0), 0.0, 1.0, 0.3, 2.0, 2.0, 1, {.tolerance = 1e-7}},
                                     {"without symmetry", logarithmic, 0.1, 7.0, 1.0, 1.0, 1.0, 2, {.tolerance = 1e-6}},
                                     {"the deeper of two", two, 0.0, 1.0, 0.8, 0.5, 8.0, 1},
                                     {"nearer to the lower bound than to a sample", parabola(0.002, 1.0), 0.0, 0.5, 0.002, 1.0, 2.0, 1},
                                     {"to the upper bound", parabola(0.4987, 1.0), 0.0, 0.5, 0.4987, 1.0, 2.0, 1}};
    for (const Valley& of : all) {
        SCOPED_TRACE(of.name);
        const Minimum minimum = minimise(of.function, of.low, of.high, of.options);
        const double of_value = test_support::rounding_error(of.roundings, of.value);
        const double of_place = place_error(of.options.tolerance * (of.high - of.low), of_value, of.curvature);
        EXPECT_EQ(minimum.outcome, MinimumOutcome::converged);
        EXPECT_NEAR(minimum.x, of.x, of_place);
        EXPECT_NEAR(minimum.value, of.value, of.curvature / 2.0 * of_place * of_place + of_value);
    }
    // 1.1 - log 1.1 - 1 and 0.9 - log 0.9 - 1: the smaller of the two. It changes by 0.1 times the place, whose square is negligible.
    const Minimum minimum = minimise(logarithmic, 0.1, 7.0, {.tolerance = 1e-6});
    const double of_value = test_support::rounding_error(2, 1.0), of_place = place_error(1e-6 * (7.0 - 0.1), of_value, 1.0);
    EXPECT_TRUE(minimum.identifiable() == (minimum.rise >= 0.01));
    EXPECT_NEAR(minimum.rise, 0.1 - std::log(1.1), 0.1 * of_place + of_place * of_place + 4.0 * of_value);
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

// Searches on 0 to 0.5 with an outcome that is known without rounding.
struct Known {
    const char* name;
    Misfit function;
    MinimumOutcome outcome;
    double x, value;  // NaN: not checked
    bool identifiable = false;
    MinimiseOptions options = {};
};

TEST(Minimise, OutcomesThatAreKnown)
{
    const std::vector<Known> all = {
        {"value zero, at a sample", [](double x) { return std::abs(x - 0.125); }, MinimumOutcome::converged, 0.125, 0.0, true},
        {"falling", [](double x) { return 1.0 - x; }, MinimumOutcome::at_upper_bound, 0.5, 0.5},
        {"rising", [](double x) { return 1.0 + x; }, MinimumOutcome::at_lower_bound, 0.0, 1.0},
        {"flat", [](double) { return 3.0; }, MinimumOutcome::flat, nan, 3.0},
        {"nowhere a number", [](double) { return nan; }, MinimumOutcome::not_finite, nan, nan},
        {"one sample is a number, so there is no bracket", [](double x) { return x == 0.25 ? 1.0 : nan; }, MinimumOutcome::not_finite, 0.25,
         1.0},
        {"a hole elsewhere", [](double x) { return x > 0.45 ? nan : std::pow(x - 0.15, 2); }, MinimumOutcome::converged, nan, nan, true},
        {"one iteration",
         [](double x) { return std::pow(x - 0.31, 2); },
         MinimumOutcome::iterations_exhausted,
         nan,
         nan,
         false,
         {.tolerance = 1e-9, .iterations = 1}},
    };
    for (const Known& known : all) {
        const Minimum minimum = minimise(known.function, 0.0, 0.5, known.options);
        EXPECT_EQ(minimum.outcome, known.outcome) << known.name;
        EXPECT_EQ(minimum.identifiable(), known.identifiable) << known.name;
        EXPECT_TRUE(std::isnan(known.x) || minimum.x == known.x) << known.name << ": " << minimum.x;
        EXPECT_TRUE(std::isnan(known.value) || minimum.value == known.value) << known.name << ": " << minimum.value;
    }
    EXPECT_TRUE(std::isinf(minimise(all[0].function, 0.0, 0.5).rise));
    EXPECT_TRUE(std::isnan(minimise(all[4].function, 0.0, 0.5).x));
    EXPECT_EQ(minimise(all[7].function, 0.0, 0.5, all[7].options).iterations, 1);
}

TEST(Minimise, AFlatBottomAndAShallowValleyAreNotIdentifiable)
{
    const auto tub = minimise([](double x) { return 1.0 + std::max(0.0, std::abs(x - 0.5) - 0.3); }, 0.0, 1.0);
    EXPECT_EQ(tub.value, 1.0);
    EXPECT_TRUE(tub.flat_valley);
    EXPECT_FALSE(tub.identifiable());
    // A change of 10 % increases the value by depth / 100 of 20: 0.5 % and 5 %. At 1.1 x the derivative of the rise is
    // 2 depth 0.1 1.1 / 0.3 / 20.
    const auto valley = [](double depth) {
        return minimise([depth](double x) { return 20.0 + depth * std::pow(x / 0.3 - 1.0, 2); }, 0.0, 0.5);
    };
    const double of_place = place_error(0.5 * default_tolerance, test_support::rounding_error(1, 20.0), 2.0 * 10.0 / (0.3 * 0.3));
    EXPECT_FALSE(valley(10.0).identifiable());
    EXPECT_NEAR(valley(10.0).rise, 0.005, 2.0 * 10.0 * 0.1 * 1.1 / 0.3 / 20.0 * of_place + test_support::rounding_error(6, 1.0));
    EXPECT_TRUE(valley(100.0).identifiable());
}

// A hole that Brent's method meets is reported, and the best number is kept.
TEST(Minimise, AHoleInTheBracketIsNotFinite)
{
    const auto hole = minimise([&](double x) { return std::abs(x - 0.31) < 5e-3 ? nan : std::pow(x - 0.31, 2); }, 0.0, 1.0, {.samples = 5});
    EXPECT_EQ(hole.outcome, MinimumOutcome::not_finite);
    EXPECT_TRUE(std::isfinite(hole.value));
    EXPECT_LE(std::abs(hole.x - 0.31), 0.31 - 0.25);  // 0.25 is a sample
}

TEST(Minimise, KeepsEveryEvaluationInOrderAndRefusesWhatIsNoInterval)
{
    int calls = 0;
    const auto minimum = minimise([&](double x) { return ++calls, std::pow(x - 0.31, 2); }, 0.0, 1.0);
    ASSERT_EQ(static_cast<int>(minimum.evaluations.size()), calls);
    for (std::size_t i = 1; i < minimum.evaluations.size(); ++i)
        EXPECT_LE(minimum.evaluations[i - 1].parameter, minimum.evaluations[i].parameter);
    const auto constant = [](double) { return 0.0; };
    for (const auto& [low, high] : {std::pair(1.0, 1.0), {1.0, 0.0}, {0.0, infinity}})
        EXPECT_THROW(minimise(constant, low, high), pbs::InputError) << low << " " << high;
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
    const double t = gsl_cdf_tdist_Pinv(0.975, 3), half_width = t * deviation / std::sqrt(4.0);
    // t sqrt(3 / 4 sum (x_i - mean)^2) of four places.
    EXPECT_NEAR(fit.interval.high - fit.interval.estimate, half_width, t * std::sqrt(3.0 / 4.0 * 4.0) * of_place);
    EXPECT_NEAR(fit.interval.estimate - fit.interval.low, half_width, t * std::sqrt(3.0 / 4.0 * 4.0) * of_place);
    ASSERT_EQ(fit.cases.size(), centres.size());
    for (std::size_t i = 0; i < centres.size(); ++i) EXPECT_NEAR(fit.cases[i].x, centres[i], tolerance);
}

TEST(FitOverCases, IntervalIsCutToTheBoundsAndOneCaseHasNone)
{
    const auto at = [](double centre) { return [centre](double x) { return std::abs(x - centre); }; };
    const auto fit = fit_over_cases({at(0.05), at(0.9)}, 0.0, 1.0);
    EXPECT_EQ(fit.interval.low, 0.0);
    EXPECT_EQ(fit.interval.high, 1.0);
    const auto one = fit_over_cases({at(0.4)}, 0.0, 1.0);
    EXPECT_NEAR(one.all.x, 0.4, default_tolerance);
    EXPECT_TRUE(std::isnan(one.interval.low));
    EXPECT_TRUE(one.without.empty());
}

TEST(FitOverCases, AsksACaseOnceAtEachParameter)
{
    std::vector<double> asked;
    const Misfit counted = [&](double x) { return asked.push_back(x), std::abs(x - 0.3); };
    fit_over_cases({counted, [](double x) { return std::abs(x - 0.4); }}, 0.0, 1.0);
    std::sort(asked.begin(), asked.end());
    EXPECT_EQ(std::adjacent_find(asked.begin(), asked.end()), asked.end());
}

// Fronts. Reference: the definitions, evaluated by hand on a few points.

using Front = std::vector<std::size_t>;
using Points = std::vector<WorkPrecision>;

TEST(ParetoFront, HoldsWhatNoneDominatesByCost)
{
    const std::vector<std::tuple<const char*, Points, Front>> all = {
        {"no point", {}, {}},
        {"a single point", {{2.0, 5.0}}, {0}},
        {"dominated points are left out", {{3.0, 1.0}, {1.0, 9.0}, {2.0, 9.5}, {2.0, 4.0}, {4.0, 1.5}}, {1, 3, 0}},
        {"at equal cost the smaller error", {{1.0, 5.0}, {1.0, 4.0}}, {1}},
        {"at equal error the cheaper", {{2.0, 5.0}, {1.0, 5.0}}, {1}},
        {"equal in both: together", {{1.0, 5.0}, {2.0, 3.0}, {1.0, 5.0}}, {0, 2, 1}},
        {"not finite: neither on it nor dominating", {{1.0, nan}, {nan, 1.0}, {-infinity, 0.0}, {2.0, 3.0}, {1.0, infinity}}, {3}},
    };
    for (const auto& [name, points, front] : all) EXPECT_EQ(pareto_front(points), front) << name;
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
    EXPECT_FALSE(best_within({}, 1.0));
    EXPECT_FALSE(best_within(points, 0.5));
    EXPECT_EQ(best_within(points, 1.0), 0u);
    EXPECT_EQ(best_within(points, 2.0), 1u);
    EXPECT_EQ(best_within(points, 9.0), 1u);  // the cheaper of two equal errors
}

}  // namespace
