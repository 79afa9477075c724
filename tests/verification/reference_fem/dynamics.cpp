// Reference: exact solutions of the semi-discrete problem M u'' + C u' + K u = f, so that only the error in time
// remains, and theory: both schemes are of second order and stable for every time step, and generalised-alpha damps
// each mode by the spectral radius of its amplification matrix, which falls from 1 at low to rho at infinite frequency
// (J. Chung, G. Hulbert, J. Appl. Mech. 60(2), 1993). Energy, dissipation, damping and frequencies are rows of the
// verification problem `dynamics`. Tolerance 0.1 on the observed order: the next terms of the error, of relative size
// (omega h)^2 and for rho = 0 some omega h = 0.05 on the finest pair, contribute up to 0.05.
#include "reference_fem/boundary_value_problem.hpp"
#include "reference_fem/dynamics/vibrating_body.hpp"
#include "reference_fem/elastic_body.hpp"
#include "reference_fem/potentials/potentials.hpp"
#include "reference_fem/verification/problems.hpp"

#include "tests/support/fem_rounding.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <random>

namespace {

using namespace reference_fem;
using pbs::Positions;
using pbs::Vec3;
using test_support::at_nodes;

// A bar of these cells, clamped at one end.
VibratingBody clamped_bar(const std::array<int, 3>& cells)
{
    return {test_support::structured_bar({0, 0, 0}, {1, 0.2, 0.2}, cells),
            {.element_order = 1, .held = [](const Vec3& x) { return x.x() < 1e-9; }}};
}

class OrderInTime : public testing::TestWithParam<TimeScheme> {
protected:
    TimeStepperOptions damped(double mass_1_s, double stiffness_s) const
    {
        return {.scheme = GetParam(), .rayleigh_mass_1_s = mass_1_s, .rayleigh_stiffness_s = stiffness_s};
    }

    void expect_second_order(const std::array<double, 3>& errors, const char* quantity)
    {
        const double order = std::log2(errors[1] / errors[2]);
        RecordProperty(std::string("order_of_") + quantity, std::to_string(order));
        EXPECT_NEAR(order, 2.0, 0.1) << quantity << " errors " << errors[0] << " " << errors[1] << " " << errors[2];
    }
};

// u = phi e^(-zeta omega t) (cos omega_d t + zeta / sqrt(1 - zeta^2) sin omega_d t), from phi without velocity.
struct DampedMode {
    double omega, zeta;

    double decay(double t) const { return std::exp(-zeta * omega * t); }
    double omega_d() const { return omega * std::sqrt(1.0 - zeta * zeta); }
    double displacement(double t) const
    {
        return decay(t) * (std::cos(omega_d() * t) + zeta * omega / omega_d() * std::sin(omega_d() * t));
    }
    double velocity(double t) const { return -omega * omega / omega_d() * decay(t) * std::sin(omega_d() * t); }
};

TEST_P(OrderInTime, OfTheFirstModeWithAndWithoutDamping)
{
    VibratingBody bar = clamped_bar({6, 1, 1});
    const Mode mode = bar.first_mode();
    for (const double zeta : {0.0, 0.1}) {
        const double a = zeta * mode.omega_rad_s, b = zeta / mode.omega_rad_s;  // each contributes half of zeta
        const DampedMode exact{mode.omega_rad_s, zeta};
        const double end_s = 4.0 / mode.omega_rad_s;
        std::array<double, 3> displacement_errors, velocity_errors;
        for (int level = 0; level < 3; ++level) {
            const int steps = 40 << level;
            TimeStepper stepper = bar.stepper(damped(a, b));
            stepper.start(mode.shape);
            ASSERT_TRUE(bar.run(stepper, end_s / steps, steps));
            displacement_errors[level] =
                (stepper.motion().displacement - exact.displacement(end_s) * mode.shape).norm();
            velocity_errors[level] = (stepper.motion().velocity - exact.velocity(end_s) * mode.shape).norm();
        }
        expect_second_order(displacement_errors, "displacement");
        expect_second_order(velocity_errors, "velocity");
    }
}

// Every node of the surface moves as u = s(t) A x, an affine field that the elements contain and whose strain is
// uniform. Inside, internal forces vanish, and the body force M A x s'' + a M A x s' makes it the exact solution. Only
// the coupling of free and prescribed nodes in M drives the inside through inertia.
struct AffineMotion {
    static double s(double t) { return std::sin(3.0 * t + 0.4); }
    static double s_dot(double t) { return 3.0 * std::cos(3.0 * t + 0.4); }
    static double s_dot_dot(double t) { return -9.0 * s(t); }
};

class MovedCube {
public:
    MovedCube()
        : space(test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {3, 3, 3}), 1),
          law(space, Model::linear, lame_parameters(1e3, 0.3), Formulation::displacement),
          on_surface(prescribed_data(space, {}).held)
    {
        const Eigen::Matrix3d A{{0.1, 0.2, -0.1}, {0.0, -0.15, 0.1}, {0.2, 0.05, 0.1}};
        field = at_nodes(space, [&](const Vec3& x) -> Vec3 { return A * x; });
    }

