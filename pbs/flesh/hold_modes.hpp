// The springs of the bones as linear constraints of positive stiffness, as a method that projects constraints needs them. In each tet the
// springs sum up to
//   sum_s k_s / 2 |beta_s^T x - q_s|^2 = sum_r sigma_r / 2 |v_r^T x - d_r|^2 + constant,
// with the eigenvalues sigma_r and eigenvectors v_r of the 4 x 4 matrix sum_s k_s beta_s beta_s^T, and
// d_r = v_r^T (sum_s k_s beta_s q_s) / sigma_r. So at most four constraints per tet replace all of its springs, and none of their
// stiffnesses is negative. (BoneHold's split into vertices and edges has negative weights on the edges.) Only d_r depends on the pose.
//   const HoldModes modes(hold);
//   modes.targets(pose, targets);
#pragma once

#include "pbs/flesh/bone_springs.hpp"

namespace pbs {

// The constraint v^T x = d of the four vertices of a tet.
struct HoldMode {
    int tet;
    Eigen::Vector4d v;  // of norm 1
    double stiffness;   // sigma over Young's modulus, above 0 [m]
};

class HoldModes {
public:
    // An eigenvalue below 1e-12 of the largest one of its tet is zero up to rounding, and is left out.
    explicit HoldModes(const BoneHold& hold);

    const std::vector<HoldMode>& modes() const { return modes_; }  // by tet
    void targets(const Pose& pose, Positions& targets) const;      // d_r [m], #modes x 3

private:
    struct Share {
        int mode, bone;
        Vec3 first;     // v^T sum_s k_s beta_s X_s / sigma [m]
        double zeroth;  // v^T sum_s k_s beta_s / sigma
    };
    std::vector<HoldMode> modes_;
    std::vector<Share> shares_;
};

}  // namespace pbs
