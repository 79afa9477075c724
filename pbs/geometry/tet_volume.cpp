#include "pbs/geometry/tet_volume.hpp"

namespace pbs {

Eigen::VectorXd tet_volumes(const Positions& positions, const Tets& tets)
{
    Eigen::VectorXd volumes(tets.rows());
    for (Eigen::Index t = 0; t < tets.rows(); ++t)
        volumes(t) = tet_volume(positions.row(tets(t, 0)), positions.row(tets(t, 1)), positions.row(tets(t, 2)), positions.row(tets(t, 3)));
    return volumes;
}

Eigen::VectorXd lumped_volumes(const Positions& rest, const Tets& tets)
{
    const Eigen::VectorXd volumes = tet_volumes(rest, tets);
    Eigen::VectorXd lumped = Eigen::VectorXd::Zero(rest.rows());
    for (Eigen::Index t = 0; t < tets.rows(); ++t)
        for (int corner = 0; corner < 4; ++corner) lumped(tets(t, corner)) += volumes(t) / 4.0;
    return lumped;
}

}  // namespace pbs
