// Springs between points of the flesh and its bones: the attachment of the energy-minimising deformers. A spring s
// joins the material point X_s, which the tets carry, to the same point of its bone: k_s / 2 |x(X_s) - T X_s|^2, T the
// bone's transform.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/pose.hpp"

#include <vector>

namespace pbs {

struct BoneSprings {
    Positions points;           // X_s at rest [m], #springs x 3
    Eigen::VectorXd stiffness;  // k_s over Young's modulus [m], #springs
    std::vector<int> bone;      // #springs
};

// The edges of a tet between its corners, in the order of all values per edge of a tet in this folder.
inline constexpr int edges_of_tet[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

// One bone's share of row `row` of the target points of the springs. The row is the sum over its shares of B (first,
// zeroth)^T, where B is the 3 x 4 matrix of the bone's transform.
struct BoneShare {
    int row, bone;
    Vec3 first;     // [m] times the unit of zeroth
    double zeroth;  // a stiffness [m], or over one
};

// The springs summed over tets and vertices. The barycentric coordinates beta of a point in its tet add up to 1, so
// that
//   |sum_i beta_i x_i - q|^2 = sum_i beta_i |x_i - q|^2 - sum_{i<j} beta_i beta_j |x_i - x_j|^2.
// The first sum is a spring of each vertex to a centre c_i, of stiffness a_i; the second one does not depend on the
// pose.
class BoneHold {
public:
    // A spring outside the tets is left out. A bone with no spring left holds nothing.
    BoneHold(const TetMesh& mesh, const BoneSprings& springs, int bones);

    const Eigen::VectorXd& stiffness() const { return stiffness_; }  // a_i over Young's modulus [m], #V
    // -k beta_i beta_j, summed over the springs in each tet, of its edges 01 02 03 12 13 23 [m], #T x 6.
    const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>& edge_stiffness() const { return edge_stiffness_; }
    // the part of a_i that each bone contributes [m], #V x #bones
    const Eigen::MatrixXd& stiffness_of_bones() const { return of_bone_; }
    // The moments sum_s k_s beta (X_s, 1)^T of the springs of one tet and one bone [m^2, m]. Row i belongs to vertex i
    // of the tet. They are sorted by tet, then by bone.
    struct TetMoment {
        int tet, bone;
        Eigen::Matrix4d sum;
    };
    const std::vector<TetMoment>& tet_moments() const { return tet_moments_; }
    int left_out() const { return left_out_; }  // springs outside every tet

    // c_i in a pose [m], #V x 3; zero where nothing holds the vertex.
    void centres(const Pose& pose, Positions& centres) const;
    // sum_s k_s / 2 |T X_s|^2 - sum_i a_i / 2 |c_i|^2: what the two sums above leave out of the energy [m^3].
    double constant(const Pose& pose, const Positions& centres) const;

private:
    struct Moments {
        double zeroth = 0.0, second = 0.0;  // sum_s k_s, sum_s k_s |X_s|^2
        Vec3 first = Vec3::Zero();          // sum_s k_s X_s
    };

    Eigen::VectorXd stiffness_;
    Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor> edge_stiffness_;
    Eigen::MatrixXd of_bone_;
    std::vector<BoneShare> shares_;  // by vertex, then by bone: sum_s k_s beta_i X_s [m^2], sum_s k_s beta_i [m]
    std::vector<TetMoment> tet_moments_;
    std::vector<Moments> moments_;
    int left_out_ = 0;
};

// The springs of the bones as linear constraints of positive stiffness, as a method that projects constraints needs
// them. In each tet the springs sum up to
//   sum_s k_s / 2 |beta_s^T x - q_s|^2 = sum_r sigma_r / 2 |v_r^T x - d_r|^2 + constant,
// with the eigenvalues sigma_r and eigenvectors v_r of the 4 x 4 matrix sum_s k_s beta_s beta_s^T, and
// d_r = v_r^T (sum_s k_s beta_s q_s) / sigma_r. So at most four constraints per tet replace all of its springs, and
// none of their stiffnesses is negative. (BoneHold's split into vertices and edges has negative weights on the edges.)
// Only d_r depends on the pose.
//   const HoldModes modes(hold);
//   modes.targets(pose, targets);

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
    std::vector<HoldMode> modes_;
    std::vector<BoneShare> shares_;  // of each mode: v^T sum_s k_s beta_s X_s / sigma [m], v^T sum_s k_s beta_s / sigma
};

}  // namespace pbs
