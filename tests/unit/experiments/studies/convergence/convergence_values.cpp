// Reference: paths defined by formulas; a rate r needs ceil(log 0.05 / log r) iterations to the tolerance.
#include "experiments/studies/convergence/convergence_case.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "pbs/author/author_solver.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/iteration_paths.hpp"

#include <gtest/gtest.h>

namespace convergence_values_tests {
namespace {

using namespace experiments;
using analysis::Measurement;
using test_support::papers_paths;
using test_support::starts_at_rates;
using test_support::values_of_paths;

std::vector<Measurement> values_named(const std::vector<Measurement>& all, const std::string& quantity,
                                      const std::string& guess = "")
{
    std::vector<Measurement> named;
    for (const Measurement& measured : all)
        if (measured.quantity == quantity && (guess.empty() || measured.of.initial_guess == guess))
            named.push_back(measured);
    return named;
}

TEST(ConvergenceFigures, ValueIsOfTheOwnMeshAndTheOthersAreItsRange)
{
    const auto all =
        values_of_paths({starts_at_rates(1780, {0.9, 0.95, 0.9, 0.8}), starts_at_rates(1900, {0.88, 0.95, 0.9, 0.8}),
                         starts_at_rates(1650, {0.91, 0.95, 0.9, 0.8})});
    const auto iterations = values_named(all, "iterations_to_tolerance");
    ASSERT_EQ(iterations.size(), 2u);  // by residual; by volume, which stays at 1 %
    EXPECT_EQ(iterations[0].value, 29.0);
    EXPECT_EQ(iterations[0].low, 24.0);
    EXPECT_EQ(iterations[0].high, 32.0);
    EXPECT_EQ(iterations[1].value, 1000.0);
    EXPECT_EQ(iterations[1].limit, analysis::Limit::more_than);
}

TEST(ConvergenceFigures, EachOrderAndPrecisionHasAValueOfItsOwn)
{
    const auto all =
        values_of_paths({papers_paths({0.88, 0.9, 0.9, 0.9}), starts_at_rates(1780, {0.9, 0.9, 0.9, 0.9})});
    const auto iterations = values_named(all, "iterations_to_tolerance");
    ASSERT_EQ(iterations.size(), 4u);  // two settings by two tolerances
    for (const auto& [at, value, setting] : {std::tuple(0, 24.0, "plain f64"), {2, 29.0, "ordered f32"}}) {
        EXPECT_EQ(iterations[at].of.order + " " + iterations[at].of.precision, setting);
        EXPECT_EQ(iterations[at].value, value);
        EXPECT_EQ(iterations[at].low, value);
        EXPECT_EQ(iterations[at].high, value);
    }
}

// A residual of 0.5 would be a lower floor, by which nothing else converges.
TEST(ConvergenceFigures, ControlsAreComparedWithLbsAndLeaveTheFloorAsItIs)
{
    ConvergencePaths paths = papers_paths({0.9, 0.9, 0.9, 0.9});
    const auto all = values_of_paths({paths});
    const Measurement lbs = values_named(all, "iterations_over_lbs_guess", "lbs").at(0),
                      random = values_named(all, "iterations_over_lbs_guess", "random").at(0);
    EXPECT_EQ(lbs.value, 1.0);
    EXPECT_EQ(random.value, 1000.0 / 29.0);
    EXPECT_EQ(random.limit, analysis::Limit::at_least);
    paths.controls[0] = test_support::path_to_floor(1000, 0.5, 1.0, 0.9);
    EXPECT_EQ(values_named(values_of_paths({paths}), "iterations_to_tolerance").at(0).value, 29.0);
    EXPECT_LT(values_named(values_of_paths({paths}), "iterations_over_lbs_guess", "lbs").at(0).value, 1.0);
}

TEST(ConvergenceFigures, TheAuthorsLaterCodeHasAFloorOfItsOwn)
{
    ConvergencePaths paths = papers_paths({0.9, 0.9, 0.9, 0.9});
    paths.author = test_support::path_to_floor(1000, 3.0, 3.0, 0.5);  // 3 + 3 0.5^n <= 1.05 * 3 from n = 5 on
    const auto all = values_named(values_of_paths({paths}), "iterations_to_tolerance");
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[2].value, 5.0);
    EXPECT_EQ(all[2].limit, analysis::Limit::none);
    EXPECT_EQ(text_of(all[2].of),
              "human, pbs_author, first_fit, f64, vertices 1780, k_stretch 0.2, tolerance residual");
}

TEST(ConvergenceFigures, StartsAreComparedWithLbs)
{
    const auto all = values_of_paths({starts_at_rates(1780, {0.9, 0.95, 0.9, 0.8})});
    EXPECT_EQ(values_named(all, "iterations_over_lbs_guess", "previous_frame").at(0).value, 59.0 / 29.0);
    EXPECT_EQ(values_named(all, "iterations_over_lbs_guess", "rest_pose").at(0).value, 1.0);
    EXPECT_EQ(values_named(all, "iterations_over_lbs_guess", "rigid_bind").at(0).value, 14.0 / 29.0);
}

TEST(ConvergenceFigures, AStartThatNeverArrivesGivesABound)
{
    ConvergencePaths paths = starts_at_rates(1780, {0.9, 0.9, 0.9, 0.9});
    paths.paths[2] = test_support::path_to_floor(1000, 2.0, 1.0, 0.9);
    const auto ratio = values_named(values_of_paths({paths}), "iterations_over_lbs_guess", "rest_pose");
    ASSERT_EQ(ratio.size(), 1u);
    EXPECT_EQ(ratio[0].value, 1000.0 / 29.0);
    EXPECT_EQ(ratio[0].limit, analysis::Limit::at_least);
}

// Volume stays at 1 % from every initial guess.
TEST(ConvergenceFigures, WhereNeitherArrivesThereIsNone)
{
    const auto all = values_of_paths({starts_at_rates(1780, {0.9, 0.9, 0.9, 0.9})});
    for (const Measurement& measured : all)
        EXPECT_FALSE(measured.quantity == "iterations_over_lbs_guess" && measured.of.tolerance == "volume")
            << text_of(measured.of);
}

// From LBS and from the previous frame the second mesh is never within 0.5 %.
TEST(ConvergenceFigures, AMeshOnWhichNeitherArrivesOpensTheRange)
{
    ConvergencePaths arriving = starts_at_rates(1780, {0.9, 0.9, 0.9, 0.9}), lost = arriving;
    for (IterationPath& path : arriving.paths)
        for (Look& look : path.looks) look.volume_abs_change_pct = look.iteration < 8 ? 1.0 : 0.0;
    for (const std::size_t start : {2, 3}) lost.paths[start] = arriving.paths[start];
    const auto all = values_of_paths({arriving, lost});
    const auto previous = values_named(all, "iterations_over_lbs_guess", "previous_frame").at(1);
    EXPECT_EQ(previous.value, 1.0);
    EXPECT_EQ(previous.low, 0.0);
    EXPECT_EQ(previous.high, std::numeric_limits<double>::infinity());
    EXPECT_EQ(previous.not_reached, 1);
    EXPECT_EQ(previous.n, 2);
    EXPECT_EQ(values_named(all, "iterations_over_lbs_guess", "rest_pose").at(1).low, 8.0 / 1000.0);
}

TEST(ConvergenceFigures, TwistsAndTheLimbAreReportedAndNotJudged)
{
    ConvergencePaths twist = starts_at_rates(1780, {0.9, 0.95, 0.9, 0.8});
    twist.character = false;
    twist.twist = true;
    const auto all = values_of_paths({twist});
    EXPECT_TRUE(values_named(all, "iterations_to_tolerance").empty());
    EXPECT_TRUE(values_named(all, "iterations_over_lbs_guess", "previous_frame").empty());
    EXPECT_EQ(values_named(all, "iterations_to_tolerance_of_limbs").at(0).value, 29.0);
    EXPECT_EQ(values_named(all, "iterations_over_lbs_guess_in_a_twist", "previous_frame").at(0).value, 59.0 / 29.0);
}

// Rates exp(-1 / sqrt(vertices)) need log 20 sqrt(vertices) iterations, rounded up: by at most 1 in 67, 1.5 % at one
// end of a factor of 64.
TEST(ConvergenceFigures, ExponentOfALadderIsThatOfTheFormula)
{
    std::vector<ConvergencePaths> ladder;
    for (const int vertices : {500, 2000, 8000, 32000})
        for (const auto order : {pbs::Order::ordered, pbs::Order::plain}) {
            const double rate = order == pbs::Order::plain ? 0.5 : std::exp(-1.0 / std::sqrt(vertices));
            ladder.push_back(starts_at_rates(vertices, {rate, 0.5, 0.5, 0.5}, 4000));
            ladder.back().of.order = name_of(order);
        }
    const auto all = values_of_paths(ladder, true), exponent = convergence_conclusions(all);
    ASSERT_EQ(exponent.size(), 2u);  // one for each order
    EXPECT_EQ(exponent[1].value, 0.0);
    EXPECT_NEAR(exponent[0].value, 0.5, 0.015 / std::log(64.0) * 2.0);
    EXPECT_LE(exponent[0].low, exponent[0].value);
    EXPECT_GE(exponent[0].high, exponent[0].value);
    EXPECT_EQ(text_of(exponent[0].of),
              "human, pbs, ordered, f32, vertices 500 to 32000, k_stretch 0.2, tolerance residual");
    // One for each size and order, with two tolerances.
    EXPECT_EQ(values_named(all, "iterations_to_tolerance").size(), 16u);
    EXPECT_TRUE(values_named(all, "iterations_over_lbs_guess").empty());
}

// Two sizes have an exponent for any numbers of iterations.
TEST(ConvergenceFigures, TwoSizesHaveNoExponent)
{
    std::vector<ConvergencePaths> ladder = {starts_at_rates(500, {0.9, 0.9, 0.9, 0.9}),
                                            starts_at_rates(2000, {0.95, 0.9, 0.9, 0.9})};
    ladder.push_back(starts_at_rates(8000, {0.999999, 0.9, 0.9, 0.9}));  // not reached
    EXPECT_TRUE(convergence_conclusions(values_of_paths(ladder, true)).empty());
}

TEST(ConvergenceFigures, ErrorsOfNoReferenceAreLeftOut)
{
    ConvergencePaths paths = starts_at_rates(1780, {0.9, 0.9, 0.9, 0.9});
    for (IterationPath& path : paths.paths)
        for (Look& look : path.looks) look.error_joint_pct = std::numeric_limits<double>::quiet_NaN();
    for (const Measurement& measured : values_of_paths({paths}))
        EXPECT_FALSE(measured.quantity.starts_with("error")) << measured.quantity;
}

// Reference: the definition of each initial guess.

const test_support::TwoBoneLimb limb = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 0.0);
const pbs::Character character = test_support::character_of(limb);
const pbs::Motion bending = pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitZ(), 60.0, 4, 0.01);

