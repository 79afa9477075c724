#include "pbs/flesh/bone_springs.hpp"

#include "pbs/geometry/tet_mesh.hpp"

#include <Eigen/Eigenvalues>

#include <map>
#include <utility>

namespace pbs {
namespace {

Positions posed_sums(const std::vector<BoneShare>& shares, const Pose& pose, Eigen::Index rows)
{
    Positions sums = Positions::Zero(rows, 3);
    for (const BoneShare& share : shares)
        sums.row(share.row) +=
            (pose[share.bone].linear() * share.first + share.zeroth * pose[share.bone].translation()).transpose();
    return sums;
}

constexpr double least_eigenvalue = 1e-12;  // over the largest one

// sum_s k_s beta_s beta_s^T of a tet. The rows add up to sum_s k_s beta_s, since barycentric coordinates add up to 1.
Eigen::Matrix4d stiffness_matrix(const BoneHold& hold, int tet, const Eigen::Vector4d& row_sums)
{
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
    for (int i = 0, edge = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j) matrix(i, j) = matrix(j, i) = -hold.edge_stiffness()(tet, edge++);
    matrix.diagonal() = row_sums - matrix.rowwise().sum();
    return matrix;
}

}  // namespace

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
        in_tets.try_emplace({location.tet, springs.bone[s]}, Eigen::Matrix4d::Zero()).first->second +=
            k * beta * moment.transpose();
        for (int i = 0, edge = 0; i < 4; ++i) {
            const int vertex = mesh.tets(location.tet, i);
            shares.try_emplace({vertex, springs.bone[s]}, Eigen::Vector4d::Zero()).first->second +=
                k * beta(i) * moment;
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
    centres = posed_sums(shares_, pose, stiffness_.size());
    for (Eigen::Index i = 0; i < centres.rows(); ++i)
        if (stiffness_(i) > 0.0) centres.row(i) /= stiffness_(i);
}

double BoneHold::constant(const Pose& pose, const Positions& centres) const
{
    double constant = 0.0;
    for (std::size_t bone = 0; bone < moments_.size(); ++bone) {
        const Moments& moments = moments_[bone];
        const Vec3 t = pose[bone].translation();
        constant +=
            (moments.second + 2.0 * t.dot(pose[bone].linear() * moments.first) + moments.zeroth * t.squaredNorm()) /
            2.0;
    }
    for (Eigen::Index i = 0; i < centres.rows(); ++i) constant -= stiffness_(i) / 2.0 * centres.row(i).squaredNorm();
    return constant;
}

HoldModes::HoldModes(const BoneHold& hold)
{
    const std::vector<BoneHold::TetMoment>& moments = hold.tet_moments();
    for (std::size_t begin = 0, end = 0; begin < moments.size(); begin = end) {
        const int tet = moments[begin].tet;
        Eigen::Vector4d row_sums = Eigen::Vector4d::Zero();
        for (; end < moments.size() && moments[end].tet == tet; ++end) row_sums += moments[end].sum.col(3);
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(stiffness_matrix(hold, tet, row_sums));
        for (int r = 0; r < 4; ++r) {
            const double sigma = eigen.eigenvalues()(r);
            if (!(sigma > least_eigenvalue * eigen.eigenvalues()(3))) continue;
            const Eigen::Vector4d v = eigen.eigenvectors().col(r);
            for (std::size_t m = begin; m < end; ++m) {
                const Eigen::Vector4d share = moments[m].sum.transpose() * v / sigma;
                shares_.push_back({static_cast<int>(modes_.size()), moments[m].bone, share.head<3>(), share(3)});
            }
            modes_.push_back({tet, v, sigma});
        }
    }
}

void HoldModes::targets(const Pose& pose, Positions& targets) const
{
    targets = posed_sums(shares_, pose, static_cast<Eigen::Index>(modes_.size()));
}

}  // namespace pbs
