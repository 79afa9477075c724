// Reference: polynomials, whose derivatives are known. A parabola through three displacements gives the velocity of quadratic motion
// exactly, and a cubic through four the acceleration of cubic motion, for steps of any length. Tolerances: the condition of differences, by
// which an error d of the displacements grows to 2 d / h in a slope, to its differences over two and three steps in the next.
#include "reference_fem/dynamics/prescribed_motion.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace reference_fem;
using test_support::rounding_error;

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
    // A displacement is in error by d, ten roundings of terms that add up to at most 4. The slopes of the last three steps are in error by
    // 2 d / 0.3, 2 d / 0.05 and 2 d / 0.2, their differences over 0.35 and 0.25 by 133 d and 200 d, the third difference over 0.55 by
    // 606 d, and the acceleration by 2 (133 d + 0.65 (606 d)).
    EXPECT_NEAR(motion.acceleration(1), -6.0 + 3.0 * t, 1054.0 * rounding_error(10, 4.0));
    // u''' / 6 times the distances to the previous two points
    EXPECT_NEAR(motion.velocity(1), 2.0 - 6.0 * t + 1.5 * t * t, 0.5 * 0.3 * 0.35);
}

TEST_F(Prescribed, TheFirstStepTakesTheVelocityItIsGiven)
{
    motion.velocity(1) = 2.0;
    step(0.2 + 0.5 * 3.0 * 0.01, 0.1);  // u = 2 t + 3 t^2 / 2
    // The velocity is 2 s - 2 and the acceleration 2 (s - 2) / h; the slope s = 2.15 goes through six roundings.
    EXPECT_NEAR(motion.velocity(1), 2.3, 2.0 * rounding_error(6, 2.15));
    EXPECT_NEAR(motion.acceleration(1), 3.0, 2.0 / 0.1 * rounding_error(6, 2.15));
}

// From rest, the velocity becomes constant at once: the accelerations vanish after three steps, and their impulse equals the velocity. The
// slopes are in error by 2 d / h, the velocity by 4 d / h, the second and third differences by 2 d / h^2 and 4/3 d / h^3 and the
// acceleration by 2 (2 + 3 (4/3)) d / h^2, six of which add up to the impulse.
TEST_F(Prescribed, AJumpOfTheVelocityIsForgottenAndItsImpulseIsWhole)
{
    const double h = 0.1, velocity = 3.0;
    const double d = rounding_error(4, 6 * h * velocity);  // two roundings of the displacement and two of its differences
    double impulse = 0.0;
    step(0.0, h);
    step(0.0, h);
    for (int k = 1; k <= 6; ++k) {
        step(k * h * velocity, h);
        impulse += h * motion.acceleration(1);
        if (k < 3) continue;
        EXPECT_NEAR(motion.velocity(1), velocity, 4.0 * d / h);
        EXPECT_NEAR(motion.acceleration(1), 0.0, 12.0 * d / (h * h));
    }
    EXPECT_NEAR(impulse, velocity, 6 * h * 12.0 * d / (h * h));
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