    // Relative error of the displacement at the end, with steps that a load path with the given first step takes.
    double error(const TimeScheme& scheme, int steps, double first_part = 1.0)
    {
        const double density = 1000.0, damping = 0.7, end_s = 1.0, h = end_s / steps;
        NewtonMinimiser newton(space, on_surface, LinearSolver::cholmod);
        TimeStepper stepper(
            space, on_surface, law,
            {.scheme = scheme, .density_kg_m3 = density, .rayleigh_mass_1_s = damping, .rayleigh_stiffness_s = 0.01},
            newton);
        stepper.start(AffineMotion::s(0.0) * field, AffineMotion::s_dot(0.0) * field);
        const Eigen::VectorXd momentum = stepper.mass().times(field);
        DeadLoad force(0.0 * momentum);
        Eigen::VectorXd guess = stepper.motion().displacement;
        for (int k = 0; k < steps; ++k) {
            const auto body_force = [&](double fraction) {
                const double t = (k + fraction) * h;
                return AffineMotion::s_dot_dot(t) + damping * AffineMotion::s_dot(t);
            };
            const MovingData data{
                [&](double fraction) -> Eigen::VectorXd { return AffineMotion::s((k + fraction) * h) * field; },
                [&](double from, double to, double share) {
                    force.set(((1.0 - share) * body_force(from) + share * body_force(to)) * momentum);
                }};
            EXPECT_TRUE(stepper.advance({&law, &force}, data, h, guess, {}, {.first_step = first_part}).converged());
        }
        return (guess - AffineMotion::s(end_s) * field).norm() / field.norm();
    }

    SimplexSpace space;
    ElasticPotential law;
    std::vector<bool> on_surface;
    Eigen::VectorXd field;  // A x at the nodes [m], #dofs
};

// Whole steps, or each step in parts of 1/4, 1/4, 1/2, so that the length changes twice per step.
TEST_P(OrderInTime, WithAPrescribedSurfaceInWholeStepsAndInUnequalParts)
{
    MovedCube cube;
    const TimeScheme& s = GetParam();
    expect_second_order({cube.error(s, 40), cube.error(s, 80), cube.error(s, 160)}, "displacement");
    expect_second_order({cube.error(s, 20, 0.25), cube.error(s, 40, 0.25), cube.error(s, 80, 0.25)},
                        "displacement_in_parts");
}

INSTANTIATE_TEST_SUITE_P(Scheme, OrderInTime,
                         testing::Values(newmark(), generalized_alpha(0.8), generalized_alpha(0.0)));

// The amplification matrix of (u, h v / Omega, h^2 a / Omega^2) for u'' + omega^2 u = 0 and Omega = omega h: the
// scheme's three equations, each divided by Omega^2: `next` times the new state is `now` times the old one.
double spectral_radius(const TimeScheme& s, double Omega)
{
    const double one = 1.0 / (Omega * Omega), velocity = 1.0 / Omega;
    const Eigen::Matrix3d next{{1.0 - s.alpha_f, 0, 1.0 - s.alpha_m}, {one, 0, -s.beta}, {0, velocity, -s.gamma}};
    const Eigen::Matrix3d now{{-s.alpha_f, 0, -s.alpha_m}, {one, velocity, 0.5 - s.beta}, {0, velocity, 1.0 - s.gamma}};
    return (next.inverse() * now).eigenvalues().cwiseAbs().maxCoeff();
}

