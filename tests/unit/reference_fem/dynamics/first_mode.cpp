// Reference: a dense eigenvalue problem by Eigen.
#include "reference_fem/dynamics/first_mode.hpp"

#include "reference_fem/dynamics/vibrating_body.hpp"

#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace reference_fem;

std::vector<int> free_dofs(const VibratingBody& body)
{
    std::vector<int> free;
    for (int i = 0; i < body.space().dofs(); ++i)
        if (!body.fixed()[i]) free.push_back(i);
    return free;
}

TEST(FirstMode, IsTheLowestOfADenseEigenvalueProblem)
{
    const VibratingBody body(test_support::jittered_cube(2), {.held = [](const pbs::Vec3& x) { return x.z() < 1e-9; }});
    const Mode mode = body.first_mode();
    NodalMatrix stiffness(body.space());
    body.flesh().add_hessian(Eigen::VectorXd::Zero(body.space().dofs()), Definiteness::as_it_is, stiffness);
    const std::vector<int> free = free_dofs(body);
    const Eigen::MatrixXd K = Eigen::MatrixXd(stiffness.matrix())(free, free), M = Eigen::MatrixXd(body.mass().matrix())(free, free);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> dense(K, M);
    EXPECT_NEAR(mode.omega_rad_s, std::sqrt(dense.eigenvalues()(0)), 1e-11 * mode.omega_rad_s);
    const Eigen::VectorXd phi = mode.shape(free);
    EXPECT_LT((K * phi - mode.omega_rad_s * mode.omega_rad_s * (M * phi)).norm(), 1e-10 * (K * phi).norm());
    EXPECT_EQ(mode.shape.cwiseAbs().maxCoeff(), 1.0);
}

TEST(FirstMode, OfABodyThatMayMoveRigidlyIsNotANumber)
{
    EXPECT_TRUE(std::isnan(VibratingBody(test_support::jittered_cube(1), {}).first_mode().omega_rad_s));
}

TEST(FirstMode, WithEveryDegreeOfFreedomPrescribedIsNotANumber)
{
    const VibratingBody body(test_support::jittered_cube(1), {.held = [](const pbs::Vec3&) { return true; }});
    EXPECT_TRUE(std::isnan(body.first_mode().omega_rad_s));
}

}  // namespace
