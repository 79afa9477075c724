// Reference: the solver's own step for the end of a path, its own residuals for the measurements on positions, and a
// uniformly scaled body, whose residuals are known.

#include "experiments/studies/shared/iteration_path.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/iteration_paths.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace iteration_path_tests {
namespace {

using namespace test_support;
using namespace experiments;
using pbs::Order;
using pbs::Precision;

const TwoBoneLimb limb = two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0);
const pbs::Character character = character_of(limb);

IterationPath path_of(const pbs::PbsOptions& options, const pbs::Positions& start, int most)
{
    const IterationMetrics iteration_metrics(character, limb.bind_points);
    return iterate(character, options, limb.bind_points, {start}, most, iteration_metrics).front();
}

class IterationPathOf : public testing::TestWithParam<std::pair<Order, Precision>> {};

// The root mean square of residuals differs by no more than the residuals: by eight roundings of a length and of a
// distance in the solver's scalar, over their lengths at rest, and of sixteen of a volume, of products of at most five
// times its size; no length and no volume doubles. The solver's positions are relative to an origin, to which a
// coordinate of a metre is added in double: over a cell's width of 0.075 m these are 2 sqrt 3 / 0.075 roundings of a
// length and three times as many of a volume. A sum goes through as many roundings as there are terms.
TEST_P(IterationPathOf, LeadsWhereTheSolverGoesToTheBitAndHasItsResiduals)
{
    pbs::PbsOptions options;
    std::tie(options.order, options.precision) = GetParam();
    options.iterations = 24;
    options.record_iterations = true;
    pbs::PbsSolver solver(limb.mesh, limb.binding.distance, {}, options);
    const auto history = solver.advance(limb.lbs, limb.bind_points, 0.01).history;
    const IterationPath path = path_of(options, limb.lbs, 24);
    EXPECT_EQ(path.last, solver.positions());
    ASSERT_EQ(path.looks.size(), 25u);
    const double of_scalar = options.precision == Precision::f32 ? 0x1p29 : 1.0;  // unit roundoff over that of double
    const double of_coordinate = 2.0 * std::sqrt(3.0) / 0.075, sums = 2.0 * static_cast<double>(limb.mesh.tets.rows());
    const double of_stretch = rounding_error(of_scalar * 8 + of_coordinate + sums, 2.0),
                 of_volume = rounding_error(of_scalar * 16 * 5 + 3 * of_coordinate + sums, 2.0),
                 of_bind_m = rounding_error(of_scalar * 8 + 2 + sums, 1.0);
    for (int n = 1; n <= 24; ++n) {
        EXPECT_EQ(path.looks[n].iteration, n);
        EXPECT_NEAR(path.looks[n].stretch_rms, history[n - 1].stretch_rms, of_stretch);
        EXPECT_NEAR(path.looks[n].volume_rms, history[n - 1].volume_rms, of_volume);
        EXPECT_NEAR(path.looks[n].bind_rms_m, history[n - 1].bind_rms_m, of_bind_m);
    }
}

INSTANTIATE_TEST_SUITE_P(Orders, IterationPathOf,
                         testing::Values(std::pair(Order::plain, Precision::f64),
                                         std::pair(Order::ordered, Precision::f32),
                                         std::pair(Order::ordered, Precision::f64)));

// A coordinate of at most 1.1 is rounded once by the scale, over a cell of at least 0.075: 2 / 0.075 = 27 roundings of
// an edge and 80 of a volume, which goes through ten of products of at most five times its size. A ratio contains two
// volumes or lengths, and one is subtracted from it.
TEST(IterationMetrics, OfAUniformlyScaledBody)
{
    constexpr double scale = 1.1;
    const pbs::Positions rest_points = limb.binding.rest_point;
    const IterationMetrics iteration_metrics(character, scale * rest_points);
    const Look look = iteration_metrics.measure(0, scale * limb.mesh.rest);
    const double stretch = scale - 1.0, volume = std::pow(scale, 3) - 1.0;
    const double bind_m = stretch * std::sqrt(limb.binding.distance.array().square().mean());
    const double of_stretch = rounding_error(27 + 2 * 5, scale) + rounding_error(4, 1.0 + scale),
                 of_volume = rounding_error(80 + 2 * 5 * 10, 1.0 + volume) + rounding_error(4, 2.0 + volume),
                 of_bind_m = rounding_error(2 * std::sqrt(3.0) + 2 * 5, scale);
    EXPECT_NEAR(look.stretch_rms, stretch, of_stretch);
    EXPECT_NEAR(look.volume_rms, volume, of_volume);
    EXPECT_NEAR(look.bind_rms_m, bind_m, of_bind_m);
    EXPECT_NEAR(look.volume_change_pct, 100.0 * volume, 100.0 * of_volume);
    const double bind = bind_m / limb.binding.distance.mean();
    EXPECT_NEAR(look.combined, std::sqrt((stretch * stretch + volume * volume + bind * bind) / 3.0),
                of_stretch + of_volume + of_bind_m / limb.binding.distance.mean());
    EXPECT_TRUE(std::isnan(look.error_joint_pct));
}