TEST(SpectralRadius, FallsFromOneToRho)
{
    for (const double rho : {0.0, 0.5, 0.8, 1.0}) {
        const TimeScheme scheme = generalized_alpha(rho);
        double before = 1.0;
        for (double Omega = 1e-3; Omega < 1e5; Omega *= 1.5) {
            const double radius = spectral_radius(scheme, Omega);
            // Double eigenvalues have an error of the square root of the rounding, eps times the condition number Omega
            // + 1 / Omega^2.
            EXPECT_LE(radius, before + 1e-5) << "rho " << rho << " Omega " << Omega;
            before = radius;
        }
        EXPECT_NEAR(before, rho, 1e-3);  // at Omega = 8e4: the triple eigenvalue at infinity differs by Omega^(-2/3)
    }
}

// A time step of 0.1 s is 20 to 60 times the limit of an explicit scheme, and still no mode grows, but for rounding: a
// step solves with c_m M + K; the longer the step, the closer its condition is to that of K, the largest. The energy is
// quadratic, so that it changes by twice the bound of a solve; steps round with random sign.
TEST(EnergyInTime, NoTimeStepIsTooLong)
{
    VibratingBody bar = clamped_bar({6, 2, 2});
    NodalMatrix stiffness(bar.space());
    bar.flesh().add_hessian(Eigen::VectorXd::Zero(bar.space().dofs()), Definiteness::as_it_is, stiffness);
    const int steps = 200;
    const double rounding = 2.0 * std::sqrt(double(steps)) * rounding_bound(spectrum(stiffness.matrix(), bar.fixed()));
    std::mt19937 random(7);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    Eigen::VectorXd start(bar.space().dofs());
    for (Eigen::Index i = 0; i < start.size(); ++i) start(i) = bar.fixed()[i] ? 0.0 : entry(random);
    for (const TimeScheme& scheme : {newmark(), generalized_alpha(0.8), generalized_alpha(0.0)})
        for (const double step_s : {0.1, 10.0}) {
            TimeStepper stepper = bar.stepper({.scheme = scheme});
            stepper.start(1e-2 * start, start);
            const double before = bar.energy_j(stepper);
            ASSERT_TRUE(bar.run(stepper, step_s, steps));
            EXPECT_LT(bar.energy_j(stepper), (1.0 + rounding) * before) << "step " << step_s;
        }
}

// Reference: mechanics (momentum) and theory (second order). The material is stable neo-Hookean flesh at finite
// rotations. The order with a moving skeleton is in rows of the verification problem `moving_skeleton`.

const pbs::TetMesh bar = test_support::structured_bar({0, -0.1, -0.1}, {0.6, 0.1, 0.1}, {6, 2, 2});

// A bar that flies, rotates and vibrates under gravity; nothing holds it.
class FreeFlight : public testing::TestWithParam<TimeScheme> {
protected:
    struct Momenta {
        Vec3 linear, angular;
    };
    Momenta momenta(const TimeStepper& time) const
    {
        const Eigen::VectorXd momentum = time.mass().times(time.motion().velocity);
        Momenta sum{Vec3::Zero(), Vec3::Zero()};
        for (int node = 0; node < space.nodes(); ++node) {
            const Vec3 p = momentum.segment<3>(3 * node), u = time.motion().displacement.segment<3>(3 * node);
            sum.linear += p;
            sum.angular += Vec3(space.node_positions().row(node).transpose() + u).cross(p);
        }
        return sum;
    }

    struct Flight {
        Momenta before, after;    // initially and after 0.2 s
        double residual_n_s = 0;  // the sum over the steps of h times the residual that Newton's method may leave
    };
    Flight fly(double step_s, const Vec3& gravity)
    {
        const ElasticPotential flesh(space, Model::stable_neo_hookean, lame_parameters(2e4, 0.3),
                                     Formulation::displacement);
        const std::vector<bool> free(space.dofs(), false);
        NewtonMinimiser newton(space, free, LinearSolver::cholmod);
        TimeStepper time(space, free, flesh, {.scheme = GetParam(), .density_kg_m3 = density}, newton);
        const Eigen::VectorXd u = at_nodes(space, [](const Vec3& x) -> Vec3 {
            return {0.05 * x.x(), 0.0, 0.1 * x.x() * x.x()};
        });
        time.start(u, at_nodes(space, [](const Vec3& x) -> Vec3 {
                       return Vec3(1.0, -0.5, 0.2) + Vec3(1.0, 4.0, 3.0).cross(x - Vec3(0.3, 0, 0));
                   }));
        const DeadLoad load(time.mass().times(at_nodes(space, [&](const Vec3&) { return gravity; })));
        Flight flight{.before = momenta(time), .after = {}};
        Eigen::VectorXd guess = u;
        for (int k = 0; k < std::lround(0.2 / step_s); ++k) {
            const LoadPathSummary step =
                time.advance({&flesh, &load}, {}, step_s, guess, {.relative_tolerance = 1e-10}, {});
            EXPECT_TRUE(step.converged());
            flight.residual_n_s += step_s * 1e-10 * step.steps.back().newton.iterations.back().force_scale_n;
        }
        flight.after = momenta(time);
        return flight;
    }

