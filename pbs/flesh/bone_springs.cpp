#include "pbs/flesh/bone_springs.hpp"

#include "pbs/geometry/point_location.hpp"

#include <map>
#include <utility>

namespace pbs {

BoneHold::BoneHold(const TetMesh& mesh, const BoneSprings& springs, int bones)
    : stiffness_(Eigen::VectorXd::Zero(mesh.rest.rows())),
      edge_stiffness_(Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>::Zero(mesh.tets.rows(), 6)),
      of_bone_(Eigen::MatrixXd::Zero(mesh.rest.rows(), bones)),
      moments_(bones)
{
    const PointLocation where(mesh);
    std::map<std::pair<int, int>, Eigen::Vector4d> shares;   // of a vertex and a bone: first and zeroth
    std::map<std::pair<int, int>, Eigen::Matrix4d> in_tets;  // of a tet and a bone
    for (Eigen::Index s = 0; s < springs.points.rows(); ++s) {
        const double k = springs.stiffness(s);
        if (k == 0.0) continue;
        const Vec3 point = springs.points.row(s);
        const Location location = where.locate(point);
        if (location.tet < 0) {
            ++left_out_;
            continue;
        }
        Eigen::Vector4d beta;
        beta << 1.0 - location.barycentric.sum(), location.barycentric;
        Eigen::Vector4d moment;
        moment << point, 1.0;
        in_tets.try_emplace({location.tet, springs.bone[s]}, Eigen::Matrix4d::Zero()).first->second += k * beta * moment.transpose();
        for (int i = 0, edge = 0; i < 4; ++i) {
            const int vertex = mesh.tets(location.tet, i);
            shares.try_emplace({vertex, springs.bone[s]}, Eigen::Vector4d::Zero()).first->second += k * beta(i) * moment;
            for (int j = i + 1; j < 4; ++j) edge_stiffness_(location.tet, edge++) -= k * beta(i) * beta(j);
        }
        Moments& moments = moments_[springs.bone[s]];
        moments.zeroth += k;
        moments.first += k * point;
        moments.second += k * point.squaredNorm();
    }
    for (const auto& [of, sum] : in_tets) tet_moments_.push_back({of.first, of.second, sum});
    for (const auto& [of, moment] : shares) {
        shares_.push_back({of.first, of.second, moment.head<3>(), moment(3)});
        stiffness_(of.first) += moment(3);
        of_bone_(of.first, of.second) = moment(3);
    }
}

void BoneHold::centres(const Pose& pose, Positions& centres) const
{
    centres.setZero(stiffness_.size(), 3);
    for (const Share& share : shares_) {
        const Eigen::Isometry3d& bone = pose[share.bone];
        centres.row(share.vertex) += (bone.linear() * share.first + share.zeroth * bone.translation()).transpose();
    }
    for (Eigen::Index i = 0; i < centres.rows(); ++i)
        if (stiffness_(i) > 0.0) centres.row(i) /= stiffness_(i);
}

double BoneHold::constant(const Pose& pose, const Positions& centres) const
{
    double constant = 0.0;
    for (std::size_t bone = 0; bone < moments_.size(); ++bone) {
        const Moments& moments = moments_[bone];
        const Vec3 t = pose[bone].translation();
        constant += (moments.second + 2.0 * t.dot(pose[bone].linear() * moments.first) + moments.zeroth * t.squaredNorm()) / 2.0;
    }
    for (Eigen::Index i = 0; i < centres.rows(); ++i) constant -= stiffness_(i) / 2.0 * centres.row(i).squaredNorm();
    return constant;
}

}  // namespace pbs
