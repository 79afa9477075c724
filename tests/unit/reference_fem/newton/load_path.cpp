// Reference: an attempt that fails in a known way.
#include "reference_fem/newton/load_path.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;

NewtonSummary ended(NewtonOutcome outcome)
{
    NewtonSummary summary;
    summary.outcome = outcome;
    return summary;
}

// Converges only in steps of at most `longest`, and never beyond `wall`; u(0) equals the fraction.
struct Attempt {
    Eigen::VectorXd& u;
    double longest, wall = 2.0;

    NewtonSummary operator()(double fraction) const
    {
        const bool converges = fraction - u(0) <= longest && fraction <= wall;
        u(0) = converges ? fraction : -99.0;  // the state that a failed solve leaves
        return ended(converges ? NewtonOutcome::converged : NewtonOutcome::no_descent);
    }
};

TEST(LoadPath, OneStepWhereItConverges)
{
    Eigen::VectorXd u = Eigen::VectorXd::Zero(1);
    const LoadPathSummary path = follow_load_path(Attempt{u, 1.0}, u, {});
    EXPECT_TRUE(path.converged());
    EXPECT_EQ(path.steps.size(), 1u);
    EXPECT_EQ(path.halvings(), 0);
}

// Two Newton steps per attempt.
TEST(LoadPath, EndsWhereItHasTakenTheStepsItMay)
{
    Eigen::VectorXd u = Eigen::VectorXd::Zero(1);
    const auto attempt = [&](double fraction) {
        NewtonSummary summary = Attempt{u, 0.25}(fraction);
        summary.iterations.assign(3, NewtonIteration{.step_length = 1.0});
        summary.iterations.back().step_length = 0.0;
        return summary;
    };
    const int needed = follow_load_path(attempt, u, {}).newton_steps();
    u.setZero();
    EXPECT_TRUE(follow_load_path(attempt, u, {.most_newton_steps = needed}).converged());
    u.setZero();
    const LoadPathSummary path = follow_load_path(attempt, u, {.most_newton_steps = needed - 2});  // the last attempt is not started
    EXPECT_FALSE(path.converged());
    EXPECT_EQ(path.reached, u(0));
    EXPECT_GT(path.reached, 0.0);
}

TEST(LoadPath, HalvesUntilAStepConvergesAndReachesTheEnd)
{
    Eigen::VectorXd u = Eigen::VectorXd::Zero(1);
    const LoadPathSummary path = follow_load_path(Attempt{u, 0.3}, u, {});
    EXPECT_TRUE(path.converged());
    EXPECT_EQ(u(0), 1.0);
    EXPECT_GE(path.halvings(), 2);  // 1 and 1/2 fail at first
}

TEST(LoadPath, DoublesAfterTwoThatConverge)
{
    Eigen::VectorXd u = Eigen::VectorXd::Zero(1);
    std::vector<double> fractions;
    const auto attempt = [&](double fraction) {
        fractions.push_back(fraction);
        return Attempt{u, 1.0}(fraction);
    };
    follow_load_path(attempt, u, {.first_step = 0.125});
    EXPECT_EQ(fractions, (std::vector<double>{0.125, 0.25, 0.5, 0.75, 1.0}));
}

TEST(LoadPath, StopsAtAWallInTheLastConvergedState)
{
    Eigen::VectorXd u = Eigen::VectorXd::Zero(1);
    const LoadPathSummary path = follow_load_path(Attempt{u, 1.0, 0.6}, u, {.first_step = 1.0, .smallest_step = 1.0 / 16.0});
    EXPECT_FALSE(path.converged());
    EXPECT_LE(path.reached, 0.6);
    EXPECT_GT(path.reached, 0.6 - 2.0 / 16.0);
    EXPECT_EQ(u(0), path.reached);
    EXPECT_EQ(path.steps.back().newton.outcome, NewtonOutcome::no_descent);
}

}  // namespace
