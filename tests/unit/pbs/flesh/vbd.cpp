// Reference: the value and the gradient of the plain energy, which knows nothing of vertices' blocks.
#include "pbs/flesh/vbd.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/packed/vertex_order.hpp"
#include "tests/support/flesh_rounding.hpp"
#include "tests/support/held_bar.hpp"
#include "tests/support/rounding_error.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <limits>

namespace vbd_tests {
namespace {

using pbs::Positions;
using pbs::Vec3;

const test_support::HeldBar bar({12, 3, 3});
const test_support::TwoBoneLimb& bent = bar.bent;
const pbs::BoneHold& hold = bar.hold;
const pbs::FleshEnergy& energy = bar.energy;
const Positions& centres = bar.centres;
constexpr int tets = 6 * 12 * 3 * 3;

const Positions mirrored = test_support::mirrored(bent.lbs, 1);

class VertexBlockOf : public testing::TestWithParam<double> {
protected:
    const pbs::FleshEnergy energy{bent.mesh, pbs::flesh_material(GetParam()), hold};
    const std::vector<pbs::VertexStar> stars = pbs::vertex_stars(energy);
    const std::vector<Positions> shapes = {bent.lbs, test_support::jittered(bent.lbs, 0.1), mirrored};

    // The largest term of a gradient: a pressure of kappa (|6 V| + d) on the largest face, or a spring or edge of 2 m.
    double largest_term() const
    {
        double largest = 2.0 * energy.hold().maxCoeff();
        for (const pbs::FleshTet& tet : energy.tets()) {
            largest = std::max(largest, tet.kappa * 8.0 * tet.d * 0.25);
            for (const double w : tet.w) largest = std::max(largest, 2.0 * std::abs(w));
        }
        return largest;
    }
};

// A vertex has at most 24 tets, each of which goes through some 30 roundings on either side.
TEST_P(VertexBlockOf, HasTheGradientOfTheEnergy)
{
    for (const Positions& x : shapes) {
        Positions gradient;
        energy.value_and_gradient(x, centres, gradient);
        for (int i = 0; i < static_cast<int>(stars.size()); ++i) {
            const Vec3 found = pbs::vertex_block(stars[i], i, x, centres).gradient;
            EXPECT_LE((found - gradient.row(i).transpose()).cwiseAbs().maxCoeff(),
                      test_support::rounding_error(2 * 24 * 30, largest_term()))
                << "vertex " << i;
        }
    }
}

// The energy is quadratic along a vertex: its differences are those of the block at every step length, without a
// remainder. An energy has some 40 roundings per tet of terms that are positive.
TEST_P(VertexBlockOf, HasTheDifferencesOfTheEnergyAtEveryEps)
{
    const Vec3 direction(0.3, -0.7, 0.5);
    for (const Positions& x : shapes)
        for (const int i : {0, 13, 40, 80})
            for (const double eps : {1.0, 0.1, 0.01}) {
                const pbs::VertexBlock block = pbs::vertex_block(stars[i], i, x, centres);
                Positions moved = x;
                const double at = energy.value(moved, centres);
                moved.row(i) = x.row(i) + eps * direction.transpose();
                const double ahead = energy.value(moved, centres);
                moved.row(i) = x.row(i) - eps * direction.transpose();
                const double behind = energy.value(moved, centres);
                const double rounding = test_support::rounding_error(4.0 * 40 * tets, std::max({at, ahead, behind}));
                EXPECT_NEAR(ahead - behind, 2.0 * eps * block.gradient.dot(direction), rounding) << i << ", " << eps;
                EXPECT_NEAR(ahead - 2.0 * at + behind, eps * eps * direction.dot(block.hessian * direction), rounding)
                    << i << ", " << eps;
                EXPECT_GT(eps * eps * direction.dot(block.hessian * direction), 20.0 * rounding)
                    << "the comparison would see an error";
            }
}

// Theory: the Hessian is diagonal * I plus positive semidefinite terms, and diagonal is the sum of mu V0 |grad N|^2 and
// k beta^2.
TEST_P(VertexBlockOf, HasNoEigenvalueBelowItsDiagonal)
{
    for (const Positions& x : shapes)
        for (int i = 0; i < static_cast<int>(stars.size()); ++i) {
            const pbs::VertexBlock block = pbs::vertex_block(stars[i], i, x, centres);
            EXPECT_GT(block.diagonal, 0.0);
            const Eigen::Vector3d eigenvalues = block.hessian.selfadjointView<Eigen::Lower>().eigenvalues();
            EXPECT_GE(eigenvalues(0), block.diagonal - test_support::rounding_error(100.0, eigenvalues(2)));
        }
}

// Roundings of the solve are magnified by at most the condition number of the block.
TEST_P(VertexBlockOf, StepSolvesTheBlock)
{
    for (const Positions& x : shapes)
        for (int i = 0; i < static_cast<int>(stars.size()); ++i) {
            const pbs::VertexBlock block = pbs::vertex_block(stars[i], i, x, centres);
            const Vec3 expected = block.hessian.ldlt().solve(block.gradient);
            const double condition = block.hessian.norm() / block.diagonal;
            EXPECT_LE((pbs::block_step(block) - expected).norm(),
                      test_support::rounding_error(50.0 * condition, expected.norm()));
        }
}

INSTANTIATE_TEST_SUITE_P(PoissonsRatios, VertexBlockOf, testing::Values(0.0, 0.3, 0.45, 0.499));

TEST(VertexBlock, AVertexWithoutTetsHasNoStep)
{
    const pbs::VertexStar star;
    const pbs::VertexBlock block = pbs::vertex_block(star, 0, Positions::Constant(1, 3, 2.0), Positions::Zero(1, 3));
    EXPECT_EQ(block.gradient, Vec3(Vec3::Zero()));
    EXPECT_EQ(pbs::block_step(block), Vec3(Vec3::Zero()));
}

// Coincident vertices have no normal: the block is the diagonal, and the step goes to the mean that the edges and the
// spring weigh.
TEST(VertexBlock, CoincidentVerticesLeaveTheDiagonal)
{
    const pbs::FleshEnergy energy(bent.mesh, pbs::flesh_material(0.45), hold);
    const std::vector<pbs::VertexStar> stars = pbs::vertex_stars(energy);
    const Positions point = Positions::Constant(bent.mesh.rest.rows(), 3, 0.25);
    for (const int i : {0, 13, 40}) {
        const pbs::VertexBlock block = pbs::vertex_block(stars[i], i, point, centres);
        EXPECT_EQ(block.hessian, Eigen::Matrix3d(stars[i].diagonal * Eigen::Matrix3d::Identity()));
        const Vec3 expected = stars[i].hold / stars[i].diagonal * (Vec3::Constant(0.25) - centres.row(i).transpose());
        EXPECT_LE((pbs::block_step(block) - expected).norm(), test_support::rounding_error(4.0, expected.norm()));
    }
}

// The method: theory of relaxation and of Chebyshev polynomials, and sweeps written out with the plain blocks.

using pbs::Acceleration;

template <typename Scalar>
Positions minimised(const pbs::VertexBlockOptions& options, Positions x)
{
    pbs::VertexBlockDescent<Scalar>(bent.mesh, energy, options).minimise(centres, x);
    return x;
}

double gradient_norm(const Positions& x)
{
    return bar.gradient(x).norm();
}

// One sweep, written out.
Positions swept(double omega, Positions x)
{
    const std::vector<pbs::VertexStar> stars = pbs::vertex_stars(energy);
    for (const std::vector<int>& colour : pbs::vertex_colours(bent.mesh.tets, static_cast<int>(x.rows())))
        for (const int i : colour)
            x.row(i) -= omega * pbs::block_step(pbs::vertex_block(stars[i], i, x, centres)).transpose();
    return x;
}

// Theory: omega times the way to the minimum along a vertex lowers the energy by omega (2 - omega) / 2 g . H^-1 g.
TEST(VertexBlockDescent, ASweepLowersTheEnergyAsTheoryStates)
{
    const std::vector<pbs::VertexStar> stars = pbs::vertex_stars(energy);
    for (const double omega : {0.5, 1.0, 1.85}) {
        Positions x = bent.lbs;
        double decrease = 0.0;
        for (const std::vector<int>& colour : pbs::vertex_colours(bent.mesh.tets, static_cast<int>(x.rows())))
            for (const int i : colour) {
                const pbs::VertexBlock block = pbs::vertex_block(stars[i], i, x, centres);
                const pbs::Vec3 step = pbs::block_step(block);
                decrease += omega * (2.0 - omega) / 2.0 * block.gradient.dot(step);
                x.row(i) -= omega * step.transpose();
            }
        const double before = energy.value(bent.lbs, centres);
        const double after =
            energy.value(minimised<double>({.iterations = 1, .omega = omega, .packed = false}, bent.lbs), centres);
        EXPECT_NEAR(before - after, decrease, test_support::rounding_error(4.0 * 40 * tets, before)) << omega;
        EXPECT_GT(decrease, 1e-3 * before);
    }
}

// With the neighbours at rest in their own positions, omega = 2 leaves the energy and more increases it: the contract's
// NoIterationIncreasesTheEnergy can fail.
TEST(VertexBlockDescent, BeyondTwoTheEnergyIncreases)
{
    const double before = energy.value(bent.lbs, centres);
    EXPECT_NEAR(energy.value(swept(2.0, bent.lbs), centres), before,
                test_support::rounding_error(4.0 * 40 * tets, before));
    EXPECT_GT(energy.value(swept(2.2, bent.lbs), centres), 1.01 * before);
}

TEST(VertexBlockDescent, TheMinimumDependsNeitherOnOmegaNorOnTheAcceleration)
{
    const double size = (bent.lbs - bent.mesh.rest).norm();
    const Positions expected = minimised<double>({.iterations = 800}, bent.lbs);
    const pbs::VertexBlockOptions slow{.iterations = 2000, .omega = 1.5};
    for (const Positions& start : {bent.lbs, bent.mesh.rest})
        EXPECT_LT((minimised<double>(slow, start) - expected).norm(), 1e-6 * size);
    const pbs::VertexBlockOptions chebyshev{.iterations = 3000, .acceleration = Acceleration::chebyshev, .rho = 0.95};
    EXPECT_LT((minimised<double>(chebyshev, bent.lbs) - expected).norm(), 1e-6 * size);
}

// Theory (G. Golub, R. Varga, Numer. Math. 3, 1961): omega_{k+1} = 2 T_k(1 / rho) / (rho T_{k+1}(1 / rho)), T_k(x) =
// cosh(k acosh x).
TEST(ChebyshevWeights, AreRatiosOfChebyshevPolynomials)
{
    for (const double rho : {0.3, 0.9, 0.95, 0.999}) {
        const std::vector<double> weights = pbs::chebyshev_weights(rho, 40);
        ASSERT_EQ(weights.size(), 40u);
        EXPECT_EQ(weights[0], 1.0);
        const double angle = std::acosh(1.0 / rho);
        for (int k = 1; k < 40; ++k) {
            const double expected = 2.0 * std::cosh(k * angle) / (rho * std::cosh((k + 1) * angle));
            EXPECT_NEAR(weights[k], expected, test_support::rounding_error(20.0 * k, expected))
                << "rho " << rho << ", k " << k;
        }
    }
}

// x_{k+1} = omega_{k+1} (sweep(x_k) - x_{k-1}) + x_{k-1}, the weights from their closed form. The error of a sweep's
// roundings is magnified by at most 1 + 2 (omega - 1) < 3 per sweep in this norm; positions are below 2 m.
TEST(VertexBlockDescent, ChebyshevFollowsItsRecurrence)
{
    const double rho = 0.9, angle = std::acosh(1.0 / rho);
    std::vector<Positions> x = {bent.lbs, swept(1.0, bent.lbs)};
    for (int k = 1; k < 5; ++k) {
        const double omega = 2.0 * std::cosh(k * angle) / (rho * std::cosh((k + 1) * angle));
        x.push_back(omega * (swept(1.0, x[k]) - x[k - 1]) + x[k - 1]);
    }
    for (const bool packed : {false, true}) {
        const Positions found = minimised<double>(
            {.iterations = 5, .acceleration = Acceleration::chebyshev, .rho = rho, .packed = packed}, bent.lbs);
        EXPECT_LT((found - x[5]).cwiseAbs().maxCoeff(), std::pow(3.0, 5) * test_support::rounding_error(1000.0, 2.0));
    }
    EXPECT_GT((x[5] - x[4]).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(VertexBlockDescent, AccelerationSavesSweeps)
{
    const auto gradient_after_60 = [](pbs::VertexBlockOptions options) {
        options.iterations = 60;
        return gradient_norm(minimised<double>(options, bent.lbs));
    };
    const double plain = gradient_after_60({.omega = 1.0});
    EXPECT_LT(10.0 * gradient_after_60({.omega = 1.8}), plain);
    EXPECT_LT(4.0 * gradient_after_60({.acceleration = Acceleration::chebyshev, .rho = 0.95}), plain);
}

TEST(VertexBlockDescent, ARadiusOfZeroIsPlainGaussSeidel)
{
    pbs::VertexBlockOptions chebyshev{.iterations = 7, .acceleration = Acceleration::chebyshev, .rho = 0.0};
    EXPECT_EQ(minimised<float>(chebyshev, bent.lbs), minimised<float>({.iterations = 7, .omega = 1.0}, bent.lbs));
    chebyshev.iterations = 0;
    EXPECT_EQ(minimised<double>(chebyshev, bent.lbs), minimised<double>({.iterations = 0}, bent.lbs));
}

TEST(VertexBlockDescent, RefusesFactorsThatCannotConverge)
{
    for (const double omega : {0.0, 2.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(pbs::VertexBlockDescent<float>(bent.mesh, energy, {.omega = omega}), pbs::InputError) << omega;
    for (const double rho : {-0.1, 1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(pbs::VertexBlockDescent<float>(bent.mesh, energy, {.rho = rho}), pbs::InputError) << rho;
}

}  // namespace
}  // namespace vbd_tests
