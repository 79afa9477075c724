// Reference: the balance of forces, and the specification in the header for failures, degenerate data and rest.

#include "pbs/geometry/input_error.hpp"
#include "reference_fem/boundary_value_problem.hpp"
#include "reference_fem/dynamics/time_stepper.hpp"
#include "reference_fem/dynamics/vibrating_body.hpp"
#include "reference_fem/potentials/potentials.hpp"
#include "reference_fem/verification/problems.hpp"
#include "tests/support/fem_rounding.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Eigenvalues>

namespace {

using namespace reference_fem;
using pbs::Vec3;
using test_support::at_nodes;
using test_support::rounding_error;

class Stepper : public testing::Test {
protected:
    // Held at one end, or where this is true.
    TimeStepper stepper(
        const TimeStepperOptions& options,
        const std::function<Held(const Vec3&)>& held = [](const Vec3& x) { return x.x() < 1e-9; })
    {
        fixed = prescribed_data(space, {.held = held}).held;
        newton = std::make_unique<NewtonMinimiser>(space, fixed, LinearSolver::cholmod);
        return {space, fixed, flesh, options, *newton};
    }

    Eigen::VectorXd pulled() const
    {
        return at_nodes(space, [](const Vec3& x) -> Vec3 { return {0.1 * x.x(), 0.0, 0.0}; });
    }

    LoadPathSummary step(TimeStepper& stepper, double step_s, const MovingData& data = {},
                         const NewtonOptions& options = {})
    {
        Eigen::VectorXd guess = stepper.motion().displacement;
        return stepper.advance({&flesh}, data, step_s, guess, options, {});
    }

    const SimplexSpace space{test_support::structured_bar({0, 0, 0}, {2, 1, 1}, {2, 1, 1}), 1};
    const ElasticPotential flesh{space, Model::stable_neo_hookean, lame_parameters(1e3, 0.3),
                                 Formulation::displacement};
    std::vector<bool> fixed;
    std::unique_ptr<NewtonMinimiser> newton;
};

TEST_F(Stepper, RefusesAStepThatIsNotPositiveABodyWithoutMassAndNegativeDamping)
{
    TimeStepper time = stepper({});
    for (const double step_s : {0.0, -0.01, std::nan(""), std::numeric_limits<double>::infinity()})
        EXPECT_THROW(step(time, step_s), pbs::InputError) << step_s;
    for (const double density : {0.0, -1.0, std::nan("")})
        EXPECT_THROW(stepper({.density_kg_m3 = density}), pbs::InputError);
    EXPECT_THROW(stepper({.rayleigh_mass_1_s = -1.0}), pbs::InputError);
    EXPECT_THROW(stepper({.rayleigh_stiffness_s = -1.0}), pbs::InputError);
}

void expect_same(const Motion& a, const Motion& b)
{
    EXPECT_EQ(a.displacement, b.displacement);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.acceleration, b.acceleration);
}

TEST_F(Stepper, WithEveryDegreeOfFreedomPrescribedTheDataAreReturned)
{
    TimeStepper time = stepper({}, [](const Vec3&) { return true; });
    const Eigen::VectorXd end = pulled();
    const MovingData data{[&](double fraction) -> Eigen::VectorXd { return fraction * end; }, {}};
    ASSERT_TRUE(step(time, 0.1, data).converged());
    EXPECT_EQ(time.motion().displacement, end);
    const Eigen::VectorXd velocity =
        2.0 / 0.1 * end;  // from rest it is twice the mean velocity, in four roundings there and two here
    EXPECT_LT((time.motion().velocity - velocity).norm(), rounding_error(4 + 2, velocity.norm()));
}

