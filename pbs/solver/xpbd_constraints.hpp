// The constraints of extended position based dynamics with their compliances (xpbd_solver.hpp states where these come from).
#pragma once

#include "pbs/constraints/bind.hpp"
#include "pbs/constraints/stretch.hpp"
#include "pbs/constraints/volume.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/options.hpp"

#include <vector>

namespace pbs {

template <typename Constraint>
struct Compliant {
    Constraint constraint;    // its stiffness is 1 and not used
    double compliance = 0.0;  // alpha: of a length [m/N], of a volume [m^5/N]
};

// In the order of their projection.
struct XpbdConstraints {
    std::vector<Compliant<BindConstraint<double>>> bind;        // by vertex, compliance zero
    std::vector<Compliant<StretchConstraint<double>>> stretch;  // by edges
    std::vector<Compliant<VolumeConstraint<double>>> volume;    // by tets; none where Poisson's ratio is 1/4
    std::vector<double> inverse_mass;                           // [1/kg], #V; zero: held
};

// bind_distance: d_i [m], #V; empty: no bind constraints. held: #V, or empty. InputError for Poisson's ratios outside [1/4, 1/2).
XpbdConstraints make_xpbd_constraints(const TetMesh& mesh, const Eigen::VectorXd& bind_distance, const XpbdOptions& options,
                                      const std::vector<bool>& held);

}  // namespace pbs
