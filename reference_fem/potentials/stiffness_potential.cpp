#include "reference_fem/potentials/stiffness_potential.hpp"

namespace reference_fem {

StiffnessPotential::StiffnessPotential(const NodalMatrix& stiffness)
    : stiffness_(stiffness.matrix()), centre_(Eigen::VectorXd::Zero(stiffness.matrix().rows()))
{
}

void StiffnessPotential::set(double coefficient, Eigen::VectorXd centre)
{
    coefficient_ = coefficient;
    centre_ = std::move(centre);
}

double StiffnessPotential::value(const Eigen::VectorXd& displacement) const
{
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(displacement.size());
    return value_and_add_gradient(displacement, gradient);
}

void StiffnessPotential::add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const
{
    value_and_add_gradient(displacement, gradient);
}

double StiffnessPotential::value_and_add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const
{
    const Eigen::VectorXd offset = displacement - centre_;
    // The matrix is symmetric: its columns are read as rows, which gathers instead of scattering.
    const Eigen::VectorXd force = coefficient_ * (stiffness_.transpose() * offset);
    gradient += force;
    return force.dot(offset) / 2.0;
}

void StiffnessPotential::add_hessian(const Eigen::VectorXd&, Definiteness, NodalMatrix& hessian) const
{
    hessian.add(stiffness_, coefficient_);
}

NodalMatrix rest_stiffness(const SimplexSpace& space, const Potential& potential)
{
    NodalMatrix stiffness(space);
    potential.add_hessian(Eigen::VectorXd::Zero(space.dofs()), Definiteness::as_it_is, stiffness);
    return stiffness;
}

}  // namespace reference_fem