// Nothing holds the body and no force acts on it, so its motion continues. Newton's method ends at the residual that
// the rounding of positions causes, 4 eps D |diag H|, D = sqrt 6 m, or before it. Such a force accelerates the body by
// at most that over the smallest eigenvalue of M, for one second. The rounding of a position, ten roundings per step,
// changes the velocity by 2 / h times as much, which moves the body for half a second on average.
TEST_F(Stepper, AnUnheldBodyFliesOn)
{
    TimeStepper time = stepper({}, [](const Vec3&) { return false; });
    const Eigen::VectorXd velocity = at_nodes(space, [](const Vec3&) { return Vec3(1.0, 2.0, -3.0); });
    time.start(Eigen::VectorXd::Zero(space.dofs()), velocity);
    const double h = 0.1;
    for (int k = 0; k < 10; ++k) ASSERT_TRUE(step(time, h).converged());
    const SparseMatrix mass = time.mass().matrix();
    const Eigen::VectorXd diagonal =
        inertia_coefficient(newmark(), h) * mass.diagonal() + rest_stiffness(space, flesh).matrix().diagonal();
    const double residual_n = 4.0 * std::numeric_limits<double>::epsilon() * std::sqrt(6.0) * diagonal.norm();
    const double of_residual = residual_n / spectrum(mass, fixed).smallest / 2.0;
    const double of_positions = 10 * (1.0 + 2.0 / h * 0.5) * rounding_error(10, velocity.norm());
    EXPECT_LT((time.motion().displacement - velocity).norm(), of_residual + of_positions);
    EXPECT_LT(of_residual + of_positions, 1e-9) << "a bound that would let a wrong velocity pass proves nothing";
}

// M a = -grad Pi - C v initially; after one short step the velocity has changed by h a. The remainder is h times the
// rate of change of the acceleration, of first order in h. The next order is smaller by the number of cells of 1 m that
// a wave of 10 m/s crosses in a step, and rounding grows as the rounding of positions over h^2: both are below a
// hundredth of it.
TEST_F(Stepper, TheFirstAccelerationFollowsFromTheBalanceOfForces)
{
    const double density = 10.0, a = 2.0, b = 0.05;
    const auto left = [&](double h) {
        TimeStepper time = stepper({.density_kg_m3 = density, .rayleigh_mass_1_s = a, .rayleigh_stiffness_s = b});
        Eigen::VectorXd velocity = Eigen::VectorXd::LinSpaced(space.dofs(), -1.0, 1.0);
        for (Eigen::Index i = 0; i < velocity.size(); ++i) velocity(i) *= !fixed[i];
        time.start(pulled(), velocity);
        EXPECT_TRUE(step(time, h, {}, {.relative_tolerance = 1e-13}).converged());
        Eigen::VectorXd balance = time.mass().times((time.motion().velocity - velocity) / h) +
                                  a * time.mass().times(velocity) +
                                  b * (rest_stiffness(space, flesh).matrix() * velocity);
        flesh.add_gradient(pulled(), balance);
        for (Eigen::Index i = 0; i < balance.size(); ++i)
            if (fixed[i]) balance(i) = 0.0;
        return balance.norm();
    };
    const double coarse = left(1e-5), fine = left(1e-6);
    Eigen::VectorXd force = Eigen::VectorXd::Zero(space.dofs());
    flesh.add_gradient(pulled(), force);
    EXPECT_NEAR(coarse / fine, 10.0, 10.0 * 1e-2);
    EXPECT_LT(fine, 1e-3 * force.norm()) << "a remainder that is no smaller proves nothing";
}

// The target at the end is NaN: parts of the step converge, and are discarded with it.
TEST_F(Stepper, OfAStepThatFailsNothingIsKept)
{
    TimeStepper time = stepper({.density_kg_m3 = 10.0});
    time.start(pulled());
    ASSERT_TRUE(step(time, 0.01).converged());
    const Motion before = time.motion();
    const Eigen::VectorXd end = Eigen::VectorXd::Constant(space.dofs(), std::nan(""));
    const MovingData data{
        [&](double fraction) -> Eigen::VectorXd { return fraction < 1.0 ? before.displacement : end; }, {}};
    const LoadPathSummary failed = step(time, 0.01, data);
    EXPECT_FALSE(failed.converged());
    EXPECT_GT(failed.reached, 0.9);
    expect_same(time.motion(), before);
}

TEST_F(Stepper, AFailureLeavesNoTraceInWhatFollows)
{
    Motion end[2];
    for (const bool fails : {false, true}) {
        TimeStepper time = stepper({.density_kg_m3 = 10.0});
        time.start(pulled());
        for (int k = 0; k < 3; ++k) {
            ASSERT_TRUE(!fails || !step(time, 0.02, {}, {.iterations = 0}).converged());
            ASSERT_TRUE(step(time, 0.01).converged());
        }
        end[fails] = time.motion();
    }
    expect_same(end[true], end[false]);
}

