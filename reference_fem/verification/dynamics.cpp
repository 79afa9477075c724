// A cantilever of linear flesh that vibrates in its first mode, compared with closed forms in time: the mode, phi
// cos(omega t), is an exact solution of the semi-discrete problem, so every difference is due to the time stepper
// alone. The frequency itself is compared with beam theory.

#include "reference_fem/dynamics/vibrating_body.hpp"
#include "reference_fem/verification/problems.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <fmt/format.h>

#include <random>

namespace reference_fem {
namespace {

double area_m2(const Beam& beam)
{
    return beam.depth_m * beam.depth_m;
}

double second_moment_m4(const Beam& beam)
{
    return std::pow(beam.depth_m, 4) / 12.0;
}

// w' = phi + V / (k G A), phi' = M / (E I), M' = -V - rho I omega^2 phi, V' = -rho A omega^2 w along the beam, z = (w,
// phi, M, V): z' = D z.
Eigen::Matrix4d derivative(const Beam& beam, double omega)
{
    const double nu = beam.poisson, shear_pa = beam.young_pa / (2.0 * (1.0 + nu)),
                 k = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
    const double inertia = beam.density_kg_m3 * omega * omega;
    Eigen::Matrix4d D = Eigen::Matrix4d::Zero();
    D(0, 1) = 1.0;
    D(0, 3) = 1.0 / (k * shear_pa * area_m2(beam));
    D(1, 2) = 1.0 / (beam.young_pa * second_moment_m4(beam));
    D(2, 3) = -1.0;
    D(2, 1) = -inertia * second_moment_m4(beam);
    D(3, 0) = -inertia * area_m2(beam);
    return D;
}

// Determinant of the map from (M, V) at the clamped end to (M, V) at the free end: 0 at a natural frequency. Runge and
// Kutta's fourth-order steps.
double free_end_determinant(const Beam& beam, double omega)
{
    const int steps = 500;
    const Eigen::Matrix4d one = Eigen::Matrix4d::Identity(), z = derivative(beam, omega) * (beam.length_m / steps);
    const Eigen::Matrix4d step = one + z * (one + z / 2.0 * (one + z / 3.0 * (one + z / 4.0)));
    Eigen::Matrix<double, 4, 2> state = Eigen::Matrix<double, 4, 2>::Zero();
    state(2, 0) = state(3, 1) = 1.0;
    for (int i = 0; i < steps; ++i) state = step * state;
    return state.bottomRows<2>().determinant();
}

constexpr double young_pa = 1.0e5, poisson = 0.3, density_kg_m3 = 1000.0;
const Divisions coarse = {10, 1, 1};

struct NamedScheme {
    std::string name, key;
    TimeScheme scheme;
};
const std::vector<NamedScheme> schemes = {
    {"Newmark", "newmark", newmark()},
    {"generalised-alpha, rho = 0.8", "generalised-alpha_rho_0.8", generalized_alpha(0.8)}};

VibratingBody cantilever(const Effort& effort, double nu, int element_order, const Divisions& divisions)
{
    const ElasticMaterial material = solver_material(effort, {young_pa, nu});
    return {box_mesh({0, 0, 0}, {1.0, 0.1, 0.1}, divisions),
            {.element_order = element_order,
             .young_pa = material.young_pa,
             .poisson = material.poisson,
             .density_kg_m3 = density_kg_m3,
             .held = [](const pbs::Vec3& x) { return x.x() < 1e-9; }}};
}

VerificationRow row_of(const VibratingBody& body, double nu, const Divisions& divisions, const RowQuantity& quantity,
                       double value, double reference, const std::string& source)
{
    return row_about({"dynamics", elements_of(body.space().element_order()), linear_material(nu), text_of(divisions),
                      0.1 / divisions[1], body.space().dofs()},
                     quantity, value, reference, "1", source);
}

void add_orders(const Effort& effort, VerificationRows& rows)
{
    VibratingBody body = cantilever(effort, poisson, 1, coarse);
    const Mode mode = body.first_mode();
    const double end_s = 4.0 / mode.omega_rad_s;
    for (const NamedScheme& scheme : schemes)
        for (int steps = 40; steps <= 160; steps *= 2) {
            TimeStepper stepper = body.stepper({.scheme = scheme.scheme});
            stepper.start(mode.shape);
            body.run(stepper, end_s / steps, steps);
            VerificationRow row =
                row_of(body, poisson, coarse,
                       {"first_mode_error",
                        fmt::format("error of the first mode, {}, omega h = {:.3g}", scheme.name, 4.0 / steps),
                        fmt::format("{}_omega_h_{:.3g}", scheme.key, 4.0 / steps)},
                       (stepper.motion().displacement - std::cos(4.0) * mode.shape).norm() / mode.shape.norm(), 0.0,
                       "closed form: phi cos(omega t), phi and omega of the semi-discrete problem");
            row.note = "order in the time step h";
            if (steps > 40) expect_order(row, order_between(rows.back().value, row.value), 2.0, scheme_theory);
            rows.push_back(row);
        }
}

// All modes at once, from random displacements and velocities.
void add_energy(const Effort& effort, VerificationRows& rows)
{
    VibratingBody body = cantilever(effort, poisson, 1, coarse);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    Eigen::VectorXd displacement(body.space().dofs()), velocity(body.space().dofs());
    for (Eigen::Index i = 0; i < displacement.size(); ++i) {
        displacement(i) = body.fixed()[i] ? 0.0 : 1e-2 * entry(random);
        velocity(i) = body.fixed()[i] ? 0.0 : entry(random);
    }
    TimeStepper stepper = body.stepper({});
    stepper.start(displacement, velocity);
    const double before = body.energy_j(stepper);
    const int steps = 1000;
    double drift = 0.0;
    body.run(stepper, 0.01, steps,
             [&](int) { drift = std::max(drift, std::abs(body.energy_j(stepper) / before - 1.0)); });
    rows.push_back(row_of(
        body, poisson, coarse,
        {"energy_drift", fmt::format("largest relative drift of the energy in {} steps of 0.01 s, Newmark", steps)},
        drift, 0.0,
        "closed form: average acceleration keeps the energy (T. Hughes, The Finite Element Method, 1987, ch. 9)"));
    bound(rows.back(), 0.0, 1e-12,
          "rounding: eps times the condition of c_m M + K, here some 100, of random sign in 1000 steps");
}

// The amplification matrix of (u, h v, h^2 a) for u'' + omega^2 u = 0, Omega = omega h: the scheme's three equations as
// they stand.
Eigen::Matrix3d amplification(const TimeScheme& s, double Omega)
{
    Eigen::Matrix3d now, next;
    next << (1.0 - s.alpha_f) * Omega * Omega, 0, 1.0 - s.alpha_m, 1, 0, -s.beta, 0, 1, -s.gamma;
    now << -s.alpha_f * Omega * Omega, 0, -s.alpha_m, 1, 1, 0.5 - s.beta, 0, 1, 1.0 - s.gamma;
    return next.inverse() * now;
}

// The motion of one mode from u = 1 at rest, and the factor by which its energy falls per step in the long run.
struct Decay {
    double energy_left, spectral_radius;
};

Decay decay(const TimeScheme& scheme, double Omega, int steps)
{
    const Eigen::Matrix3d matrix = amplification(scheme, Omega);
    Eigen::Vector3d state(1.0, 0.0, -Omega * Omega);
    for (int k = 0; k < steps; ++k) state = matrix * state;
    return {state(0) * state(0) + std::pow(state(1) / Omega, 2), matrix.eigenvalues().cwiseAbs().maxCoeff()};
}

void add_dissipation(const Effort& effort, VerificationRows& rows)
{
    VibratingBody body = cantilever(effort, poisson, 1, coarse);
    const Mode mode = body.first_mode();
    const TimeScheme scheme = generalized_alpha(0.8);
    const int steps = 50;
    for (const double Omega : {0.5, 2.0, 10.0}) {
        TimeStepper stepper = body.stepper({.scheme = scheme});
        stepper.start(mode.shape);
        const double before = body.energy_j(stepper);
        body.run(stepper, Omega / mode.omega_rad_s, steps);
        const Decay theory = decay(scheme, Omega, steps);
        VerificationRow row = row_of(
            body, poisson, coarse,
            {"energy_left",
             fmt::format("energy left after {} steps, generalised-alpha, rho = 0.8, omega h = {:.3g}", steps, Omega),
             fmt::format("omega_h_{:.3g}", Omega)},
            body.energy_j(stepper) / before, theory.energy_left,
            "closed form: powers of the scheme's 3 x 3 amplification matrix (Chung and Hulbert 1993)");
        bound(row, row.reference * (1.0 - 1e-9), row.reference * (1.0 + 1e-9),
              "rounding: 1e-13 of the mode a step, seen in an energy that fell by up to 1e-4");
        row.note = fmt::format("spectral radius {:.6f}", theory.spectral_radius);
        rows.push_back(row);
    }
}

void add_rayleigh(const Effort& effort, VerificationRows& rows)
{
    VibratingBody body = cantilever(effort, poisson, 1, coarse);
    const Mode mode = body.first_mode();
    const double omega = mode.omega_rad_s, pi = std::acos(-1.0);
    for (const auto& [of_mass, of_stiffness] : {std::pair(0.05, 0.0), std::pair(0.0, 0.05), std::pair(0.02, 0.03)}) {
        const double zeta = of_mass + of_stiffness, omega_d = omega * std::sqrt(1.0 - zeta * zeta);
        TimeStepper stepper = body.stepper(
            {.rayleigh_mass_1_s = 2.0 * of_mass * omega, .rayleigh_stiffness_s = 2.0 * of_stiffness / omega});
        stepper.start(mode.shape);
        const int a_period = 100;
        body.run(stepper, 2.0 * pi / omega_d / a_period, a_period);
        const double one = body.amplitude(stepper, mode);
        body.run(stepper, 2.0 * pi / omega_d / a_period, a_period);
        const double decrement = std::log(one / body.amplitude(stepper, mode));
        rows.push_back(row_of(body, poisson, coarse,
                              {"damping_ratio",
                               fmt::format("damping ratio of the first mode, {:.2f} by mass and {:.2f} by stiffness",
                                           of_mass, of_stiffness),
                               fmt::format("mass_{:.2f}_stiffness_{:.2f}", of_mass, of_stiffness)},
                              decrement / std::hypot(2.0 * pi, decrement), zeta,
                              "closed form: zeta = (a / omega + b omega) / 2, by the logarithmic decrement"));
        bound(rows.back(), zeta * (1.0 - 2e-3), zeta * (1.0 + 2e-3),
              "second order of the scheme: (omega h)^2 / 2 at 100 steps a period");
    }
}

// A solid cantilever differs from the beam by its ends, see cantilever.cpp; the frequency goes with the root of the
// stiffness.
void add_frequency(const Effort& effort, VerificationRows& rows)
{
    for (const double nu : {0.0, poisson})
        for (const int element_order : {1, 2})
            for (const int n : {2, 4}) {
                if (n == 4 && element_order == 2 && !effort.full) continue;
                const Divisions divisions = {10 * n, n, n};
                const VibratingBody body = cantilever(effort, nu, element_order, divisions);
                const Beam beam{1.0, 0.1, young_pa, nu, density_kg_m3};
                VerificationRow row = row_of(body, nu, divisions,
                                             {"bending_frequency_ratio", "first bending frequency over Timoshenko's"},
                                             body.first_mode().omega_rad_s / timoshenko_rad_s(beam), 1.0,
                                             "closed form: Timoshenko's beam with rotary inertia, shear coefficient of "
                                             "G. R. Cowper, J. Appl. Mech. 33 (1966) "
                                             "335-340");
                row.note = fmt::format("Bernoulli and Euler's is {:.4f} of Timoshenko's",
                                       bernoulli_euler_rad_s(beam) / timoshenko_rad_s(beam));
                if (element_order == 2) {
                    const double clamp = 3.0 * nu * nu * 0.1, shear = 0.75 * (12.0 + 11.0 * nu) / 15.0 * 1e-3;
                    bound(row, 1.0 - shear / 2.0, 1.0 + (clamp + shear) / 2.0,
                          "solid against beam, halved by the root: 3 nu^2 h / L for the held anticlastic curvature, "
                          "the shear deflection "
                          "of one depth");
                }
                rows.push_back(row);
            }
}

}  // namespace

double bernoulli_euler_rad_s(const Beam& beam)
{
    const double root = 1.8751040687119611;  // the lowest of cos x cosh x = -1
    return root * root *
           std::sqrt(beam.young_pa * second_moment_m4(beam) /
                     (beam.density_kg_m3 * area_m2(beam) * std::pow(beam.length_m, 4)));
}

double timoshenko_rad_s(const Beam& beam)
{
    // Shear and rotary inertia lower the frequency, and the determinant has one root below Bernoulli and Euler's.
    double low = 0.0, high = bernoulli_euler_rad_s(beam);
    const bool positive_at_low = free_end_determinant(beam, low) > 0.0;
    for (int k = 0; k < 60; ++k) {
        const double middle = (low + high) / 2.0;
        ((free_end_determinant(beam, middle) > 0.0) == positive_at_low ? low : high) = middle;
    }
    return (low + high) / 2.0;
}

VerificationRows dynamics_rows(const Effort& effort)
{
    VerificationRows rows;
    add_orders(effort, rows);
    add_energy(effort, rows);
    add_dissipation(effort, rows);
    add_rayleigh(effort, rows);
    add_frequency(effort, rows);
    return rows;
}

}  // namespace reference_fem
