#include "reference_fem/attached_points.hpp"

#include "reference_fem/point_location.hpp"

#include <limits>

namespace reference_fem {

AttachedPoints::AttachedPoints(const pbs::TetMesh& mesh, const SimplexSpace& space, const pbs::Positions& points,
                               const Eigen::VectorXd& stiffness)
    : points_(points),
      stiffness_(stiffness),
      tet_(points.rows()),
      nodes_(space.tet_nodes().cols(), points.rows()),
      shapes_(space.tet_nodes().cols(), points.rows())
{
    const PointLocation where(mesh);
    for (Eigen::Index s = 0; s < points.rows(); ++s) {
        const Location location = where.locate(points.row(s));
        tet_[s] = location.tet;
        if (location.tet < 0) continue;
        nodes_.col(s) = space.tet_nodes().row(location.tet);
        shapes_.col(s) = space.shape_values(location.barycentric);
    }
}

void AttachedPoints::add_to(SparseMatrix& matrix) const
{
    for (Eigen::Index s = 0; s < points_.rows(); ++s) {
        if (tet_[s] < 0) continue;
        for (Eigen::Index a = 0; a < nodes_.rows(); ++a)
            for (Eigen::Index b = 0; b < nodes_.rows(); ++b)
                for (int c = 0; c < 3; ++c)
                    matrix.coeffRef(3 * nodes_(a, s) + c, 3 * nodes_(b, s) + c) += stiffness_(s) * shapes_(a, s) * shapes_(b, s);
    }
}

void AttachedPoints::add_load(const pbs::Positions& targets, Eigen::VectorXd& load) const
{
    for (Eigen::Index s = 0; s < points_.rows(); ++s) {
        if (tet_[s] < 0) continue;
        const pbs::Vec3 force = stiffness_(s) * (targets.row(s) - points_.row(s));
        for (Eigen::Index a = 0; a < nodes_.rows(); ++a) load.segment<3>(3 * nodes_(a, s)) += shapes_(a, s) * force;
    }
}

pbs::Positions AttachedPoints::moved(const Eigen::VectorXd& displacement) const
{
    pbs::Positions moved = points_;
    for (Eigen::Index s = 0; s < points_.rows(); ++s) {
        if (tet_[s] < 0) moved.row(s).setConstant(std::numeric_limits<double>::quiet_NaN());
        for (Eigen::Index a = 0; tet_[s] >= 0 && a < nodes_.rows(); ++a)
            moved.row(s) += shapes_(a, s) * displacement.segment<3>(3 * nodes_(a, s)).transpose();
    }
    return moved;
}

}  // namespace reference_fem
