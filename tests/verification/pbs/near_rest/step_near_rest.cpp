// Reference: linear algebra for one hanging particle; for a bar, the time stepper itself, which stays in the state of rest.
#include "pbs/near_rest/step_near_rest.hpp"

#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/hanging_tet.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace {

using pbs::Positions;
using pbs::settle;
using pbs::Vec3;

TEST(SettledState, OfAHangingParticleIsTheFixedPoint)
{
    const auto tet = test_support::hanging_tet();
    const Vec3 acceleration(1.0, 2.0, -10.0);
    for (const int iterations : {1, 4, 24}) {
        const auto state = settle(tet.mesh, tet.held, test_support::stretch_alone(iterations, 0.2), acceleration);
        const Eigen::Matrix3d S = test_support::step_matrix(tet, iterations, 0.2);
        const Vec3 expected = (Eigen::Matrix3d::Identity() - S).inverse() * S * acceleration;
        EXPECT_TRUE(state.converged);
        // The residual is required to be at most 1e-7 of the right-hand side.
        const double of_residual = (Eigen::Matrix3d::Identity() - S).inverse().norm() * 1e-7 * (S * acceleration).norm();
        EXPECT_LT((state.displacement.row(3).transpose() - expected).norm(), of_residual) << iterations;
        EXPECT_EQ(state.displacement.topRows(3), Positions::Zero(3, 3));
    }
}

// A bar held at one end, with stretch and volume constraints. A time step with gravity does not move it away from its state of rest: the
// first step is S (x + a dt^2) = x. Only the second order may move it, a share of deflection over edge of the deflection.
TEST(SettledState, OfABarIsWhereTheTimeStepperStays)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {1.0, 0.2, 0.2}, {10, 2, 2});
    std::vector<bool> held, free;
    for (const auto& vertex : bar.rest.rowwise()) held.push_back(vertex(0) == 0.0), free.push_back(vertex(0) != 0.0);
    pbs::PbsOptions options;
    options.iterations = 8;
    options.k_stretch = 0.3;
    options.masses = pbs::Masses::lumped;
    const auto state = settle(bar, held, options, -Vec3::UnitZ());
    ASSERT_TRUE(state.converged);

    const double deflection_m = 1e-5, tip = state.displacement.cwiseAbs().maxCoeff();
    for (const double dt_s : {0.01, 0.002}) {
        pbs::PbsOptions stepping = options;
        stepping.precision = pbs::Precision::f64;
        stepping.order = pbs::Order::plain;  // the order of the settled state
        stepping.k_bind = 0.0;
        stepping.jiggle = pbs::Jiggle{options.k_stretch};
        stepping.gravity_m_s2 = -deflection_m / (tip * dt_s * dt_s) * Vec3::UnitZ();  // the same deflection at any time step
        pbs::PbsSolver solver(bar, Eigen::VectorXd::Zero(bar.rest.rows()), free, stepping, held);
        const Positions start = bar.rest + deflection_m / tip * state.displacement;
        for (int step = 0; step < 200; ++step) solver.advance(step == 0 ? start : bar.rest, bar.rest, dt_s);
        EXPECT_LT((solver.positions() - start).cwiseAbs().maxCoeff(), deflection_m / 0.1 * deflection_m) << dt_s;
    }
}

TEST(SettledState, SaysThatItDidNotConverge)
{
    // Nothing draws the particle back, so it never rests.
    const auto tet = test_support::hanging_tet();
    EXPECT_FALSE(settle(tet.mesh, tet.held, test_support::stretch_alone(0, 0.2), -Vec3::UnitZ()).converged);
}

}  // namespace
