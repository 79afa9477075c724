// Options of extended position based dynamics as a deformer.
#pragma once

#include "pbs/geometry/types.hpp"

namespace experiments {

struct XpbdOptions {
    double young_pa = 1.0e5;
    double poisson = 0.45;  // 1/4 or more: springs alone have 1/4, volume constraints raise it
    double density_kg_m3 = 1000.0;
    int iterations = 24;  // in a substep
    int substeps = 1;     // in a time step
    pbs::Vec3 gravity_m_s2 = pbs::Vec3::Zero();
    bool jiggle = false;           // the jiggling zone is integrated in time
    bool keep_multipliers = true;  // false: forgotten in every iteration, a common mistake; a negative control
};

}  // namespace experiments