// Newton's method has one iteration too few for the whole step, which is divided into parts that end at the same time.
TEST_F(Stepper, AStepThatFailsIsTakenInParts)
{
    TimeStepper time = stepper({.density_kg_m3 = 10.0});
    time.start(3.0 * pulled());
    const NewtonOptions stingy{.iterations = 3};
    const LoadPathSummary path = step(time, 0.1, {}, stingy);
    ASSERT_TRUE(path.converged());
    EXPECT_GT(path.halvings(), 0);
    EXPECT_EQ(path.steps.back().fraction, 1.0);
}

// A stretched bar that moves by its own elasticity, with each kind of damping alone, comes to rest in its rest shape.
TEST_F(Stepper, DampingBringsTheBarToRest)
{
    for (const auto& [mass, stiffness] : {std::pair(2.0, 0.0), std::pair(0.0, 0.2)}) {
        TimeStepper time =
            stepper({.density_kg_m3 = 10.0, .rayleigh_mass_1_s = mass, .rayleigh_stiffness_s = stiffness});
        time.start(pulled());
        double before = flesh.value(pulled());
        for (int k = 0; k < 300; ++k) ASSERT_TRUE(step(time, 0.03).converged());
        EXPECT_LT(flesh.value(time.motion().displacement) + time.kinetic_energy_j(), 1e-3 * before);
    }
}

// Reference: the scheme's own three equations, which the accepted step must satisfy, and the conditions of Chung and
// Hulbert. Tolerances: roundings of the equations' terms, whose magnitudes add up in displacements to `size`; the rates
// divide them by powers of the step.

TEST(Scheme, SatisfiesItsEquationsAndTheConditionsOfStability)
{
    for (const TimeScheme& s :
         {newmark(), generalized_alpha(0.0), generalized_alpha(0.5), generalized_alpha(0.8), generalized_alpha(1.0)}) {
        const double h = 0.3;
        const Motion before{Eigen::Vector2d(0.4, -1.0), Eigen::Vector2d(2.0, 0.7), Eigen::Vector2d(-3.0, 0.2)};
        const Eigen::Vector2d w{0.9, -0.5};
        const Motion after = accept(s, before, w, h);
        const auto mean = [](double alpha, const Eigen::VectorXd& now, const Eigen::VectorXd& next) -> Eigen::VectorXd {
            return (1.0 - alpha) * next + alpha * now;
        };
        const Eigen::VectorXd u = before.displacement + h * before.velocity +
                                  h * h * ((0.5 - s.beta) * before.acceleration + s.beta * after.acceleration);
        const Eigen::VectorXd v =
            before.velocity + h * ((1.0 - s.gamma) * before.acceleration + s.gamma * after.acceleration);
        const double size =
            before.displacement.norm() + w.norm() + h * before.velocity.norm() + h * h * before.acceleration.norm();
        const double c_m = inertia_coefficient(s, h), c_c = damping_coefficient(s, h);
        // The increment is (w - u) / (1 - alpha_f), twice the size at most. The new acceleration takes it in eight
        // roundings, and the test's own equation in eight.
        EXPECT_LT((after.displacement - u).norm(), rounding_error(8 + 8, 2.0 * size));
        EXPECT_LT((after.velocity - v).norm(),  // six roundings on each side, of the same accelerations
                  rounding_error(6 + 6, before.velocity.norm() +
                                            h * (before.acceleration.norm() + s.gamma * after.acceleration.norm())));
        EXPECT_LT((mean(s.alpha_f, before.displacement, after.displacement) - w).norm(), rounding_error(8, 2.0 * size));
        // Eqs. (d) to (g): the rates in the balance are affine in w, with the factors c_m and c_c. Each side goes
        // through some fifteen roundings.
        EXPECT_LT((mean(s.alpha_m, before.acceleration, after.acceleration) - c_m * (w - inertia_centre(s, before, h)))
                      .norm(),
                  rounding_error(15 + 15, c_m * size));
        EXPECT_LT((mean(s.alpha_f, before.velocity, after.velocity) - c_c * (w - damping_centre(s, before, h))).norm(),
                  rounding_error(15 + 15, c_c * size));
        // It is of second order and unconditionally stable.
        EXPECT_EQ(s.gamma, 0.5 - s.alpha_m + s.alpha_f);
        EXPECT_LE(s.alpha_m, s.alpha_f);
        EXPECT_LE(s.alpha_f, 0.5);
        // equal, and of exact numbers, if alpha_f = alpha_m; well above otherwise
        EXPECT_GE(s.beta, 0.25 + (s.alpha_f - s.alpha_m) / 2.0);
    }
}