TEST(LookedAt, EveryIterationOfThePaperThenTwoPerCent)
{
    const std::vector<int> looks = looked_at(1000);
    for (int n = 0; n <= 64; ++n) EXPECT_EQ(looks[n], n);
    EXPECT_EQ(looks.back(), 1000);
    for (std::size_t i = 1; i < looks.size(); ++i) {
        EXPECT_GT(looks[i], looks[i - 1]);
        EXPECT_LE(looks[i], std::max(looks[i - 1] + 1.0, std::ceil(1.02 * looks[i - 1])));
    }
    EXPECT_EQ(looked_at(0), std::vector<int>{0});
}

TEST(Iterate, EndsWherePositionsCeaseToBeFinite)
{
    pbs::Positions broken = limb.lbs;
    broken(3, 1) = std::numeric_limits<double>::quiet_NaN();
    const IterationPath path = path_of({}, broken, 100);
    EXPECT_FALSE(path.finite);
    EXPECT_EQ(path.looks.size(), 1u);
}

TEST(Iterate, OneStartDoesNotRememberAnother)
{
    const IterationMetrics iteration_metrics(character, limb.bind_points);
    const auto both = iterate(character, {}, limb.bind_points, {limb.mesh.rest, limb.lbs}, 10, iteration_metrics);
    EXPECT_EQ(both[1].last, path_of({}, limb.lbs, 10).last);
}

// Reference: paths defined by formulas, whose rates and floors are known.

TEST(ReachedResidual, IsTheIterationFromWhichOnItStaysWithinFivePerCentOfTheFloor)
{
    const std::vector<IterationPath> stalled = {path_to_floor(100, 1.0, 1.0, 0.5), path_to_floor(100, 1.06, 1.0, 0.5)};
    EXPECT_EQ(floor_of(stalled), stalled[0].looks.back().combined);
    const IterationPath formula = path_to_floor(1000, 1.0, 1.0, 0.9);
    struct Row {
        const char* name;
        IterationPath path;
        double floor;
        int iterations;
        bool within;
    };
    const Row rows[] = {
        {"1 + 0.9^n <= 1.05 from n = ceil(log 0.05 / log 0.9) on", formula, floor_of({formula}), 29, true},
        {"it leaves once more", path_by(100, [](int n) { return n == 40  ? 1.2
                                                                : n < 10 ? 2.0
                                                                         : 1.0; }), 1.0, 41, true},
        {"it stalls above the lowest floor", stalled[1], floor_of(stalled), 100, false},
        {"rounding", path_by(100, [](int n) { return n % 2 == 0 ? 3e-7 : 6e-7; }), 3e-7, 0, true}};
    for (const Row& row : rows) {
        const Reached reached = reached_residual(row.path, row.floor);
        EXPECT_EQ(reached.iterations, row.iterations) << row.name;
        EXPECT_EQ(reached.within, row.within) << row.name;
    }
}

TEST(FloorOf, LeavesOutWhatBrokeDownAndVolumeIsWithinThePapersHalfPerCent)
{
    EXPECT_EQ(reached_volume(path_by(50, [](int n) { return n < 7 ? 0.51 : 0.5; })).iterations, 7);
    EXPECT_FALSE(reached_volume(path_by(50, [](int) { return 0.51; })).within);
    IterationPath broken = path_by(3, [](int) { return 0.1; });
    broken.finite = false;
    EXPECT_EQ(floor_of({broken, path_by(3, [](int) { return 0.4; })}), 0.4);
    EXPECT_TRUE(std::isnan(floor_of({broken})));
}

// The rounding error of the slope of log(above rate^n) against n = 1, 2, ..., iterations. The numbers 1 + above rate^n
// are rounded once, which the difference from 1 magnifies most at the end; a power, a product and a logarithm of at
// most `steepest` go through two more, each.
double log_rate_error(int iterations, double above, double rate)
{
    std::vector<double> n, logs;
    for (int i = 1; i <= iterations; ++i) n.push_back(i), logs.push_back(std::log(above) + i * std::log(rate));
    const double least = above * std::pow(rate, iterations),
                 steepest = std::max(std::abs(logs.front()), std::abs(logs.back()));
    const double of_logs = rounding_error(1, (1.0 + least) / least) + rounding_error(2 + 1 + 2 * steepest, 1.0);
    return slope_error(n, logs, std::log(rate), 0.0, of_logs);
}

