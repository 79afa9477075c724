// The two blends that the paper compares itself with. Both move rest positions [m], #V x 3, into a pose.
//   linear_blend_skinning(rest, weights, pose, posed);
//   BlendSkinning<float> skinning(rest, weights);   // for many poses: packed once
//   skinning.linear(pose, posed);
// Sizes are not checked: `weights` has #V vertices or more, and the pose has a transform for every bone that they name.
// `posed` is resized.
#pragma once

#include "pbs/skinning/skinning_kernels.hpp"
#include "pbs/skinning/weights.hpp"

namespace pbs {

// Linear blend skinning, Eq. 1: v' = sum_j w_j P_j R_j^-1 v [m]. A vertex without weights goes to the origin.
void linear_blend_skinning(const Positions& rest, const Weights& weights, const Pose& pose, Positions& posed);

// Dual quaternion linear blending (Kavan, Collins, Zara, O'Sullivan: Skinning with dual quaternions, I3D 2007). The
// transforms are rigid, and every vertex has at least one weight.
void dual_quaternion_skinning(const Positions& rest, const Weights& weights, const Pose& pose, Positions& posed);

// Skinning weights as the blend kernels read them: which vertices need no blending of their own, and the rows of the
// others.

// A bone's dual quaternion on the side of the pivot's: q and -q are the same rotation, and the heaviest bone of a row
// decides.
struct TurnedBone {
    // Index of the bone that is blended.
    int bone, pivot;                                     // index of the row's heaviest bone, the first of equals
    bool operator==(const TurnedBone&) const = default;  // of both
};

// Rows of weights, sparse in bones: row i has the entries first[i] <= k < first[i + 1]. Weights of zero are left out.
template <class Scalar>
struct WeightRows {
    std::vector<int> first = {0};  // #rows + 1
    std::vector<int> bone;         // #entries
    std::vector<int> turned_bone;  // index into PackedWeights::turned_bones, #entries
    std::vector<Scalar> weight;    // #entries

    int rows() const { return static_cast<int>(first.size()) - 1; }  // 0 of default-made rows
};

// Consecutive vertices that are moved in one loop.
struct VertexStretch {
    // one_matrix: all by the same; matrix_each: by PackedWeights::matrix of each; own_rows: blended one by one.
    enum class Kind { one_matrix, matrix_each, own_rows };
    Kind kind;  // of all its vertices
    // Index of the first vertex.
    int first, last;  // one behind the last vertex
    int own_row;      // the first one's row of PackedWeights::own
};

// Weights of #V vertices. Scalar: float or double.
template <class Scalar>
struct PackedWeights {
    int bones = 0;              // the largest bone that has a vertex, and one
    WeightRows<Scalar> shared;  // blended once per pose: rows that several vertices have (Eq. 2 knows few)
    WeightRows<Scalar> own;     // rows of one vertex alone, in the order of the vertices
    // of a vertex: its only bone, or bones + a shared row; -1: blended by a row of its own, #V
    std::vector<int> matrix;
    std::vector<VertexStretch> stretches;  // all vertices, in order
    std::vector<TurnedBone> turned_bones;  // each one that a row uses, listed once
};

// Every vertex has at least one weight that is not zero (unchecked).
template <class Scalar>
PackedWeights<Scalar> pack_weights(const Weights& weights);

// The deformers in packed code compute relative to an origin near the body, so that float loses no digits, and return
// to the world.

// The middle of the box around the points [m]; zero of no points.
Vec3 middle_of_box(const Positions& points);

// An origin near the posed body: the place to which the first bone of the pose moves the middle of the rest shape.
Vec3 posed_origin(const Pose& pose, const Vec3& middle);

// Rows x, y, z relative to the origin as positions in the world.
template <class Scalar>
void to_world(const std::vector<Scalar>& rows, const Vec3& origin, Positions& positions);

// The blends for many poses of one body: what does not depend on the pose is packed once, and weights that several
// vertices have (Eq. 2 knows few) are blended once per pose. A vertex of one bone or of such weights then costs one
// matrix times a point.
//   BlendSkinning<float> skinning(rest, weights);
//   skinning.linear(pose, posed);           // as linear_blend_skinning(rest, weights, pose, posed)
//   skinning.dual_quaternion(pose, posed);  // as dual_quaternion_skinning(rest, weights, pose, posed)
// A pose has every bone that the weights name. One thread at a time: the transforms of the last pose are kept in it.
// Scalar: float or double.
template <class Scalar>
class BlendSkinning {
public:
    // rest positions [m], #V x 3; weights of as many (unchecked)
    BlendSkinning(const Positions& rest, const Weights& weights);

    // Posed positions [m], #V x 3. Float blends about the middle of the body, so that far from the origin no digits are
    // lost.
    void linear(const Pose& pose, Positions& posed);
    void dual_quaternion(const Pose& pose, Positions& posed);  // likewise

    // The same without conversion: posed position - origin [m], #V rows x, y, z. Float loses no digits if `origin` is
    // near the posed body.
    void linear_rows(const Pose& pose, const Vec3& origin, Scalar* posed);
    void dual_quaternion_rows(const Pose& pose, const Vec3& origin, Scalar* posed);  // likewise

    // The rotations of the blended dual quaternions, #V.
    void rotations(const Pose& pose, std::vector<Eigen::Matrix3d>& rotations);

    int vertices() const { return static_cast<int>(packed_.matrix.size()); }  // #V

    // The rest positions, which a caller may displace between two poses [m]: #V rows x, y, z, in float relative to the
    // middle of the body.
    Scalar* rest_rows() { return rest_.data(); }

private:
    using Rows = Eigen::Matrix<Scalar, Eigen::Dynamic, 3, Eigen::RowMajor>;

    void place_bones(const Pose& pose, const Vec3& origin);
    void place_turned_bones();
    template <class Blend>
    void blend_in_world(const Pose& pose, Positions& posed, const Blend& blend);

    PackedWeights<Scalar> packed_;
    Vec3 middle_;               // what rest_ is relative to [m]; double: zero
    std::vector<Scalar> rest_;  // #V x 3, and one number that the kernels ask for

    // the bones: rest position - middle -> posed position - origin
    std::vector<Eigen::Isometry3d> placed_;
    std::vector<PaddedMatrix<Scalar>> matrices_;  // of the bones, then of the shared rows
    // of the rows of one vertex; only `rotations` needs them
    std::vector<PaddedMatrix<Scalar>> own_matrices_;
    std::vector<PackedDualQuaternion<Scalar>> dual_quaternions_;  // of the turned bones
    std::vector<Scalar> posed_;                                   // #V x 3; empty where nothing has to be converted
};

}  // namespace pbs