TEST(GeneralizedAlpha, OfSpectralRadiusOneHalfIsAsPrintedAndOneOutsideZeroToOneIsRefused)
{
    const TimeScheme scheme = generalized_alpha(0.5);
    EXPECT_DOUBLE_EQ(scheme.alpha_m, 0.0);
    EXPECT_DOUBLE_EQ(scheme.alpha_f, 1.0 / 3.0);
    EXPECT_DOUBLE_EQ(scheme.beta, 4.0 / 9.0);
    EXPECT_DOUBLE_EQ(scheme.gamma, 5.0 / 6.0);
    for (const double radius : {-0.1, 1.1, std::nan("")}) EXPECT_THROW(generalized_alpha(radius), pbs::InputError);
}

// Reference: polynomials, whose derivatives are known. A parabola through three displacements gives the velocity of
// quadratic motion exactly, and a cubic through four the acceleration of cubic motion, for steps of any length.
// Tolerances: the condition of differences, by which an error d of the displacements grows to 2 d / h in a slope, to
// its differences over two and three steps in the next.

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
    // A displacement is in error by d, ten roundings of terms that add up to at most 4. The slopes of the last three
    // steps are in error by 2 d / 0.3, 2 d / 0.05 and 2 d / 0.2, their differences over 0.35 and 0.25 by 133 d and 200
    // d, the third difference over 0.55 by 606 d, and the acceleration by 2 (133 d + 0.65 (606 d)).
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

// From rest, the velocity becomes constant at once: the accelerations vanish after three steps, and their impulse
// equals the velocity. The slopes are in error by 2 d / h, the velocity by 4 d / h, the second and third differences by
// 2 d / h^2 and 4/3 d / h^3 and the acceleration by 2 (2 + 3 (4/3)) d / h^2, six of which add up to the impulse.
TEST_F(Prescribed, AJumpOfTheVelocityIsForgottenAndItsImpulseIsWhole)
{
    const double h = 0.1, velocity = 3.0;
    // two roundings of the displacement and two of its differences
    const double d = rounding_error(4, 6 * h * velocity);
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
    const Eigen::Vector3d ones = Eigen::Vector3d::Ones();
    EXPECT_EQ(PrescribedMotion({false, false, false}).next({ones, ones, ones}, 2.0 * ones, 0.1).displacement, ones)
        << "it may be of nothing";
}

// Reference: rigid motion. M sums to the mass of the body, and a rigid velocity has the kinetic energy of mechanics.
// Tolerances: a term of v M v goes through the roundings of an entry, of its row and of the sum over the degrees of
// freedom.
class Mass : public testing::TestWithParam<int> {
protected:
    const SimplexSpace space{test_support::jittered_cube(2), GetParam()};
    const ConsistentMass mass{space, 3.0};

    Eigen::VectorXd field(const Eigen::Matrix3d& gradient, const Vec3& constant) const
    {
        return at_nodes(space, [&](const Vec3& x) -> Vec3 { return gradient * x + constant; });
    }

    double product_error(const Eigen::VectorXd& v) const
    {
        const double roundings = test_support::entry_roundings(space, GetParam() + 1, 2) +
                                 test_support::most_entries(mass.matrix()) + space.dofs();
        return rounding_error(roundings, v.cwiseAbs().dot(test_support::magnitudes(mass.matrix()) * v.cwiseAbs()));
    }
};