const pbs::Positions& shape(const FrameStarts& frame, SolverStart start)
{
    return frame.shapes[static_cast<int>(start)];
}

pbs::Positions blended(const pbs::Weights& weights, const pbs::Pose& pose)
{
    pbs::Positions positions;
    pbs::linear_blend_skinning(limb.mesh.rest, weights, pose, positions);
    return positions;
}

TEST(Starts, AreWhatTheyAreCalled)
{
    const FrameStarts frame = experiments::starts_of(character, bending, {3}, {}).front();
    EXPECT_EQ(shape(frame, SolverStart::lbs), blended(limb.weights, bending.steps[3]));
    EXPECT_EQ(shape(frame, SolverStart::rigid_bind), blended(pbs::rigid_weights(limb.binding), bending.steps[3]));
    EXPECT_EQ(shape(frame, SolverStart::rest_pose), limb.mesh.rest);
    EXPECT_EQ(frame.bind_points, pbs::posed_bind_points(limb.binding, bending.steps[3]));
    EXPECT_NE(shape(frame, SolverStart::lbs), shape(frame, SolverStart::rigid_bind));
}

// Reference: the rule by hand. floor(n 10^0.2) is the next iteration on record wherever it is beyond n + 1:
// 6 follows 4, 9 follows 6, and 14 follows 9.
TEST(LookRows, AreFiveForEachDecadeAndTheLast)
{
    ConvergenceResult result{{starts_at_rates(1780, {0.9}, 100)}};
    std::vector<int> iterations;
    for (const LookRow& row : look_rows(result)) iterations.push_back(row.look.iteration);
    EXPECT_EQ(iterations, (std::vector{0, 1, 2, 3, 4, 6, 9, 14, 22, 34, 53, 83, 100}));
}

