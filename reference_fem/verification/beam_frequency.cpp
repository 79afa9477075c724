#include "reference_fem/verification/beam_frequency.hpp"

#include <Eigen/LU>

#include <cmath>

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

// w' = phi + V / (k G A), phi' = M / (E I), M' = -V - rho I omega^2 phi, V' = -rho A omega^2 w along the beam, z = (w, phi, M, V): z' = D
// z.
Eigen::Matrix4d derivative(const Beam& beam, double omega)
{
    const double nu = beam.poisson, shear_pa = beam.young_pa / (2.0 * (1.0 + nu)), k = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
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

// Determinant of the map from (M, V) at the clamped end to (M, V) at the free end: 0 at a natural frequency. Runge and Kutta's fourth-order
// steps.
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

}  // namespace

double bernoulli_euler_rad_s(const Beam& beam)
{
    const double root = 1.8751040687119611;  // the lowest of cos x cosh x = -1
    return root * root *
           std::sqrt(beam.young_pa * second_moment_m4(beam) / (beam.density_kg_m3 * area_m2(beam) * std::pow(beam.length_m, 4)));
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

}  // namespace reference_fem
