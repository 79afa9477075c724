// Reference: theory of the schemes for linear systems. Generalised-alpha damps each mode by the spectral radius of its amplification
// matrix, which falls from 1 at low to rho at infinite frequency (J. Chung, G. Hulbert, J. Appl. Mech. 60(2), 1993); both schemes are
// stable for every time step. Energy, dissipation, damping and frequencies are rows of the verification problem `dynamics`.
#include "reference_fem/dynamics/vibrating_body.hpp"

#include "reference_fem/verification/problems.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <random>

namespace {

using namespace reference_fem;

class EnergyInTime : public testing::Test {
protected:
    // Entries in -1 to 1, and 0 where the bar is held.
    Eigen::VectorXd random_vector() const
    {
        std::mt19937 random(7);
        std::uniform_real_distribution<double> entry(-1.0, 1.0);
        Eigen::VectorXd vector(bar.space().dofs());
        for (Eigen::Index i = 0; i < vector.size(); ++i) vector(i) = bar.fixed()[i] ? 0.0 : entry(random);
        return vector;
    }

    // Relative change of the energy that the rounding of so many steps explains. A step solves with c_m M + K; the longer the step, the
    // closer its condition is to that of K, the largest. The energy is quadratic, so that it changes by twice the bound of a solve; steps
    // round with random sign.
    double rounding_of(int steps) const
    {
        NodalMatrix matrix(bar.space());
        bar.flesh().add_hessian(Eigen::VectorXd::Zero(bar.space().dofs()), Definiteness::as_it_is, matrix);
        return 2.0 * std::sqrt(static_cast<double>(steps)) * rounding_bound(spectrum(matrix.matrix(), bar.fixed()));
    }

    VibratingBody bar{test_support::structured_bar({0, 0, 0}, {1, 0.2, 0.2}, {6, 2, 2}),
                      {.element_order = 1, .held = [](const pbs::Vec3& x) { return x.x() < 1e-9; }}};
};

// The amplification matrix of (u, h v / Omega, h^2 a / Omega^2) for u'' + omega^2 u = 0 and Omega = omega h: the scheme's three equations,
// each divided by Omega^2: `next` times the new state is `now` times the old one.
struct Equations {
    Eigen::Matrix3d now, next;
};

Equations equations(const TimeScheme& s, double Omega)
{
    const double one = 1.0 / (Omega * Omega), velocity = 1.0 / Omega;
    Eigen::Matrix3d now, next;
    next << 1.0 - s.alpha_f, 0, 1.0 - s.alpha_m, one, 0, -s.beta, 0, velocity, -s.gamma;
    now << -s.alpha_f, 0, -s.alpha_m, one, velocity, 0.5 - s.beta, 0, velocity, 1.0 - s.gamma;
    return {now, next};
}

Eigen::Matrix3d amplification(const TimeScheme& s, double Omega)
{
    const auto [now, next] = equations(s, Omega);
    return next.inverse() * now;
}

double spectral_radius(const TimeScheme& scheme, double Omega)
{
    return amplification(scheme, Omega).eigenvalues().cwiseAbs().maxCoeff();
}

TEST(SpectralRadius, FallsFromOneToRho)
{
    for (const double rho : {0.0, 0.5, 0.8, 1.0}) {
        const TimeScheme scheme = generalized_alpha(rho);
        double before = 1.0;
        for (double Omega = 1e-3; Omega < 1e5; Omega *= 1.5) {
            const double radius = spectral_radius(scheme, Omega);
            // Double eigenvalues have an error of the square root of the rounding, eps times the condition number Omega + 1 / Omega^2.
            EXPECT_LE(radius, before + 1e-5) << "rho " << rho << " Omega " << Omega;
            before = radius;
        }
        EXPECT_NEAR(before, rho, 1e-3);  // at Omega = 8e4: the triple eigenvalue at infinity differs by Omega^(-2/3)
    }
}

template <typename Matrix>
double condition(const Matrix& matrix)  // in the Frobenius norm
{
    return matrix.norm() * matrix.inverse().norm();
}

// An eigenvalue of A is in error by at most cond(V) |dA|, V the eigenvectors (F. Bauer, C. Fike, Numer. Math. 2, 1960). Some twenty
// roundings go into the inverse by cofactors and the product, which the condition number of the equations magnifies; as many go into the
// eigenvalues.
TEST(SpectralRadius, OfNewmarkIsOne)
{
    const Equations scheme = equations(newmark(), 7.0);
    const Eigen::Matrix3d A = amplification(newmark(), 7.0);
    const double of_matrix = test_support::rounding_error(20 * condition(scheme.next) + 20, A.norm());
    EXPECT_NEAR(spectral_radius(newmark(), 7.0), 1.0, condition(Eigen::EigenSolver<Eigen::Matrix3d>(A).eigenvectors()) * of_matrix);
}

class DissipationInTime : public EnergyInTime, public testing::WithParamInterface<double> {};

// At infinite frequency rho is a triple eigenvalue. Amplitudes are a polynomial of degree 2 in n times rho^n, may overshoot at first, and
// finally fall by rho to within 2 / n per step.
TEST_P(DissipationInTime, AtHighFrequencyIsMonotoneAfterTheOvershoot)
{
    const double rho = GetParam();
    const Mode mode = bar.first_mode();
    TimeStepper stepper = bar.stepper({.scheme = generalized_alpha(rho)});
    stepper.start(mode.shape);
    std::vector<double> energies = {bar.energy_j(stepper)};
    ASSERT_TRUE(bar.run(stepper, 1e4 / mode.omega_rad_s, 40, [&](int) { energies.push_back(bar.energy_j(stepper)); }));
    for (std::size_t k = 2 + std::lround(1.0 / (1.0 - rho)); k < energies.size(); ++k)
        EXPECT_LT(energies[k], energies[k - 1]) << "step " << k;
    EXPECT_NEAR(std::sqrt(energies[40] / energies[39]), rho, 2.0 / 39.0 * rho);
}

INSTANTIATE_TEST_SUITE_P(Rho, DissipationInTime, testing::Values(0.5, 0.8));

// A time step of 0.1 s is 20 to 60 times the limit of an explicit scheme, and still no mode grows.
TEST_F(EnergyInTime, NoTimeStepIsTooLong)
{
    for (const TimeScheme& scheme : {newmark(), generalized_alpha(0.8), generalized_alpha(0.0)})
        for (const double step_s : {0.1, 10.0}) {
            TimeStepper stepper = bar.stepper({.scheme = scheme});
            stepper.start(1e-2 * random_vector(), random_vector());
            const double before = bar.energy_j(stepper);
            ASSERT_TRUE(bar.run(stepper, step_s, 200));
            EXPECT_LT(bar.energy_j(stepper), (1.0 + rounding_of(200)) * before) << "step " << step_s;
        }
}

}  // namespace
