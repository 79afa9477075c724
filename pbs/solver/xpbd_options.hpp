// Options of extended position based dynamics (XPBD).
#pragma once

#include "pbs/solver/options.hpp"

namespace pbs {

// XpbdSolver refuses with an InputError: poisson outside [1/4, 1/2), substeps below 1, threads below 1.
struct XpbdOptions {
    double young_pa = 1.0e5;
    double poisson = 0.45;  // at least 1/4, which springs alone have; volume constraints raise it
    double density_kg_m3 = 1000.0;
    int iterations = 24;  // per substep
    int substeps = 1;     // per time step
    Vec3 gravity_m_s2 = Vec3::Zero();
    bool jiggle = false;                   // the jiggling zone is integrated in time
    bool keep_multipliers = true;          // false: set to zero in every iteration, a common mistake; a negative control
    Order order = Order::plain;            // within each class; ordered and grouped are packed code
    Precision precision = Precision::f64;  // of the projections and their multipliers
    int threads = 1;                       // of a step in packed code, where the mesh is large enough for more than one to pay
};

}  // namespace pbs
