// Reference: the plain energy, the theory of relaxation and of Chebyshev polynomials, and sweeps written out with the plain blocks.
#include "pbs/flesh/vbd.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/packed/vertex_order.hpp"
#include "tests/support/flesh_rounding.hpp"
#include "tests/support/held_bar.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using pbs::Acceleration;
using pbs::Arithmetic;
using pbs::Positions;

const test_support::TwoBoneLimb bent = test_support::two_bone_limb({12, 3, 3}, pbs::Vec3::UnitZ(), 70.0);
const pbs::BoneHold hold(bent.mesh, test_support::random_springs(60, 0.3), 2);
const pbs::FleshEnergy energy(bent.mesh, pbs::flesh_material(0.45), hold);
constexpr int tets = 6 * 12 * 3 * 3;

Positions centres_of(const pbs::Pose& pose)
{
    Positions centres;
    hold.centres(pose, centres);
    return centres;
}
const Positions centres = centres_of(bent.pose);

Positions mirrored()
{
    Positions x = bent.lbs;
    x.col(2) *= -1.0;
    return x;
}

const Positions collapsed = Positions::Zero(bent.mesh.rest.rows(), 3);

template <typename Scalar>
Positions minimised(const pbs::VertexBlockOptions& options, Positions x)
{
    pbs::VertexBlockDescent<Scalar>(bent.mesh, energy, options).minimise(centres, x);
    return x;
}

double gradient_norm(const Positions& x)
{
    Positions gradient;
    energy.value_and_gradient(x, centres, gradient);
    return gradient.norm();
}

// One sweep, written out.
Positions swept(double omega, Positions x)
{
    const std::vector<pbs::VertexStar> stars = pbs::vertex_stars(energy);
    for (const std::vector<int>& colour : pbs::vertex_colours(bent.mesh.tets, static_cast<int>(x.rows())))
        for (const int i : colour) x.row(i) -= omega * pbs::block_step(pbs::vertex_block(stars[i], i, x, centres)).transpose();
    return x;
}

// Theory: along a vertex the energy is exactly quadratic, so that omega times the way to its minimum lowers it by omega (2 - omega) / 2
// g . H^-1 g, which is positive for 0 < omega < 2. An energy has some 40 roundings per tet of positive terms.
TEST(VertexBlockDescent, NoSweepIncreasesTheEnergy)
{
    for (const Positions& start : {bent.lbs, mirrored(), test_support::jittered(bent.lbs, 0.2), collapsed})
        for (const double omega : {0.1, 1.0, 1.5, 1.85, 1.99}) {
            Positions x = start;
            double last = energy.value(x, centres);
            for (int sweep = 0; sweep < 12; ++sweep) {
                x = minimised<double>({.iterations = 1, .omega = omega, .arithmetic = Arithmetic::packed_f64}, x);
                const double now = energy.value(x, centres);
                EXPECT_LE(now, last + test_support::rounding_error(40.0 * tets, last)) << "omega " << omega << ", sweep " << sweep;
                last = now;
            }
        }
}

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
            energy.value(minimised<double>({.iterations = 1, .omega = omega, .arithmetic = Arithmetic::plain_f64}, bent.lbs), centres);
        EXPECT_NEAR(before - after, decrease, test_support::rounding_error(4.0 * 40 * tets, before)) << omega;
        EXPECT_GT(decrease, 1e-3 * before);
    }
}

// With the neighbours at rest in their own positions, omega = 2 leaves the energy and more increases it: the test above can fail.
TEST(VertexBlockDescent, BeyondTwoTheEnergyIncreases)
{
    const double before = energy.value(bent.lbs, centres);
    EXPECT_NEAR(energy.value(swept(2.0, bent.lbs), centres), before, test_support::rounding_error(4.0 * 40 * tets, before));
    EXPECT_GT(energy.value(swept(2.2, bent.lbs), centres), 1.01 * before);
}

TEST(VertexBlockDescent, EndsWhereTheGradientVanishes)
{
    for (const Arithmetic arithmetic : {Arithmetic::plain_f64, Arithmetic::packed_f64}) {
        const Positions x = minimised<double>({.iterations = 600, .arithmetic = arithmetic}, bent.lbs);
        EXPECT_LT(gradient_norm(x), 1e-6 * gradient_norm(bent.lbs));
    }
}

TEST(VertexBlockDescent, TheMinimumDependsNeitherOnTheStartNorOnOmegaNorOnTheAcceleration)
{
    const double size = (bent.lbs - bent.mesh.rest).norm();
    const Positions expected = minimised<double>({.iterations = 800, .arithmetic = Arithmetic::packed_f64}, bent.lbs);
    const Positions jittered = test_support::jittered(bent.lbs, 0.05);
    EXPECT_LT((minimised<double>({.iterations = 800, .arithmetic = Arithmetic::packed_f64}, jittered) - expected).norm(), 1e-6 * size);
    const pbs::VertexBlockOptions slow{.iterations = 2000, .omega = 1.5, .arithmetic = Arithmetic::packed_f64};
    for (const Positions& start : {bent.lbs, bent.mesh.rest}) EXPECT_LT((minimised<double>(slow, start) - expected).norm(), 1e-6 * size);
    const pbs::VertexBlockOptions chebyshev{
        .iterations = 3000, .acceleration = Acceleration::chebyshev, .rho = 0.95, .arithmetic = Arithmetic::packed_f64};
    EXPECT_LT((minimised<double>(chebyshev, bent.lbs) - expected).norm(), 1e-6 * size);
}

