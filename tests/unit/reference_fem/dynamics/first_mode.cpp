// Reference: a dense eigenvalue problem by Eigen. Tolerances: both reduce it to eigenvalues of L^-1 K L^-T with M = L L^T, whose error by
// rounding is sqrt(n) eps |K| |M^-1| (G. Golub, C. Van Loan, Matrix Computations, 4th ed., Sec. 8.7.2), and omega is the root of an
// eigenvalue. The iteration ends at a change of the shape of 1e-13; (K - omega^2 M) turns it and the rounding of the solve into a residual.
#include "reference_fem/dynamics/first_mode.hpp"

#include "reference_fem/dynamics/vibrating_body.hpp"

#include "tests/verification/reference_fem/jittered_cube.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using namespace reference_fem;

std::vector<int> free_dofs(const VibratingBody& body)
{
    std::vector<int> free;
    for (int i = 0; i < body.space().dofs(); ++i)
        if (!body.fixed()[i]) free.push_back(i);
    return free;
}

Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& symmetric)
{
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
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
    const double c = std::sqrt(static_cast<double>(free.size())) * std::numeric_limits<double>::epsilon(), lowest = dense.eigenvalues()(0),
                 norm_of_K = eigenvalues(K).maxCoeff();
    const double omega_bound = c * norm_of_K / eigenvalues(M).minCoeff() / lowest;
    EXPECT_NEAR(mode.omega_rad_s, std::sqrt(lowest), omega_bound * mode.omega_rad_s);
    EXPECT_LT(omega_bound, 1e-8) << "a bound that would let an error of a percent pass proves nothing";
    const Eigen::VectorXd phi = mode.shape(free);
    EXPECT_LT((K * phi - mode.omega_rad_s * mode.omega_rad_s * (M * phi)).norm(), (1e-13 + c) * norm_of_K * phi.norm());
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
