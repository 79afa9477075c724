#include "reference_fem/near_null_space.hpp"

#include <Eigen/Geometry>

namespace reference_fem {

Eigen::MatrixXd rigid_body_modes(const pbs::Positions& nodes, const pbs::Vec3& centre, double length_m)
{
    Eigen::MatrixXd modes(3 * nodes.rows(), 6);
    for (Eigen::Index n = 0; n < nodes.rows(); ++n) {
        const pbs::Vec3 arm = (nodes.row(n).transpose() - centre) / length_m;
        modes.block<3, 3>(3 * n, 0).setIdentity();
        for (int axis = 0; axis < 3; ++axis) modes.block<3, 1>(3 * n, 3 + axis) = pbs::Vec3::Unit(axis).cross(arm);
    }
    return modes;
}

Eigen::MatrixXd rigid_body_modes(const pbs::Positions& nodes)
{
    const pbs::Vec3 low = nodes.colwise().minCoeff(), high = nodes.colwise().maxCoeff();
    return rigid_body_modes(nodes, (low + high) / 2.0, (high - low).norm());
}

}  // namespace reference_fem