    const double density = 1000.0;
    const SimplexSpace space{bar, 1};
};

// Internal forces cancel in every step of either scheme, so the momentum changes by m g t. Tolerance: along one axis,
// the residual r of a step adds up to at most sqrt(nodes) |r|, and so does its norm over the axes to sqrt(3 nodes) |r|.
// By (1 - alpha_m) M da_(n+1) + alpha_m M da_n = r, a residual changes the accelerations of all later steps together by
// r / (1 - 2 alpha_m).
TEST_P(FreeFlight, MomentumChangesByTheWeightAlone)
{
    const Vec3 gravity(0, 0, -9.81);
    const auto [before, after, residual_n_s] = fly(0.02, gravity);
    const Vec3 impulse = density * 0.6 * 0.2 * 0.2 * 0.2 * gravity;
    const double tolerance = std::sqrt(3.0 * space.nodes()) * residual_n_s / (1.0 - 2.0 * GetParam().alpha_m);
    EXPECT_LT((after.linear - before.linear - impulse).norm(), tolerance);
    EXPECT_LT(tolerance, 1e-6 * impulse.norm()) << "a bound that would let a wrong mass pass proves nothing";
}

// Neither scheme conserves angular momentum (J. Simo, N. Tarnow, ZAMP 43, 1992, construct one that does); the error is
// of second order. The shortest wave of the mesh is two cells long, 0.2 m, and travels at sqrt((lambda + 2 mu) / rho).
// The error is c h^2 (1 + d), where the next term d is at most (w h)^2 for a motion of angular frequency w.
TEST_P(FreeFlight, AngularMomentumErrsBySecondOrder)
{
    const auto error = [&](double step_s) {
        const auto [before, after, residual_n_s] = fly(step_s, Vec3::Zero());
        return (after.angular - before.angular).norm() / before.angular.norm();
    };
    const double coarse = error(0.0025), fine = error(0.00125);
    RecordProperty("order", std::to_string(std::log2(coarse / fine)));
    const Lame lame = lame_parameters(2e4, 0.3);
    const double wave_1_s = 2.0 * std::acos(-1.0) / 0.2 * std::sqrt((lame.lambda_pa + 2.0 * lame.mu_pa) / density);
    const double d = std::pow(wave_1_s * 0.0025, 2);
    EXPECT_NEAR(std::log2(coarse / fine), 2.0, std::log2((1.0 + d) / (1.0 + d / 4.0))) << coarse << " " << fine;
}

INSTANTIATE_TEST_SUITE_P(Scheme, FreeFlight, testing::Values(newmark(), generalized_alpha(0.8)),
                         [](const auto& info) { return info.param.alpha_f == 0.0 ? "newmark" : "generalized_alpha"; });

class Body : public testing::Test {
protected:
    ElasticBody body(const ElasticOptions& options) const { return {bar, options, held}; }
    static Targets rest(double) { return {Positions(0, 3), bar.rest, {}}; }

    const Attachment held{Positions(0, 3), {}, {0, 1, 2, 3, 4, 5}, {}, {}};
};

TEST_F(Body, AtRestStaysAtRestToTheBit)
{
    for (const auto& [model, dynamics] : {std::pair(Model::linear, Dynamics::generalized_alpha),
                                          {Model::corotational, Dynamics::generalized_alpha},
                                          {Model::stable_neo_hookean, Dynamics::generalized_alpha},
                                          {Model::stable_neo_hookean, Dynamics::newmark}}) {
        ElasticBody resting = body({.model = model,
                                    .element_order = 2,
                                    .dynamics = dynamics,
                                    .rayleigh_mass_1_s = 1.0,
                                    .rayleigh_stiffness_s = 0.1});
        for (int k = 0; k < 3; ++k) ASSERT_TRUE(resting.advance(rest, Vec3::Zero(), 0.01).converged());
        EXPECT_EQ(resting.positions(), bar.rest);
        EXPECT_EQ(resting.kinetic_energy_j(), 0.0);
    }
}

