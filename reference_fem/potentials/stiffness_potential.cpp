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
    const Eigen::VectorXd offset = displacement - centre_;
    return coefficient_ / 2.0 * offset.dot(stiffness_.transpose() * offset);
}

void StiffnessPotential::add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const
{
    // The matrix is symmetric: its columns are read as rows, which gathers instead of scattering.
    gradient += coefficient_ * (stiffness_.transpose() * (displacement - centre_));
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
