// Reference: polynomials, whose derivatives are known. A parabola through three displacements gives the velocity of quadratic motion
// exactly, and a cubic through four the acceleration of cubic motion, for steps of any length.
#include "reference_fem/dynamics/prescribed_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace reference_fem;

// One free and one prescribed degree of freedom.
class Prescribed : public testing::Test {
protected:
    void step(double u, double step_s)
    {
        const Motion next = prescribed.next(motion, Eigen::Vector2d(std::nan(""), u), step_s);
        prescribed.accept(motion, next, step_s);
        motion = next;
    }

    PrescribedMotion prescribed{{false, true}};
    Motion motion{Eigen::Vector2d(5.0, 0.0), Eigen::Vector2d(6.0, 0.0), Eigen::Vector2d(7.0, 0.0)};
};

TEST_F(Prescribed, RatesOfACubicAreExactInUnequalSteps)
{
    const auto u = [](double t) { return 1.0 + 2.0 * t - 3.0 * t * t + 0.5 * t * t * t; };
    motion.displacement(1) = u(0.0);
    motion.velocity(1) = 2.0;
    double t = 0.0;
    for (const double h : {0.1, 0.2, 0.05, 0.3}) {
        t += h;
        step(u(t), h);
    }
    EXPECT_NEAR(motion.acceleration(1), -6.0 + 3.0 * t, 1e-12);
    // u''' / 6 times the distances to the previous two points
    EXPECT_NEAR(motion.velocity(1), 2.0 - 6.0 * t + 1.5 * t * t, 0.5 * 0.3 * 0.35);
}

TEST_F(Prescribed, TheFirstStepTakesTheVelocityItIsGiven)
{
    motion.velocity(1) = 2.0;
    step(0.2 + 0.5 * 3.0 * 0.01, 0.1);  // u = 2 t + 3 t^2 / 2
    EXPECT_NEAR(motion.velocity(1), 2.3, 1e-14);
    EXPECT_NEAR(motion.acceleration(1), 3.0, 1e-13);
}

// From rest, the velocity becomes constant at once: the accelerations vanish after three steps, and their impulse equals the velocity.
TEST_F(Prescribed, AJumpOfTheVelocityIsForgottenAndItsImpulseIsWhole)
{
    const double h = 0.1, velocity = 3.0;
    double impulse = 0.0;
    step(0.0, h);
    step(0.0, h);
    for (int k = 1; k <= 6; ++k) {
        step(k * h * velocity, h);
        impulse += h * motion.acceleration(1);
        if (k < 3) continue;
        EXPECT_NEAR(motion.velocity(1), velocity, 1e-13);
        EXPECT_NEAR(motion.acceleration(1), 0.0, 1e-11);
    }
    EXPECT_NEAR(impulse, velocity, 1e-12);
}

TEST_F(Prescribed, RestStaysRestToTheBitAndFreeDegreesOfFreedomAreNotTouched)
{
    motion.displacement(1) = 0.1;
    for (const double h : {0.1, 0.03, 0.7}) step(0.1, h);
    EXPECT_EQ(motion.velocity(1), 0.0);
    EXPECT_EQ(motion.acceleration(1), 0.0);
    EXPECT_EQ(motion.displacement, Eigen::Vector2d(5.0, 0.1));
    EXPECT_EQ(motion.velocity(0), 6.0);
    EXPECT_EQ(motion.acceleration(0), 7.0);
}

TEST(PrescribedMotion, MayBeOfNothing)
{
    const PrescribedMotion none({false, false, false});
    const Eigen::Vector3d ones = Eigen::Vector3d::Ones();
    EXPECT_EQ(none.next({ones, ones, ones}, 2.0 * ones, 0.1).displacement, ones);
}

}  // namespace
