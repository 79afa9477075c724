// Reference: linear algebra. One particle hangs from three held ones by the three edges of a tet, k_stretch on each: near rest the
// iterations are a 3 x 3 matrix S (tests/support/hanging_tet.hpp), and Algorithm 1 is the recurrence
//   x(t+1) = S (2 x(t) - x(t-1) + g dt^2)
// with the fixed point (I - S)^-1 S g dt^2. Tolerances: the neglected terms are of second order in displacement over length, 1e-6 here.
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/hanging_tet.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

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

class HangingParticle : public testing::TestWithParam<int> {
protected:
    pbs::PbsSolver solver{tet.mesh, Eigen::VectorXd::Zero(4), tet.free, options_of(GetParam()), tet.held};
    const Eigen::Matrix3d S = test_support::step_matrix(tet, GetParam(), k_stretch);
    Vec3 displacement() const { return solver.positions().row(3) - tet.mesh.rest.row(3); }
};

TEST_P(HangingParticle, FollowsTheRecurrence)
{
    Vec3 last = Vec3::Zero(), now = Vec3::Zero();
    for (int step = 0; step < 50; ++step) {
        const Vec3 next = S * (2.0 * now - last + gravity * dt_s * dt_s);
        last = now;
        now = next;
        solver.advance(tet.mesh.rest, tet.mesh.rest, dt_s);
        ASSERT_LT((displacement() - now).norm(), 1e-5 * now.norm()) << step;
    }
}

TEST_P(HangingParticle, SettlesAtTheFixedPoint)
{
    for (int step = 0; step < 3000; ++step) solver.advance(tet.mesh.rest, tet.mesh.rest, dt_s);
    const Vec3 expected = (Eigen::Matrix3d::Identity() - S).inverse() * S * gravity * dt_s * dt_s;
    EXPECT_LT((displacement() - expected).norm(), 1e-5 * expected.norm());
}

TEST_P(HangingParticle, HeldOnesStayToTheBit)
{
    for (int step = 0; step < 20; ++step) solver.advance(tet.mesh.rest, tet.mesh.rest, dt_s);
    EXPECT_EQ(solver.positions().topRows(3), tet.mesh.rest.topRows(3));
}

INSTANTIATE_TEST_SUITE_P(Iterations, HangingParticle, testing::Values(1, 4, 24));

}  // namespace
