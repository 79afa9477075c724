// Correctives: shapes that are added to the rest shape before linear blend skinning, learned from solved poses (P. G.
// Kry, D. L. James, D. K. Pai: EigenSkin, SCA 2002, in a linear form). They give the shape of a reference at about the
// price of LBS.
//   // solved once, from reference shapes
//   const Correctives correctives = fit_correctives(skeleton, rest, weights, samples);
//   CorrectiveSkinning<float> skinning(correctives, rest, weights);
//   skinning.apply(pose, posed);                                                         // for every pose
//
//   x_v = sum_j w_jv P_j (X_v + d_v),   d_v = sum_j U_jv c_j,   c_j = W_j f_j(pose)
//
// The joint j is where bone j meets its parent. It displaces the vertices that either of the two bones moves, by at
// most `rank` modes U_j [m]. f_j are 40 features: of the rotation R of the bone against its parent, R - 1 (nine
// numbers), the six products of two components of its rotation vector, and the ten of three; and of the parent against
// its own parent the first fifteen. At rest all of them are zero, and no motion of the root changes any.
//
// Departures from EigenSkin: the residual is r = M^-1 (x_ref - x_LBS) with the blended matrix M_v = sum_j w_jv R_j
// itself instead of a rotation, because file formats apply morph targets before the skin: U_j are morph targets as they
// are, and another program shows the same shape. The coefficients are linear in the features instead of interpolated by
// radial basis functions. Poses may move several joints at once: U_j and W_j minimise sum_p w_p |R_p|^2 + sum_j s_j
// |U_j W_j|^2, R_p what is left of r in pose p, joint by joint in several sweeps, parents first. The weights w_p = 1 /
// (|r_p|^2 + m / 20), m the mean of |r_p|^2, let a pose that deforms little count as much as one that deforms a lot.
// For each joint the minimiser consists of the principal components of that part of r which its features explain
// (reduced-rank ridge regression; A. Mukherjee, J. Zhu, Stat. Anal. Data Min. 4, 2011): where they explain all of r,
// these are the principal components of r.
#pragma once

#include "pbs/skinning/blend.hpp"

#include <Eigen/SVD>

#include <array>
#include <vector>

namespace pbs {

inline constexpr int corrective_features = 40;
// a row per bone, #bones x 40
using CorrectiveFeatures = Eigen::Matrix<double, Eigen::Dynamic, corrective_features, Eigen::RowMajor>;

// A solved pose.
struct CorrectiveSample {
    Pose pose;
    Positions shape;  // the reference [m], #V x 3, in the world
};

struct CorrectiveOptions {
    int rank = 8;    // largest number of modes per joint, 1 or more
    int sweeps = 4;  // over all joints, 1 or more
    // The strengths s_j that are tried are the largest squared singular value of a joint's weighted features times 1,
    // 0.1, 0.01 and so on, down to this. 0: down to 1e-12, and no ridge at all is tried too. Poses that resemble each
    // other, such as the frames of a clip, find too weak a ridge by leaving out one of them: without this bound poses
    // beyond the training get worse, and those within it hardly better.
    double least_strength = 1e-3;
    // A singular value of M_v below this counts as this one: where LBS flattens the flesh, r would grow without limit.
    double least_stretch = 0.2;
    // Modes and vertices that are displaced by less than this share of the joint's first mode, or of its largest
    // displacement, are left out.
    double negligible = 0.02;
};

struct JointCorrective {
    int joint = 0;                   // index of the bone below the joint
    std::vector<int> vertices = {};  // that it displaces, #S
    // U_j [m], 3 #S x #K: x, y, z of each vertex; the largest |c_k| of the training poses is one
    Eigen::MatrixXd modes = {};
    Eigen::MatrixXd drivers = {};               // W_j, #K x 40
    Eigen::VectorXd lowest = {}, highest = {};  // c of the training poses and the rest pose, #K
};

struct Correctives {
    int vertices = 0;                              // #V
    std::vector<int> parents = {};                 // of the bones, -1: a root, #bones
    CorrectiveFeatures lowest = {}, highest = {};  // f of the training poses and the rest pose
    std::vector<JointCorrective> joints = {};      // those that displace anything