// The mean of n numbers that are uniform in an interval has the standard deviation of 1 / sqrt(12 n) of its width.
TEST(Starts, RandomPositionsFillTheBoxOfLbsAndAreTheSameAgain)
{
    const FrameStarts frame = experiments::starts_of(character, bending, {3}, {}).front();
    EXPECT_EQ(frame.random, experiments::starts_of(character, bending, {3}, {}).front().random);
    const pbs::Positions& lbs = shape(frame, SolverStart::lbs);
    ASSERT_EQ(frame.random.rows(), lbs.rows());
    for (int axis = 0; axis < 3; ++axis) {
        const double low = lbs.col(axis).minCoeff(), high = lbs.col(axis).maxCoeff();
        EXPECT_GE(frame.random.col(axis).minCoeff(), low);
        EXPECT_LE(frame.random.col(axis).maxCoeff(), high);
        EXPECT_NEAR(frame.random.col(axis).mean(), 0.5 * (low + high),
                    6.0 * (high - low) / std::sqrt(12.0 * double(lbs.rows())));
    }
}

// Reference: the author's solver, which ends where its path does, to the bit.
TEST(AuthorPath, LeadsFromItsLbsWhereTheAuthorsSolverGoes)
{
    const pbs::Pose& pose = bending.steps[3];
    const IterationMetrics metrics(character, pbs::posed_bind_points(limb.binding, pose));
    const IterationPath path = author_path(character, pose, 12, metrics);
    pbs::AuthorSolver solver(limb.mesh, limb.skeleton, limb.binding, {.iterations = 12});
    solver.advance(pose);
    EXPECT_EQ(path.last, solver.positions());
    ASSERT_EQ(path.looks.size(), 13u);
    EXPECT_EQ(path.looks.front().combined,
              metrics.measure(0, blended(pbs::author_weights(limb.binding, limb.skeleton), pose)).combined);
}

