// The first bending frequency of a clamped-free beam of square section by beam theory.
#pragma once

namespace reference_fem {

struct Beam {
    double length_m, depth_m, young_pa, poisson, density_kg_m3;
};

// omega = 1.875104^2 sqrt(E I / (rho A L^4)) [rad/s]: neither shear nor rotary inertia.
double bernoulli_euler_rad_s(const Beam& beam);

// With both (S. Timoshenko, Phil. Mag. 41, 1921), shear coefficient 10 (1 + nu) / (12 + 11 nu) (G. Cowper, J. Appl. Mech. 33, 1966).
double timoshenko_rad_s(const Beam& beam);

}  // namespace reference_fem
