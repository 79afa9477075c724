#include "pbs/flesh/bone_springs.hpp"

#include <Eigen/Eigenvalues>

namespace pbs {
namespace {

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
    targets.setZero(static_cast<Eigen::Index>(modes_.size()), 3);
    for (const Share& share : shares_) {
        const Eigen::Isometry3d& bone = pose[share.bone];
        targets.row(share.mode) += (bone.linear() * share.first + share.zeroth * bone.translation()).transpose();
    }
}

}  // namespace pbs