// The first frame has none before it.
TEST(Starts, ThePreviousFrameIsWhatTheSolverMadeOfTheOneBeforeWithSeveralStepsAFrameToo)
{
    pbs::PbsSolver solver(limb.mesh, limb.binding.distance, {}, {});
    pbs::Positions positions = limb.mesh.rest;
    for (int step = 0; step < 3; ++step) {
        solver.advance(positions, pbs::posed_bind_points(limb.binding, bending.steps[step]), 0.01);
        positions = solver.positions();
    }
    EXPECT_EQ(shape(experiments::starts_of(character, bending, {3}, {}).front(), SolverStart::previous_frame),
              positions);
    EXPECT_EQ(shape(experiments::starts_of(character, bending, {1, 3}, {}).back(), SolverStart::previous_frame),
              positions);
    const FrameStarts frame = experiments::starts_of(character, bending, {0}, {}).front();
    EXPECT_EQ(shape(frame, SolverStart::previous_frame), shape(frame, SolverStart::lbs));
    pbs::Motion slower = bending;
    slower.steps_per_frame = 3;
    EXPECT_EQ(shape(experiments::starts_of(character, slower, {1}, {}).front(), SolverStart::previous_frame),
              shape(experiments::starts_of(character, bending, {3}, {}).front(), SolverStart::previous_frame));
}

}  // namespace
}  // namespace convergence_values_tests
