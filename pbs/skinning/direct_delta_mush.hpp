// Direct delta mush, variant 0 (B. H. Le, J. P. Lewis: Direct delta mush skinning and variants, ACM Transactions on
// Graphics 38(4), 2019). It smooths once, in the rest pose, where delta mush smooths in every pose; a pose then costs
// one blend and one rotation per vertex.
//   const DirectDeltaMush mush(mesh, weights, {.iterations = 10});
//   mush.apply(pose, posed);
// With rest positions u_k, in homogeneous coordinates, weights w_kj and rigid transforms M_j:
//   B = (1 + lambda L D^-1)^-p, C = (1 + kappa L D^-1)^-p               L: Laplacian of the mesh, D: its diagonal
//   Psi_ij = sum_k b_ki w_kj u_k u_k^T,   w'_ij = sum_k c_ki w_kj,      sum_j Psi_ij = (. p_i; p_i^T 1)
//   Omega_ij = (1 - alpha) Psi_ij + alpha w'_ij (p_i p_i^T, p_i; p_i^T, 1)     10 numbers per vertex and bone
//   sum_j M_j Omega_ij = (Q_i, q_i; p_i^T, 1)
//   R_i = the rotation nearest to Q_i - q_i p_i^T,   v_i = q_i + R_i (u_i - p_i)
// alpha = 0 is nearest to delta mush: q_i is then the smoothed LBS. alpha = 1 moves p_i by LBS with the smoothed
// weights w'; the rotations are those of the limit alpha -> 1, since they do not depend on alpha.
// Departures that change no result: Psi_ij is stored about p_i and not about the origin, so that floats lose no digits;
// SVD is replaced by nearest_rotation.hpp, which unlike U V^T is a rotation for every matrix. Departures that do: L is
// the Laplacian of the tets' edges with unit weights, as in delta_mush.hpp; entries of a weight below `negligible` are
// dropped, and the others are scaled to a sum of one.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/delta_mush.hpp"
#include "pbs/skinning/weights.hpp"

namespace pbs {

// implicit_steps: B as above. explicit_steps: (1 - lambda L D^-1)^p, the p smoothing steps of delta mush.
enum class MushSmoothing { implicit_steps, explicit_steps };

struct DirectDeltaMushOptions {
    int iterations = 10;  // p, 0 or more; 0: LBS
    double lambda =
        1.0;  // of the rotations and, with 1 - alpha, of the translations; 0 or more, explicit_steps: at most 1
    double kappa = 0.5;        // of the weights w'; from 0 to lambda
    double alpha = 0.5;        // share of w' in the translations, in [0, 1]
    double negligible = 1e-4;  // weight below which a bone is dropped from a vertex; from 0 to 1e-3
    MushSmoothing smoothing = MushSmoothing::implicit_steps;
    // Which code a deformer runs: this plain one in f64, or PackedDirectMush. Neither class reads it.
    Precision precision = Precision::f64;
    bool packed = false;
};

class DirectDeltaMush {
public:
    // Weights of the mesh's vertices. InputError where an option is out of its range.
    DirectDeltaMush(const TetMesh& mesh, const Weights& weights, const DirectDeltaMushOptions& options);

    void apply(const Pose& pose, Positions& posed) const;  // [m], #V x 3; the pose has every bone of the weights

    // Omega_ij about p_i, except for a factor of the second moments.
    struct Moments {
        int bone;
        double weight;           // (1 - alpha) Psi + alpha w'
        Vec3 first;              // of Psi [m]
        Eigen::Matrix3d second;  // of Psi [m^2]
    };
    // moments of vertex i: first[i] .. first[i + 1] - 1, #V + 1
    const std::vector<int>& first() const { return first_; }
    const std::vector<Moments>& moments() const { return moments_; }  // #entries
    const Positions& centre() const { return centre_; }               // p_i [m], #V x 3
    const Positions& detail() const { return detail_; }               // u_i - p_i [m], #V x 3

private:
    DirectDeltaMushOptions options_;
    std::vector<int> first_;
    std::vector<Moments> moments_;
    Positions centre_, detail_;
};

// Direct delta mush in packed float or double.
//   PackedDirectMush<float> mush(mesh, weights, {.iterations = 10});
//   mush.apply(pose, posed);
// Float differs from double by rounding, eps = 1.2e-7. Everything is relative to the middle of the body, so that far
// from the origin no digits are lost, and moments are relative to the vertex's own centre p_i. A position is in error
// by a few eps times the size of the body, and by its detail times the error of its rotation: a few eps times the size
// of the body over the root of the second singular value of the moments. Scalar: float or double. One thread at a time:
// the last pose is kept in it.
template <class Scalar>
class PackedDirectMush {
public:
    PackedDirectMush(const TetMesh& mesh, const Weights& weights, const DirectDeltaMushOptions& options);

    void apply(const Pose& pose, Positions& posed);  // as DirectDeltaMush::apply

    // The same without conversion: posed position - origin [m], #V rows x, y, z.
    const std::vector<Scalar>& apply_rows(const Pose& pose, const Vec3& origin);
    const std::vector<BoneMoments<Scalar>>& moments() const { return moments_; }  // of all pairs of a vertex and a bone

private:
    std::vector<int> first_;
    std::vector<BoneMoments<Scalar>> moments_;
    std::vector<Scalar> centre_, detail_;  // #V rows of four [m]
    std::vector<PaddedMatrix<Scalar>> bones_;
    std::vector<Scalar> posed_;  // #V rows of three [m]
    PackedRotations<Scalar> refused_;
    Vec3 middle_;  // of the rest shape [m]
};

}  // namespace pbs
