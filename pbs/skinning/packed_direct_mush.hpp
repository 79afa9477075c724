// Direct delta mush (direct_delta_mush.hpp) in packed float or double.
//   PackedDirectMush<float> mush(mesh, weights, {.iterations = 10});
//   mush.apply(pose, posed);
// Float differs from double by rounding, eps = 1.2e-7. Everything is relative to the middle of the body, so that far from the origin no
// digits are lost, and moments are relative to the vertex's own centre p_i. A position is in error by a few eps times the size of the body,
// and by its detail times the error of its rotation: a few eps times the size of the body over the root of the second singular value of the
// moments.
#pragma once

#include "pbs/skinning/delta_mush.hpp"
#include "pbs/skinning/direct_delta_mush.hpp"

namespace pbs {

// Scalar: float or double. One thread at a time: the last pose is kept in it.
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