    Eigen::Index modes() const;  // of all joints
};

// Ridge regression of targets Y, #samples x #targets, on features F, #samples x #features: the W with the least |F W -
// Y|^2 + s |W|^2.
class RidgeRegression {
public:
    explicit RidgeRegression(const Eigen::MatrixXd& features);

    // W; of strength 0: the shortest one
    Eigen::MatrixXd coefficients(const Eigen::MatrixXd& targets, double strength) const;
    // The sum of the squared errors of each sample by the regression on all others. In closed form the error is e_i /
    // (1 - h_i), with e_i the error by the regression on all samples, and h_i the diagonal of F (F^T F + s)^-1 F^T.
    // Infinite where an h_i is 1.
    double left_out_error(const Eigen::MatrixXd& targets, double strength) const;
    // The strength with the least left_out_error. Infinite where none makes it less than W = 0 does.
    double best_strength(const Eigen::MatrixXd& targets, double least) const;
    // Decomposes (F^T F + s)^(1/2) W. With the first k of its right singular vectors B (#targets x k), W B B^T is the
    // minimiser of rank k.
    Eigen::BDCSVD<Eigen::MatrixXd> modes(const Eigen::MatrixXd& coefficients, double strength) const;

private:
    Eigen::VectorXd shares(double strength) const;  // s_k^2 / (s_k^2 + strength)

    Eigen::BDCSVD<Eigen::MatrixXd> svd_;
};

// The features f_j of all joints; zero for a root. Parents precede their children.
CorrectiveFeatures corrective_features_of(const std::vector<int>& parents, const Pose& pose);

// The residual r = M^-1 (x_ref - x_LBS) of each vertex [m], #V x 3.
Positions rest_residual(const Positions& rest, const Weights& weights, const CorrectiveSample& sample,
                        double least_stretch);

// rest [m], #V x 3, and weights of as many; each sample has as many points, and every bone of the skeleton. A joint has
// no correctives if it has no vertices, if it never turns, or if no strength of the ridge predicts samples that are
// left out better than LBS does, as of a single pose. With nothing left out as negligible, the fit never enlarges the
// sum of w_p |r_p|^2 over the samples. InputError where an option is out of its range, and where a sample has other
// than #V finite points.
Correctives fit_correctives(const Skeleton& skeleton, const Positions& rest, const Weights& weights,
                            const std::vector<CorrectiveSample>& samples, const CorrectiveOptions& options = {});

// c of all joints, one after the other, #modes. Each coefficient stays in the range that it has in the training poses.
Eigen::VectorXd corrective_coefficients(const Correctives& correctives, const Pose& pose);

// Whether no feature of any joint is beyond those of the training, except by rounding.
bool is_within_training(const Correctives& correctives, const Pose& pose);

// d of every vertex [m], #V x 3.
Positions corrective_displacements(const Correctives& correctives, const Pose& pose);

// w_p of samples whose residuals have these squared norms.
Eigen::VectorXd sample_weights(const Eigen::VectorXd& squared_residuals);

// Posed positions [m], #V x 3, in plain code.
void corrected_skinning(const Correctives& correctives, const Positions& rest, const Weights& weights, const Pose& pose,
                        Positions& posed);

// The same for many poses of one body, in float or double. One thread at a time. Float differs from double by rounding.
template <class Scalar>
class CorrectiveSkinning {
public:
    CorrectiveSkinning(const Correctives& correctives, const Positions& rest, const Weights& weights);

    void apply(const Pose& pose, Positions& posed);  // [m], #V x 3

private:
    using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
    using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

    Correctives correctives_;  // without modes
    std::vector<Matrix> modes_;
    BlendSkinning<Scalar> skinning_;
    std::vector<Scalar> rest_;  // of skinning_
    Vector moved_;              // by one joint [m]
};

}  // namespace pbs
