// A quadratic potential by its matrix: c / 2 (u - u0)^T K (u - u0). The flesh of the linear law, and the stiffness-proportional part of
// Rayleigh's damping in a time step.
#pragma once

#include "reference_fem/potentials/potential.hpp"

namespace reference_fem {

// Keeps a copy of K.
class StiffnessPotential : public Potential {
public:
    // stiffness [N/m], of the Hessians' pattern; as it is: c = 1, u0 = 0.
    explicit StiffnessPotential(const NodalMatrix& stiffness);

    void set(double coefficient, Eigen::VectorXd centre);  // c [1], u0 [m], #dofs

    double value(const Eigen::VectorXd& displacement) const override;
    void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override;
    double value_and_add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override;
    void add_hessian(const Eigen::VectorXd& displacement, Definiteness definiteness, NodalMatrix& hessian) const override;
    bool is_quadratic() const override { return true; }

private:
    SparseMatrix stiffness_;
    double coefficient_ = 1.0;
    Eigen::VectorXd centre_;
};

// The Hessian of a potential at rest [N/m].
NodalMatrix rest_stiffness(const SimplexSpace& space, const Potential& potential);

}  // namespace reference_fem
