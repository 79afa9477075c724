// The requirements of every measurement on its rest mesh: indices in range, and a positive volume of every tet.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

namespace analysis {

// The rest volumes [m^3], #T; InputError if the mesh violates a requirement.
Eigen::VectorXd checked_rest_volumes(const pbs::Positions& rest, const pbs::Tets& tets);

// InputError unless `positions` has as many points as the rest mesh.
void require_points(const pbs::Positions& positions, Eigen::Index vertices, const char* name);

}  // namespace analysis
