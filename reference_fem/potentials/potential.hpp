// A potential energy of the nodal displacements: one term of the total Pi(u) that a static solution minimises. The flesh, the springs of
// the bones, the bind constraint, loads and, in a time step, inertia and damping are such terms.
#pragma once

#include "reference_fem/nodal_matrix.hpp"

#include <cmath>

namespace reference_fem {

// projected: each tet's (or spring's) own matrix is replaced by the nearest one without negative eigenvalues, so that the sum is
// positive semi-definite and every Newton step descends.
enum class Definiteness { as_it_is, projected };

// Terms are added up: gradient and Hessian go on top of what is there.
class Potential {
public:
    virtual ~Potential() = default;

    // displacement [m], #dofs, degree of freedom 3 n + c is component c at node n.
    virtual double value(const Eigen::VectorXd& displacement) const = 0;  // [J]; infinite where a law is not defined
    virtual void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const = 0;                       // [N], #dofs
    virtual void add_hessian(const Eigen::VectorXd& displacement, Definiteness definiteness, NodalMatrix& hessian) const = 0;  // [N/m]

    // Both at once, where that is cheaper; the gradient is left unfinished where the value is not finite.
    virtual double value_and_add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const
    {
        const double energy = value(displacement);
        if (std::isfinite(energy)) add_gradient(displacement, gradient);
        return energy;
    }

    virtual bool is_quadratic() const = 0;  // its Hessian is the same everywhere, so that a factor of it may be kept
};

}  // namespace reference_fem
