// Reference: exact solutions of the semi-discrete problem M u'' + C u' + K u = f, so that only the error in time remains, and theory: both
// schemes are of second order (J. Chung, G. Hulbert, J. Appl. Mech. 60(2), 1993). Tolerance 0.1 on the observed order: the next terms of
// the error, of relative size (omega h)^2 and for rho = 0 some omega h = 0.05 on the finest pair, contribute up to 0.05.
#include "reference_fem/dynamics/vibrating_body.hpp"
#include "reference_fem/potentials/potentials.hpp"

#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

namespace {

using namespace reference_fem;

struct SchemeCase {
    const char* name;
    TimeScheme scheme;
};

void PrintTo(const SchemeCase& scheme_case, std::ostream* out)
{
    *out << scheme_case.name;
}

class OrderInTime : public testing::TestWithParam<SchemeCase> {
protected:
    TimeStepperOptions damped(double mass_1_s, double stiffness_s) const
    {
        return {.scheme = GetParam().scheme, .rayleigh_mass_1_s = mass_1_s, .rayleigh_stiffness_s = stiffness_s};
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
    VibratingBody bar(test_support::structured_bar({0, 0, 0}, {1, 0.2, 0.2}, {6, 1, 1}),
                      {.element_order = 1, .held = [](const pbs::Vec3& x) { return x.x() < 1e-9; }});
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
            displacement_errors[level] = (stepper.motion().displacement - exact.displacement(end_s) * mode.shape).norm();
            velocity_errors[level] = (stepper.motion().velocity - exact.velocity(end_s) * mode.shape).norm();
        }
        expect_second_order(displacement_errors, "displacement");
        expect_second_order(velocity_errors, "velocity");
    }
}

// Every node of the surface moves as u = s(t) A x, an affine field that the elements contain and whose strain is uniform. Inside, internal
// forces vanish, and the body force M A x s'' + a M A x s' makes it the exact solution. Only the coupling of free and prescribed nodes in M
// drives the inside through inertia.
struct AffineMotion {
    Eigen::VectorXd field;  // A x at the nodes [m], #dofs

    static double s(double t) { return std::sin(3.0 * t + 0.4); }
    static double s_dot(double t) { return 3.0 * std::cos(3.0 * t + 0.4); }
    static double s_dot_dot(double t) { return -9.0 * s(t); }
};

class Force : public Potential {
public:
    explicit Force(Eigen::VectorXd force) : force_(std::move(force)) {}
    void set(double factor) { factor_ = factor; }
    double value(const Eigen::VectorXd& u) const override { return -factor_ * force_.dot(u); }
    void add_gradient(const Eigen::VectorXd&, Eigen::VectorXd& gradient) const override { gradient -= factor_ * force_; }
    void add_hessian(const Eigen::VectorXd&, Definiteness, NodalMatrix&) const override {}
    bool is_quadratic() const override { return true; }

private:
    Eigen::VectorXd force_;
    double factor_ = 0.0;
};

class MovedCube {
public:
    MovedCube()
        : space(test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {3, 3, 3}), 1),
          law(space, Model::linear, lame_parameters(1e3, 0.3), Formulation::displacement),
          on_surface(space.dofs())
    {
        Eigen::Matrix3d A;
        A << 0.1, 0.2, -0.1, 0.0, -0.15, 0.1, 0.2, 0.05, 0.1;
        motion.field.resize(space.dofs());
        for (int node = 0; node < space.nodes(); ++node) {
            const pbs::Vec3 x = space.node_positions().row(node);
            motion.field.segment<3>(3 * node) = A * x;
            const bool surface = (x.array() < 1e-9 || x.array() > 1.0 - 1e-9).any();
            for (int c = 0; c < 3; ++c) on_surface[3 * node + c] = surface;
        }
    }

    // Relative error of the displacement at the end, with steps that a load path with the given first step takes.
    double error(const TimeScheme& scheme, int steps, double first_part = 1.0)
    {
        const double density = 1000.0, damping = 0.7, end_s = 1.0, h = end_s / steps;
        NewtonMinimiser newton(space, on_surface, LinearSolver::cholmod);
        TimeStepper stepper(space, on_surface, law,
                            {.scheme = scheme, .density_kg_m3 = density, .rayleigh_mass_1_s = damping, .rayleigh_stiffness_s = 0.01},
                            newton);
        stepper.start(AffineMotion::s(0.0) * motion.field, AffineMotion::s_dot(0.0) * motion.field);
        Force force(stepper.mass().times(motion.field));
        Eigen::VectorXd guess = stepper.motion().displacement;
        for (int k = 0; k < steps; ++k) {
            const auto body_force = [&](double fraction) {
                const double t = (k + fraction) * h;
                return AffineMotion::s_dot_dot(t) + damping * AffineMotion::s_dot(t);
            };
            const MovingData data{
                [&](double fraction) -> Eigen::VectorXd { return AffineMotion::s((k + fraction) * h) * motion.field; },
                [&](double from, double to, double share) { force.set((1.0 - share) * body_force(from) + share * body_force(to)); }};
            EXPECT_TRUE(stepper.advance({&law, &force}, data, h, guess, {}, {.first_step = first_part}).converged());
        }
        return (guess - AffineMotion::s(end_s) * motion.field).norm() / motion.field.norm();
    }

    SimplexSpace space;
    ElasticPotential law;
    std::vector<bool> on_surface;
    AffineMotion motion;
};

TEST_P(OrderInTime, WithAPrescribedSurface)
{
    MovedCube cube;
    expect_second_order({cube.error(GetParam().scheme, 40), cube.error(GetParam().scheme, 80), cube.error(GetParam().scheme, 160)},
                        "displacement");
}

// Each step is divided into parts of 1/4, 1/4, 1/2, so that the length changes twice per step.
TEST_P(OrderInTime, WithStepsInUnequalParts)
{
    MovedCube cube;
    expect_second_order(
        {cube.error(GetParam().scheme, 20, 0.25), cube.error(GetParam().scheme, 40, 0.25), cube.error(GetParam().scheme, 80, 0.25)},
        "displacement");
}

INSTANTIATE_TEST_SUITE_P(Scheme, OrderInTime,
                         testing::Values(SchemeCase{"newmark", newmark()}, SchemeCase{"generalized_alpha_0_8", generalized_alpha(0.8)},
                                         SchemeCase{"generalized_alpha_0", generalized_alpha(0.0)}),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
