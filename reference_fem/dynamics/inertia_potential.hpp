// Inertia as a potential of one time step: c / 2 |w - w~|_M^2, whose gradient is M a. The mass-proportional part of Rayleigh's damping is
// another one, with its own c and centre.
#pragma once

#include "reference_fem/dynamics/consistent_mass.hpp"
#include "reference_fem/potentials/potential.hpp"

namespace reference_fem {

// Call set() before anything else.
class InertiaPotential : public Potential {
public:
    explicit InertiaPotential(const ConsistentMass& mass) : mass_(mass) {}  // which outlives the potential

    // c [1/s^2], w~ [m], #dofs.
    void set(double coefficient, Eigen::VectorXd centre)
    {
        coefficient_ = coefficient;
        centre_ = std::move(centre);
    }

    double value(const Eigen::VectorXd& displacement) const override
    {
        const Eigen::VectorXd offset = displacement - centre_;
        return coefficient_ / 2.0 * offset.dot(mass_.times(offset));
    }
    void add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override
    {
        value_and_add_gradient(displacement, gradient);
    }
    double value_and_add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const override
    {
        const Eigen::VectorXd offset = displacement - centre_, force = coefficient_ * mass_.times(offset);
        gradient += force;
        return force.dot(offset) / 2.0;
    }
    void add_hessian(const Eigen::VectorXd&, Definiteness, NodalMatrix& hessian) const override { mass_.add_to(hessian, coefficient_); }
    bool is_quadratic() const override { return true; }

private:
    const ConsistentMass& mass_;
    double coefficient_ = 0.0;
    Eigen::VectorXd centre_;
};

}  // namespace reference_fem