// The end of the path replaces the limit: 0.9^400 is below the spacing of numbers at 1.
TEST(RateOf, IsThatOfTheFormula)
{
    EXPECT_NEAR(rate_of(path_to_floor(400, 1.0, 1.0, 0.9), 0.3), 0.9,
                0.9 * log_rate_error(29, 1.0, 0.9) + rounding_error(2, 0.9));
}

// Rounding has no rate.
TEST(RateOf, OfAResidualThatStillFallsIsTakenFromTheFloorOfOthers)
{
    EXPECT_TRUE(std::isnan(rate_of(path_by(100, [](int n) { return n % 2 == 0 ? 3e-7 : 6e-7; }), 3e-7)));
    EXPECT_NEAR(rate_of(path_to_floor(400, 1.0, 10.0, 0.995), 1.0), 0.995,
                0.995 * log_rate_error(400, 10.0, 0.995) + rounding_error(2, 0.995));
}

TEST(LookAt, IsTheLastOneNotAfterItAndTheNearestToTheReferenceNeedNotBeTheLast)
{
    IterationPath path = path_by(10, [](int n) { return 1.0 + n; });
    path.looks.erase(path.looks.begin() + 5);
    EXPECT_EQ(look_at(path, 5).iteration, 4);
    EXPECT_EQ(look_at(path, 100).iteration, 10);
    EXPECT_EQ(nearest_to_reference(path_by(100, [](int n) { return 1.0 + std::abs(n - 13); })).iteration, 13);
}

// Reference: the sequence by its definition, and that no constraint is lost or changed.

// Constraints that are numbered by their rest value.
template <typename Scalar>
pbs::ConstraintSet<Scalar> numbered(int edges, int tets)
{
    pbs::ConstraintSet<Scalar> constraints;
    for (int e = 0; e < edges; ++e) constraints.stretch.push_back({{e, e + 1}, Scalar(e), Scalar(1)});
    for (int t = 0; t < tets; ++t) constraints.volume.push_back({{t, t + 1, t + 2, t + 3}, Scalar(t), Scalar(1)});
    return constraints;
}

// A constraint keeps its vertices.
template <typename Constraint, typename Rest>
std::vector<int> numbers_of(const std::vector<Constraint>& constraints, Rest Constraint::*rest)
{
    std::vector<int> numbers;
    for (const Constraint& constraint : constraints) {
        numbers.push_back(static_cast<int>(constraint.*rest));
        EXPECT_EQ(constraint.vertex[0], numbers.back());
    }
    return numbers;
}

struct Numbers {
    std::vector<int> edges, tets;
    bool operator==(const Numbers&) const = default;
};

template <typename Scalar>
Numbers numbers_in(const pbs::ConstraintSet<Scalar>& constraints)
{
    return {numbers_of(constraints.stretch, &pbs::StretchConstraint<Scalar>::rest_length),
            numbers_of(constraints.volume, &pbs::VolumeConstraint<Scalar>::rest_volume)};
}

template <typename Scalar>
Numbers randomly_numbered(int edges, int tets, unsigned seed)
{
    auto constraints = numbered<Scalar>(edges, tets);
    in_random_sequence(constraints, seed);
    return numbers_in(constraints);
}

TEST(ConstraintSequence, SpreadTakesEightPartsInTurn)
{
    // parts of three
    const auto constraints = in_spread_order(numbered<double>(20, 4)), none = in_spread_order(numbered<double>(0, 0));
    EXPECT_EQ(numbers_in(constraints).edges,
              (std::vector<int>{0, 3, 6, 9, 12, 15, 18, 1, 4, 7, 10, 13, 16, 19, 2, 5, 8, 11, 14, 17}));
    EXPECT_EQ(numbers_in(constraints).tets, (std::vector<int>{0, 1, 2, 3}));
    EXPECT_EQ(numbers_in(none), Numbers());
}

TEST(ConstraintSequence, RandomIsAPermutationThatDependsOnTheSeedAlone)
{
    const Numbers random = randomly_numbered<double>(1000, 500, 7);
    Numbers sorted = random;
    for (std::vector<int>* numbers : {&sorted.edges, &sorted.tets}) {
        EXPECT_FALSE(std::ranges::is_sorted(*numbers));
        std::ranges::sort(*numbers);
    }
    EXPECT_EQ(sorted, numbers_in(numbered<double>(1000, 500)));
    EXPECT_EQ(randomly_numbered<double>(1000, 500, 7), random);
    EXPECT_EQ(randomly_numbered<float>(1000, 500, 7), random);
    EXPECT_NE(randomly_numbered<double>(1000, 500, 8).edges, random.edges);
    EXPECT_EQ(randomly_numbered<double>(0, 0, 7), Numbers());
}

}  // namespace
}  // namespace iteration_path_tests