// A unit cube of density 3 that moves, and one that rotates about the z axis through its corner: I = 3 (1/3 + 1/3).
TEST_P(Mass, OfATranslationIsThatOfTheBodyAndOfARotationTheMomentOfInertia)
{
    const Vec3 velocity(1.0, -2.0, 0.5);
    const Eigen::VectorXd v = field(Eigen::Matrix3d::Zero(), velocity);
    EXPECT_NEAR(v.dot(mass.times(v)), 3.0 * velocity.squaredNorm(), product_error(v));
    EXPECT_LT(product_error(v), 1e-9) << "a bound that would let a wrong entry pass proves nothing";
    const Eigen::VectorXd spin = field(Eigen::Matrix3d{{0, -1, 0}, {1, 0, 0}, {0, 0, 0}}, Vec3::Zero());
    EXPECT_NEAR(spin.dot(mass.times(spin)), 2.0, product_error(spin));
}

// The three products have the same terms, and each goes through the product and the sum of a row.
TEST_P(Mass, AsAMatrixAndAsBlocksIsTheSameOperator)
{
    const Eigen::VectorXd v = field(Eigen::Matrix3d::Random(), Vec3(1, 2, 3)).cwiseAbs2();
    NodalMatrix blocks(space);
    mass.add_to(blocks, 2.0);
    const Eigen::VectorXd product = mass.times(v);
    const SparseMatrix matrix = mass.matrix();
    const double row = rounding_error(test_support::most_entries(matrix), (matrix.cwiseAbs() * v).norm());
    EXPECT_LE((matrix * v - product).norm(), 2.0 * row);
    EXPECT_LE((blocks.matrix() * v - 2.0 * product).norm(), 2.0 * 2.0 * row);
}

INSTANTIATE_TEST_SUITE_P(ElementOrder, Mass, testing::Values(1, 2));

// Reference: a dense eigenvalue problem by Eigen. Tolerances: both reduce it to eigenvalues of L^-1 K L^-T with M = L
// L^T, whose error by rounding is sqrt(n) eps |K| |M^-1| (G. Golub, C. Van Loan, Matrix Computations, 4th ed.,
// Sec. 8.7.2), and omega is the root of an eigenvalue. The iteration ends at a change of the shape of 1e-13; (K -
// omega^2 M) turns it and the rounding of the solve into a residual.

Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& symmetric)
{
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

TEST(FirstMode, IsTheLowestOfADenseEigenvalueProblemIfThereIsOne)
{
    const VibratingBody body(test_support::jittered_cube(2), {.held = [](const Vec3& x) { return x.z() < 1e-9; }});
    const Mode mode = body.first_mode();
    NodalMatrix stiffness(body.space());
    body.flesh().add_hessian(Eigen::VectorXd::Zero(body.space().dofs()), Definiteness::as_it_is, stiffness);
    std::vector<int> free;
    for (int i = 0; i < body.space().dofs(); ++i)
        if (!body.fixed()[i]) free.push_back(i);
    const Eigen::MatrixXd K = Eigen::MatrixXd(stiffness.matrix())(free, free),
                          M = Eigen::MatrixXd(body.mass().matrix())(free, free);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> dense(K, M);
    const double c = std::sqrt(static_cast<double>(free.size())) * std::numeric_limits<double>::epsilon(),
                 lowest = dense.eigenvalues()(0), norm_of_K = eigenvalues(K).maxCoeff();
    const double omega_bound = c * norm_of_K / eigenvalues(M).minCoeff() / lowest;
    EXPECT_NEAR(mode.omega_rad_s, std::sqrt(lowest), omega_bound * mode.omega_rad_s);
    EXPECT_LT(omega_bound, 1e-8) << "a bound that would let an error of a percent pass proves nothing";
    const Eigen::VectorXd phi = mode.shape(free);
    EXPECT_LT((K * phi - mode.omega_rad_s * mode.omega_rad_s * (M * phi)).norm(), (1e-13 + c) * norm_of_K * phi.norm());
    EXPECT_EQ(mode.shape.cwiseAbs().maxCoeff(), 1.0);
    for (const bool held : {false, true}) {
        const VibratingBody rigid(test_support::jittered_cube(1), {.held = [=](const Vec3&) { return held; }});
        EXPECT_TRUE(std::isnan(rigid.first_mode().omega_rad_s)) << held;
    }
}

}  // namespace
