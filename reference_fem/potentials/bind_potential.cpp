#include "reference_fem/potentials/bind_potential.hpp"

#include <algorithm>

namespace reference_fem {

pbs::Vec3 BindPotential::offset(const Eigen::VectorXd& displacement, Eigen::Index vertex) const
{
    return rest_.row(vertex).transpose() + displacement.segment<3>(3 * vertex) - bind_points_.row(vertex).transpose();
}

double BindPotential::value(const Eigen::VectorXd& displacement) const
{
    double energy = 0.0;
    for (Eigen::Index v = 0; v < stiffness_.size(); ++v) {
        const double stretch = offset(displacement, v).norm() - distance_(v);
        energy += stiffness_(v) / 2.0 * stretch * stretch;
    }
    return energy;
}

// d/dx (|r| - d)^2 / 2 = (1 - d / |r|) r
void BindPotential::add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const
{
    for (Eigen::Index v = 0; v < stiffness_.size(); ++v) {
        const pbs::Vec3 r = offset(displacement, v);
        const double length = r.norm();
        if (length > 0.0) gradient.segment<3>(3 * v) += stiffness_(v) * (1.0 - distance_(v) / length) * r;
    }
}

// n n^T + (1 - d / |r|) (I - n n^T), n = r / |r|; at r = 0 the direction is not defined and only d = 0 has a Hessian.
void BindPotential::add_hessian(const Eigen::VectorXd& displacement, Definiteness definiteness, NodalMatrix& hessian) const
{
    for (Eigen::Index v = 0; v < stiffness_.size(); ++v) {
        if (stiffness_(v) == 0.0) continue;
        const pbs::Vec3 r = offset(displacement, v);
        const double length = r.norm();
        const pbs::Vec3 n = length > 0.0 ? pbs::Vec3(r / length) : pbs::Vec3(pbs::Vec3::Zero());
        double across = length > 0.0 ? 1.0 - distance_(v) / length : 1.0;
        if (definiteness == Definiteness::projected) across = std::max(across, 0.0);
        const Eigen::Matrix3d along = n * n.transpose();
        hessian.add_block(int(v), int(v), stiffness_(v) * (along + across * (Eigen::Matrix3d::Identity() - along)));
    }
}

}  // namespace reference_fem
