// Reference: sums and extremes over invented paths with known numbers.
#include "experiments/deformers/fem/fem_deformers.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

namespace {

using experiments::FrameSolve;
using experiments::NewtonRecord;
using namespace reference_fem;

NewtonSummary newton(NewtonOutcome outcome, int steps, int projected)
{
    NewtonSummary summary;
    summary.outcome = outcome;
    for (int k = 0; k < steps; ++k) summary.iterations.push_back({.residual_n = 10.0 - k, .step_length = 1.0, .projected = k < projected});
    summary.factorisations = steps + projected;
    return summary;
}

LoadPathSummary path(double reached, std::vector<LoadStep> steps)
{
    return {reached, std::move(steps), 2.0};
}

const Jacobians sound{0.9, 3, 0, 0.98};

TEST(NewtonRecord, AddsUpWhatFramesCost)
{
    NewtonRecord record(1.0);
    record.add_frame({{path(1.0, {{1.0, newton(NewtonOutcome::converged, 4, 0)}})}, 1.0, false}, sound);
    record.add_frame(
        {{path(1.0, {{1.0, newton(NewtonOutcome::no_descent, 5, 2)}, {0.5, newton(NewtonOutcome::converged, 3, 0)}})}, 1.0, false},
        {0.5, 7, 0, 1.01});
    const nlohmann::json json = record.to_json();
    EXPECT_EQ(json["newton_steps"]["mean"], 6.0);
    EXPECT_EQ(json["newton_steps"]["most"], 8);
    EXPECT_EQ(json["factorisations"], 14);
    EXPECT_EQ(json["projected_hessians"], 2);
    EXPECT_EQ(json["halvings"], 1);
    EXPECT_EQ(json["lowest_det_f"], 0.5);
    // 0.98 and 1.01 are not binary numbers: a rounding of one, times a hundred, and one of the product.
    EXPECT_NEAR(json["volume_change_pct"]["lowest"].get<double>(), -2.0, 100.0 * test_support::rounding_error(2, 1.0));
    EXPECT_NEAR(json["volume_change_pct"]["highest"].get<double>(), 1.0, 100.0 * test_support::rounding_error(2, 1.0));
    EXPECT_EQ(json["solve_s"]["mean"], 2.0);
    EXPECT_EQ(json["frames_not_converged"], 0);
}

TEST(NewtonRecord, AFrameThatIsNotReachedIsNamedWithItsReason)
{
    NewtonRecord record(1.0);
    record.add_frame({{path(1.0, {{1.0, newton(NewtonOutcome::converged, 1, 0)}})}, 1.0, false}, sound);
    record.add_frame(
        {{path(0.25, {{0.25, newton(NewtonOutcome::converged, 1, 0)}, {0.5, newton(NewtonOutcome::no_descent, 3, 3)}})}, 0.25, true},
        {-0.4, 17, 2, 0.5});
    const nlohmann::json json = record.to_json();
    ASSERT_EQ(json["not_converged"].size(), 1u);
    const nlohmann::json& failure = json["not_converged"][0];
    EXPECT_EQ(failure["frame"], 1);
    EXPECT_EQ(failure["reached"], 0.25);
    EXPECT_EQ(failure["restarted_from_rest"], true);
    EXPECT_EQ(failure["newton"], "no_descent");
    EXPECT_EQ(failure["last_residual_n"], 8.0);
    EXPECT_EQ(failure["worst_tet"], 17);
    EXPECT_EQ(failure["inverted_points"], 2);
    EXPECT_EQ(json["restarts_from_rest"], 1);
    EXPECT_EQ(json["lowest_det_f"], 0.9) << "of frames that converged";
}

}  // namespace
