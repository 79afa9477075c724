// Reference: linear algebra. One particle hangs from three held ones by the three edges of a tet, k_stretch on each:
// near rest the iterations are a 3 x 3 matrix S (tests/support/hanging_tet.hpp), and Algorithm 1 is the recurrence
//   x(t+1) = S (2 x(t) - x(t-1) + g dt^2)
// with the fixed point (I - S)^-1 S g dt^2. Tolerances: the neglected terms, of second order in displacement over
// length, and rounding.
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/hanging_tet.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using pbs::Vec3;

const test_support::HangingTet tet = test_support::hanging_tet();
constexpr double dt_s = 0.01, k_stretch = 0.2;
const Vec3 gravity(1e-3, 2e-3, -1e-2);

pbs::PbsOptions options_of(int iterations)
{
    pbs::PbsOptions options = test_support::stretch_alone(iterations, k_stretch);
    options.gravity_m_s2 = gravity;
    options.jiggle = pbs::Jiggle{k_stretch};
    return options;
}

// The second-order error [m] of one step that begins at a displacement of that size [m]. The projection of an edge of
// length l neglects k |u|^2 / l times (sin^2 / 2, sin cos) of the angle between u and the edge, of its length and of
// its direction, at most 1 / sqrt 3. The matrix of a sweep over the three edges reduces u before and the error after.
// Each projection also rounds positions of the order of 1 m, with four more roundings in a step.
double step_error_m(int iterations, double predicted_m)
{
    std::vector<double> reduced = {1.0};
    for (int i = 1; i < iterations; ++i) reduced.push_back(test_support::step_matrix(tet, i, k_stretch).norm());
    double shortest_m = 1e9, error_m = test_support::rounding_error(3 * iterations + 4, 1.0);
    for (int other = 0; other < 3; ++other)
        shortest_m = std::min(shortest_m, (tet.mesh.rest.row(3) - tet.mesh.rest.row(other)).norm());
    for (int i = 0; i < iterations; ++i)
        error_m += std::sqrt(3.0) * k_stretch / shortest_m * reduced[iterations - 1 - i] *
                   std::pow(reduced[i] * predicted_m, 2);
    return error_m;
}

class HangingParticle : public testing::TestWithParam<int> {
protected:
    pbs::PbsSolver solver{tet.mesh, Eigen::VectorXd::Zero(4), tet.free, options_of(GetParam()), tet.held};
    const Eigen::Matrix3d S = test_support::step_matrix(tet, GetParam(), k_stretch);
    Vec3 displacement() const { return solver.positions().row(3) - tet.mesh.rest.row(3); }
};

TEST_P(HangingParticle, FollowsTheRecurrence)
{
    Vec3 last = Vec3::Zero(), now = Vec3::Zero();
    // The recurrence applies R(t+1) = S (2 R(t) - R(t-1)), R(0) = I, to the error of a step t steps before.
    Eigen::Matrix3d carried_last = Eigen::Matrix3d::Zero(), carried = Eigen::Matrix3d::Identity();
    double farthest_m = 0.0, carries = 0.0;
    for (int step = 0; step < 50; ++step) {
        const Vec3 predicted = 2.0 * now - last + gravity * dt_s * dt_s;
        farthest_m = std::max(farthest_m, predicted.norm());
        carries += carried.norm();
        last = now;
        now = S * predicted;
        const Eigen::Matrix3d next = S * (2.0 * carried - carried_last);
        carried_last = carried;
        carried = next;
        solver.advance(tet.mesh.rest, tet.mesh.rest, dt_s);
        const double error_m = carries * step_error_m(GetParam(), farthest_m);
        ASSERT_LT((displacement() - now).norm(), error_m) << step;
        ASSERT_LT(error_m, 1e-3 * farthest_m) << "a bound that would let another frequency pass proves nothing";
    }
}

TEST_P(HangingParticle, SettlesAtTheFixedPoint)
{
    for (int step = 0; step < 3000; ++step) solver.advance(tet.mesh.rest, tet.mesh.rest, dt_s);
    const Eigen::Matrix3d inverse = (Eigen::Matrix3d::Identity() - S).inverse();
    const Vec3 fall = gravity * dt_s * dt_s, expected = inverse * S * fall;
    EXPECT_LT((displacement() - expected).norm(), inverse.norm() * step_error_m(GetParam(), (expected + fall).norm()));
}

TEST_P(HangingParticle, HeldOnesStayToTheBit)
{
    for (int step = 0; step < 20; ++step) solver.advance(tet.mesh.rest, tet.mesh.rest, dt_s);
    EXPECT_EQ(solver.positions().topRows(3), tet.mesh.rest.topRows(3));
}

INSTANTIATE_TEST_SUITE_P(Iterations, HangingParticle, testing::Values(1, 4, 24));

}  // namespace
