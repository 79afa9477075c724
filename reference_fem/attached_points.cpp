#include "reference_fem/attachment.hpp"

#include "pbs/geometry/tet_mesh.hpp"

#include <limits>
#include <map>

namespace reference_fem {

AttachedPoints::AttachedPoints(const pbs::TetMesh& mesh, const SimplexSpace& space, const pbs::Positions& points,
                               const Eigen::VectorXd& stiffness)
    : points_(points),
      stiffness_(stiffness),
      tet_(points.rows()),
      nodes_(space.tet_nodes().cols(), points.rows()),
      shapes_(space.tet_nodes().cols(), points.rows())
{
    const pbs::PointLocation where(mesh);
    for (Eigen::Index s = 0; s < points.rows(); ++s) {
        const pbs::Location location = where.locate(points.row(s));
        tet_[s] = location.tet;
        if (location.tet < 0) continue;
        nodes_.col(s) = space.tet_nodes().row(location.tet);
        shapes_.col(s) = space.shape_values(location.barycentric);
    }
    sum_tets();
}

void AttachedPoints::sum_tets()
{
    std::map<int, GrippedTet> of_tet;
    for (Eigen::Index s = 0; s < points_.rows(); ++s) {
        if (tet_[s] < 0) continue;
        GrippedTet& gripped = of_tet[tet_[s]];
        if (gripped.nodes.size() == 0) gripped = {nodes_.col(s), Eigen::MatrixXd::Zero(nodes_.rows(), nodes_.rows())};
        gripped.stiffness += stiffness_(s) * shapes_.col(s) * shapes_.col(s).transpose();
    }
    for (auto& [tet, gripped] : of_tet) gripped_.push_back(std::move(gripped));
}

void AttachedPoints::add_to(SparseMatrix& matrix) const
{
    for (const GrippedTet& tet : gripped_)
        for (Eigen::Index a = 0; a < nodes_.rows(); ++a)
            for (Eigen::Index b = 0; b < nodes_.rows(); ++b)
                for (int c = 0; c < 3; ++c) matrix.coeffRef(3 * tet.nodes(a) + c, 3 * tet.nodes(b) + c) += tet.stiffness(a, b);
}

void AttachedPoints::add_load(const pbs::Positions& targets, Eigen::VectorXd& load) const
{
    for (Eigen::Index s = 0; s < points_.rows(); ++s) {
        if (tet_[s] < 0) continue;
        const pbs::Vec3 force = stiffness_(s) * (targets.row(s) - points_.row(s));
        for (Eigen::Index a = 0; a < nodes_.rows(); ++a) load.segment<3>(3 * nodes_(a, s)) += shapes_(a, s) * force;
    }
}

void AttachedPoints::add_to(NodalMatrix& matrix) const
{
    for (const GrippedTet& tet : gripped_)
        for (Eigen::Index a = 0; a < nodes_.rows(); ++a)
            for (Eigen::Index b = 0; b < nodes_.rows(); ++b)
                matrix.add_block(tet.nodes(a), tet.nodes(b), tet.stiffness(a, b) * Eigen::Matrix3d::Identity());
}

double AttachedPoints::energy(const pbs::Positions& targets, const Eigen::VectorXd& displacement) const
{
    double energy = 0.0;
    for (Eigen::Index s = 0; s < points_.rows(); ++s)
        if (tet_[s] >= 0) energy += stiffness_(s) / 2.0 * (moved(s, displacement) - targets.row(s).transpose()).squaredNorm();
    return energy;
}

void AttachedPoints::add_pull(const pbs::Positions& targets, const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const
{
    for (Eigen::Index s = 0; s < points_.rows(); ++s) {
        if (tet_[s] < 0) continue;
        const pbs::Vec3 pull = stiffness_(s) * (moved(s, displacement) - targets.row(s).transpose());
        for (Eigen::Index a = 0; a < nodes_.rows(); ++a) gradient.segment<3>(3 * nodes_(a, s)) += shapes_(a, s) * pull;
    }
}

pbs::Vec3 AttachedPoints::moved(Eigen::Index spring, const Eigen::VectorXd& displacement) const
{
    pbs::Vec3 point = points_.row(spring);
    for (Eigen::Index a = 0; a < nodes_.rows(); ++a) point += shapes_(a, spring) * displacement.segment<3>(3 * nodes_(a, spring));
    return point;
}

pbs::Positions AttachedPoints::moved(const Eigen::VectorXd& displacement) const
{
    pbs::Positions moved_points = points_;
    for (Eigen::Index s = 0; s < points_.rows(); ++s)
        if (tet_[s] < 0)
            moved_points.row(s).setConstant(std::numeric_limits<double>::quiet_NaN());
        else
            moved_points.row(s) = moved(s, displacement).transpose();
    return moved_points;
}

}  // namespace reference_fem