// The energy has more than one minimum. From where the tets are inverted or have no volume, one of them is reached, not always the lowest.
TEST(VertexBlockDescent, InvertedAndCollapsedStartsEndWhereTheGradientVanishes)
{
    for (const Positions& start : {mirrored(), collapsed}) {
        const Positions x = minimised<double>({.iterations = 1500, .arithmetic = Arithmetic::packed_f64}, start);
        EXPECT_LT(gradient_norm(x), 1e-6 * gradient_norm(start));
    }
}

TEST(VertexBlockDescent, FloatEndsNearTheSameMinimum)
{
    const Positions in_double = minimised<double>({.iterations = 600, .arithmetic = Arithmetic::plain_f64}, bent.lbs);
    const Positions in_float = minimised<float>({.iterations = 600}, bent.lbs);
    EXPECT_LT((in_float - in_double).norm(), test_support::displaced_by_rounding<float>(energy, centres, in_double));
}

TEST(VertexBlockDescent, OverRelaxationSavesSweeps)
{
    const auto gradient_after_60 = [](double omega) {
        return gradient_norm(minimised<double>({.iterations = 60, .omega = omega, .arithmetic = Arithmetic::packed_f64}, bent.lbs));
    };
    EXPECT_LT(10.0 * gradient_after_60(1.8), gradient_after_60(1.0));
}

// Theory (G. Golub, R. Varga, Numer. Math. 3, 1961): omega_{k+1} = 2 T_k(1 / rho) / (rho T_{k+1}(1 / rho)), T_k(x) = cosh(k acosh x).
TEST(ChebyshevWeights, AreRatiosOfChebyshevPolynomials)
{
    for (const double rho : {0.3, 0.9, 0.95, 0.999}) {
        const std::vector<double> weights = pbs::chebyshev_weights(rho, 40);
        ASSERT_EQ(weights.size(), 40u);
        EXPECT_EQ(weights[0], 1.0);
        const double angle = std::acosh(1.0 / rho);
        for (int k = 1; k < 40; ++k) {
            const double expected = 2.0 * std::cosh(k * angle) / (rho * std::cosh((k + 1) * angle));
            EXPECT_NEAR(weights[k], expected, test_support::rounding_error(20.0 * k, expected)) << "rho " << rho << ", k " << k;
        }
    }
}

TEST(ChebyshevWeights, ARadiusOfZeroAcceleratesNothing)
{
    for (const double weight : pbs::chebyshev_weights(0.0, 10)) EXPECT_EQ(weight, 1.0);
    EXPECT_TRUE(pbs::chebyshev_weights(0.9, 0).empty());
}

// x_{k+1} = omega_{k+1} (sweep(x_k) - x_{k-1}) + x_{k-1}, the weights from their closed form. The error of a sweep's roundings is magnified
// by at most 1 + 2 (omega - 1) < 3 per sweep in this norm; positions are below 2 m.
TEST(VertexBlockDescent, ChebyshevFollowsItsRecurrence)
{
    const double rho = 0.9, angle = std::acosh(1.0 / rho);
    std::vector<Positions> x = {bent.lbs, swept(1.0, bent.lbs)};
    for (int k = 1; k < 5; ++k) {
        const double omega = 2.0 * std::cosh(k * angle) / (rho * std::cosh((k + 1) * angle));
        x.push_back(omega * (swept(1.0, x[k]) - x[k - 1]) + x[k - 1]);
    }
    for (const Arithmetic arithmetic : {Arithmetic::plain_f64, Arithmetic::packed_f64}) {
        const Positions found =
            minimised<double>({.iterations = 5, .acceleration = Acceleration::chebyshev, .rho = rho, .arithmetic = arithmetic}, bent.lbs);
        EXPECT_LT((found - x[5]).cwiseAbs().maxCoeff(), std::pow(3.0, 5) * test_support::rounding_error(1000.0, 2.0));
    }
    EXPECT_GT((x[5] - x[4]).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(VertexBlockDescent, ChebyshevSavesSweeps)
{
    const auto gradient_after_60 = [](double rho) {
        return gradient_norm(minimised<double>(
            {.iterations = 60, .acceleration = Acceleration::chebyshev, .rho = rho, .arithmetic = Arithmetic::packed_f64}, bent.lbs));
    };
    EXPECT_LT(4.0 * gradient_after_60(0.95), gradient_after_60(0.0));
}

TEST(VertexBlockDescent, ARadiusOfZeroIsPlainGaussSeidel)
{
    const pbs::VertexBlockOptions chebyshev{.iterations = 7, .acceleration = Acceleration::chebyshev, .rho = 0.0};
    EXPECT_EQ(minimised<float>(chebyshev, bent.lbs), minimised<float>({.iterations = 7, .omega = 1.0}, bent.lbs));
}

TEST(VertexBlockDescent, NoSweepsLeaveTheStart)
{
    for (const Acceleration acceleration : {Acceleration::over_relaxation, Acceleration::chebyshev})
        EXPECT_EQ(minimised<double>({.iterations = 0, .acceleration = acceleration, .arithmetic = Arithmetic::plain_f64}, bent.lbs),
                  bent.lbs);
}

TEST(VertexBlockDescent, AStartThatIsNotANumberIsReported)
{
    Positions x = bent.lbs;
    pbs::VertexBlockDescent<float> solver(bent.mesh, energy, {.iterations = 3});
    EXPECT_TRUE(solver.minimise(centres, x).is_finite);
    x(3, 1) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(solver.minimise(centres, x).is_finite);
}

TEST(VertexBlockDescent, RefusesFactorsThatCannotConverge)
{
    for (const double omega : {0.0, 2.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(pbs::VertexBlockDescent<float>(bent.mesh, energy, {.omega = omega}), pbs::InputError) << omega;
    for (const double rho : {-0.1, 1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(pbs::VertexBlockDescent<float>(bent.mesh, energy, {.rho = rho}), pbs::InputError) << rho;
}

}  // namespace
