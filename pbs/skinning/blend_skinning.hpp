// The blends of blend.hpp for many poses of one body: what does not depend on the pose is packed once, and weights that several vertices
// have (Eq. 2 knows few) are blended once a pose. A vertex of one bone or of such weights then costs one matrix times a point.
//   BlendSkinning<float> skinning(rest, weights);
//   skinning.linear(pose, posed);           // as linear_blend_skinning(rest, weights, pose, posed)
//   skinning.dual_quaternion(pose, posed);  // as dual_quaternion_skinning(rest, weights, pose, posed)
// A pose has every bone that the weights name. One thread at a time: the transforms of the last pose are kept in it.
#pragma once

#include "pbs/skinning/blend.hpp"
#include "pbs/skinning/skinning_kernels.hpp"

namespace pbs {

// Scalar: float or double.
template <class Scalar>
class BlendSkinning {
public:
    BlendSkinning(const Positions& rest, const Weights& weights);  // rest positions [m], #V x 3; weights of as many (unchecked)

    // Posed positions [m], #V x 3. Float blends about the middle of the body, so that far from the origin no digits are lost.
    void linear(const Pose& pose, Positions& posed);
    void dual_quaternion(const Pose& pose, Positions& posed);  // likewise

    // Without conversion: posed position - origin [m], #V rows x, y, z. Float loses no digits where `origin` is near the posed body.
    void linear_rows(const Pose& pose, const Vec3& origin, Scalar* posed);
    void dual_quaternion_rows(const Pose& pose, const Vec3& origin, Scalar* posed);  // likewise

    int vertices() const { return static_cast<int>(packed_.matrix.size()); }  // #V
    const PackedWeights<Scalar>& packed_weights() const { return packed_; }   // what is blended how often

private:
    using Rows = Eigen::Matrix<Scalar, Eigen::Dynamic, 3, Eigen::RowMajor>;

    void place_bones(const Pose& pose, const Vec3& origin);
    void place_turned_bones();
    template <class Blend>
    void blend_in_world(const Pose& pose, Positions& posed, const Blend& blend);

    PackedWeights<Scalar> packed_;
    Vec3 middle_;               // what rest_ is relative to [m]; double: zero
    std::vector<Scalar> rest_;  // #V x 3, and one number that the kernels ask for

    std::vector<Eigen::Isometry3d> placed_;                       // the bones: rest position - middle -> posed position - origin
    std::vector<PaddedMatrix<Scalar>> matrices_;                  // of the bones, then of the shared rows
    std::vector<PackedDualQuaternion<Scalar>> dual_quaternions_;  // of the turned bones
    std::vector<Scalar> posed_;                                   // #V x 3; empty where nothing has to be converted
};

}  // namespace pbs
