// Delta mush (delta_mush.hpp) in packed float or double: every vertex is a row of four numbers, and rotations are computed in all lanes of
// a register at once.
//   PackedDeltaMush<float> mush(mesh, {.iterations = 20});
//   BlendSkinning<float> skinning(mesh.rest, weights);
//   mush.apply(skinning, pose, posed);         // LBS, then delta mush
// Float differs from double by rounding, eps = 1.2e-7. It works relative to the middle of the body, so that far from the origin no digits
// are lost. Smoothing averages, and its error is that of a coordinate, a few eps times the size of the body. A rotation is in error by a
// few eps times the size of the body over the smoothed edges' length, divided by the share s of the second and third singular value in the
// covariance, and moves the detail by that share of its length. On bodies of this project that is below a micrometre per metre.
#pragma once

#include "pbs/skinning/blend.hpp"
#include "pbs/skinning/delta_mush.hpp"

namespace pbs {

// Scalar: float or double. One thread at a time: the last pose is kept in it.
template <class Scalar>
class PackedDeltaMush {
public:
    PackedDeltaMush(const TetMesh& mesh, const DeltaMushOptions& options);

    // Posed positions [m], #V x 3, from LBS by `skinning`, which has the same rest shape.
    void apply(BlendSkinning<Scalar>& skinning, const Pose& pose, Positions& posed);

    // The same without conversion. blended: LBS position - origin [m], #V rows x, y, z; the result posed() has the same origin.
    void apply_rows(const Scalar* blended);
    const std::vector<Scalar>& posed() const { return posed_; }

private:
    std::vector<int> first_, neighbour_;
    std::vector<Scalar> one_over_;                           // the number of neighbours, #V
    std::vector<Scalar> smoothed_rest_, detail_;             // #V rows x, y, z, 0 [m]
    std::vector<Scalar> smoothed_, next_, posed_, blended_;  // of the last pose
    PackedRotations<Scalar> refused_;
    DeltaMushOptions options_;
    Vec3 middle_;  // of the rest shape [m]
};

}  // namespace pbs