TEST_F(Body, AfterASolveIsAtRest)
{
    ElasticBody hanging = body({.element_order = 1, .dynamics = Dynamics::newmark});
    const Vec3 gravity(0, 0, -1);
    const LoadPathSummary path = hanging.solve(rest, gravity);
    ASSERT_TRUE(path.converged());
    const Positions equilibrium = hanging.positions();
    for (int k = 0; k < 10; ++k) ASSERT_TRUE(hanging.advance(rest, gravity, 0.01).converged());
    // Newton's method leaves a residual of at most 1e-8 F, a displacement of at most 1e-8 F / min|eigenvalue of K|; the
    // sag is small enough for the stiffness K at rest. A force that is suddenly applied moves a vibrating body by at
    // most twice as much. There are two: what the solution for the equilibrium leaves, and what the time steps leave.
    const Spectrum stiffness = test_support::spectrum_of(bar, {.element_order = 1}, held);
    const double force_n = path.steps.back().newton.iterations.back().force_scale_n;
    const double tolerance = 4.0 * NewtonOptions().relative_tolerance * force_n / stiffness.smallest;
    EXPECT_LT((hanging.positions() - equilibrium).norm(), tolerance);
    EXPECT_LT(tolerance, 1e-4 * (equilibrium - bar.rest).norm())
        << "a bound that would let a vibration pass proves nothing";
}

// The targets beyond 0.6 of the path are not numbers. In linear elements the weight does the work rho V g . u on each
// tet, where u is the mean of its corners. Each term goes through the roundings of an entry of the load and of the sum
// over the degrees of freedom.
TEST_F(Body, BearsThePartOfTheWeightThatItsLoadPathReached)
{
    const ElasticOptions options{.element_order = 1};
    ElasticBody hanging = body(options);
    const Vec3 gravity(0, 0, -1);
    const auto targets = [](double fraction) {
        return Targets{
            Positions(0, 3), fraction > 0.6 ? Positions::Constant(bar.rest.rows(), 3, std::nan("")) : bar.rest, {}};
    };
    const LoadPathSummary path = hanging.solve(targets, gravity);
    ASSERT_FALSE(path.converged());
    ASSERT_GT(path.reached, 0.0);
    const Positions moved = hanging.positions() - bar.rest;
    const Eigen::VectorXd volumes = pbs::tet_volumes(bar.rest, bar.tets);
    double work_j = 0.0, terms_j = 0.0;
    for (Eigen::Index t = 0; t < bar.tets.rows(); ++t)
        for (const int corner : bar.tets.row(t)) {
            const double term_j =
                path.reached * options.density_kg_m3 * volumes(t) / 4.0 * moved.row(corner).dot(gravity);
            work_j += term_j;
            terms_j += std::abs(term_j);
        }
    const SimplexSpace space(bar, 1);
    const double roundings = test_support::entry_roundings(space, 2, 1) + space.dofs();
    EXPECT_NEAR(hanging.potential_energy_j(), hanging.strain_energy_j() - work_j,
                test_support::rounding_error(2.0 * roundings, terms_j));
    EXPECT_LT(test_support::rounding_error(2.0 * roundings, terms_j), 1e-6 * terms_j)
        << "a bound that would let another weight pass";
}

TEST_F(Body, RefusesAStepThatIsNotPositiveAndABodyWithoutMass)
{
    ElasticBody still = body({.element_order = 1}), resting = body({.element_order = 1, .dynamics = Dynamics::newmark});
    EXPECT_THROW(still.advance(rest, Vec3::Zero(), 0.01), pbs::InputError) << "quasi-static, it has no step in time";
    EXPECT_EQ(still.kinetic_energy_j(), 0.0);
    for (const double step_s : {0.0, -0.01}) EXPECT_THROW(resting.advance(rest, Vec3::Zero(), step_s), pbs::InputError);
    EXPECT_THROW(body({.element_order = 1, .density_kg_m3 = 0.0, .dynamics = Dynamics::newmark}), pbs::InputError);
    EXPECT_NO_THROW(body({.element_order = 1, .density_kg_m3 = 0.0}));
}

}  // namespace
