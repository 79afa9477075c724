// Options of extended position based dynamics (XPBD).
#pragma once

#include "pbs/geometry/types.hpp"

namespace pbs {

struct XpbdOptions {
    double young_pa = 1.0e5;
    double poisson = 0.45;  // at least 1/4, which springs alone have; volume constraints raise it
    double density_kg_m3 = 1000.0;
    int iterations = 24;  // per substep
    int substeps = 1;     // per time step
    Vec3 gravity_m_s2 = Vec3::Zero();
    bool jiggle = false;           // the jiggling zone is integrated in time
    bool keep_multipliers = true;  // false: set to zero in every iteration, a common mistake; a negative control
};

}  // namespace pbs
