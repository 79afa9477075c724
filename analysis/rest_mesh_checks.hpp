// What every measurement asks of the rest mesh it is given: indices in range, no tet without positive volume.
#pragma once

#include "pbs/geometry/types.hpp"

namespace analysis {

// The rest volumes [m^3], #T; InputError where the mesh cannot be measured against.
Eigen::VectorXd checked_rest_volumes(const pbs::Positions& rest, const pbs::Tets& tets);

// InputError unless `positions` has as many points as the rest mesh.
void require_points(const pbs::Positions& positions, Eigen::Index vertices, const char* name);

}  // namespace analysis
