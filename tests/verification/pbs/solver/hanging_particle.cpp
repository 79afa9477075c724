// Truth: linear algebra. One particle hangs from three held ones by the three edges of a tet, k_stretch on each. Near rest an edge of unit
// direction n moves the particle by d <- (I - k n n^T) d, so n_i iterations are a 3 x 3 matrix S, and Algorithm 1 is the recurrence
//   x(t+1) = S (2 x(t) - x(t-1) + g dt^2)
// with the fixed point (I - S)^-1 S g dt^2. Tolerances: what is left out is of second order in displacement over length, 1e-6 here.
#include "pbs/solver/pbs_solver.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace {

using pbs::Vec3;

const pbs::TetMesh tet = [] {
    pbs::TetMesh mesh;
    mesh.rest.resize(4, 3);
    mesh.rest << 0.0, 0.0, 0.0, 1.0, 0.1, 0.0, 0.2, 1.1, 0.1, 0.4, 0.3, -0.9;
    mesh.tets.resize(1, 4);
    mesh.tets << 0, 2, 1, 3;
    return mesh;
}();
const std::vector<bool> held = {true, true, true, false}, free_zone = {false, false, false, true};
constexpr double dt_s = 0.01;
const Vec3 gravity(1e-3, 2e-3, -1e-2);

pbs::PbsOptions options_of(int iterations)
{
    pbs::PbsOptions options;
    options.iterations = iterations;
    options.k_stretch = 0.2;
    options.k_volume = options.k_bind = 0.0;
    options.precision = pbs::Precision::f64;
    options.gravity_m_s2 = gravity;
    options.jiggle = pbs::Jiggle{0.2};
    return options;
}

Eigen::Matrix3d step_matrix(int iterations)
{
    Eigen::Matrix3d sweep = Eigen::Matrix3d::Identity();
    for (int corner = 0; corner < 3; ++corner) {
        const Vec3 direction = (tet.rest.row(3) - tet.rest.row(corner)).normalized();
        sweep = (Eigen::Matrix3d::Identity() - 0.2 * direction * direction.transpose()) * sweep;
    }
    Eigen::Matrix3d step = Eigen::Matrix3d::Identity();
    for (int i = 0; i < iterations; ++i) step = sweep * step;
    return step;
}

class HangingParticle : public testing::TestWithParam<int> {
protected:
    pbs::PbsSolver solver{tet, Eigen::VectorXd::Zero(4), free_zone, options_of(GetParam()), held};
    const Eigen::Matrix3d S = step_matrix(GetParam());
    Vec3 displacement() const { return solver.positions().row(3) - tet.rest.row(3); }
};

TEST_P(HangingParticle, FollowsTheRecurrence)
{
    Vec3 last = Vec3::Zero(), now = Vec3::Zero();
    for (int step = 0; step < 50; ++step) {
        const Vec3 next = S * (2.0 * now - last + gravity * dt_s * dt_s);
        last = now;
        now = next;
        solver.advance(tet.rest, tet.rest, dt_s);
        ASSERT_LT((displacement() - now).norm(), 1e-5 * now.norm()) << step;
    }
}

TEST_P(HangingParticle, SettlesAtTheFixedPoint)
{
    for (int step = 0; step < 3000; ++step) solver.advance(tet.rest, tet.rest, dt_s);
    const Vec3 expected = (Eigen::Matrix3d::Identity() - S).inverse() * S * gravity * dt_s * dt_s;
    EXPECT_LT((displacement() - expected).norm(), 1e-5 * expected.norm());
}

TEST_P(HangingParticle, HeldOnesStayToTheBit)
{
    for (int step = 0; step < 20; ++step) solver.advance(tet.rest, tet.rest, dt_s);
    EXPECT_EQ(solver.positions().topRows(3), tet.rest.topRows(3));
}

INSTANTIATE_TEST_SUITE_P(Iterations, HangingParticle, testing::Values(1, 4, 24));

}  // namespace
