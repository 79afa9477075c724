// Delta mush corrects the artefacts of blending by geometry alone (J. Mancewicz, M. Derksen, H. Rijpkema, C. Wilson,
// DigiPro 2014). It smooths LBS, and adds the detail that smoothing removes from the rest shape, in local frames that
// rotate with the smoothed body.
//   const DeltaMush mush(mesh, {.iterations = 20});
//   mush.apply(lbs_positions, posed);
// The local frames of that paper are those of the normals of a surface. Here every vertex of the tet mesh, also in the
// interior, has the rotation that best maps its smoothed rest edges to its smoothed posed edges (nearest_rotation.hpp).
// Smoothing is Laplacian with uniform weights. DeltaMush is plain code in double; PackedDeltaMush computes the same in
// packed float. Twenty iterations shrink a limb that is three tets thick to a thread of a hundredth of its width. The
// edges of a thread do not determine the rotation about it, and the detail of neighbours turns in different ways, until
// the limb is inside out. `unsmoothed_share` adds the edges before smoothing, which have the limb's full width. On the
// human of 2,300 vertices in 12 poses of clip 01_01, whose arms are that thin, a share of 0.01 lowers the distance from
// finite elements from 7.7 to 6.8 mm rms and from 70 to 36 mm at most; 0.1 gives 8.1 mm, for the frames then inherit
// the creases of LBS.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/skinning/pose.hpp"
#include "pbs/skinning/skinning_kernels.hpp"

#include <vector>

namespace pbs {

struct DeltaMushOptions {
    int iterations = 20;  // of smoothing
    double step = 0.5;    // share of the way to the neighbours' mean
    // Share of the edges before smoothing in the covariance of a vertex, whose nearest rotation is its frame:
    // sum (smoothed edge) (smoothed rest edge)^T + share * sum (edge) (rest edge)^T.
    double unsmoothed_share = 0.0;
    // Which code a deformer runs: this plain one in f64, or PackedDeltaMush. Neither class reads it.
    Precision precision = Precision::f64;
    bool packed = false;
};

class DeltaMush {
public:
    DeltaMush(const TetMesh& mesh, const DeltaMushOptions& options);

    void apply(const Positions& blended, Positions& posed) const;  // [m], #V x 3

    // These do not depend on the pose: the smoothed rest shape, and the detail that smoothing removes from it [m], #V
    // x 3.
    const Positions& smoothed_rest() const { return smoothed_rest_; }
    const Positions& detail() const { return delta_; }
    const Adjacency& neighbours() const { return neighbours_; }

private:
    Positions smoothed(Positions positions) const;
    Eigen::Matrix3d covariance(const Positions& posed, const Positions& rest, int vertex) const;  // of its edges [m^2]

    DeltaMushOptions options_;
    Adjacency neighbours_;
    Positions rest_;
    Positions smoothed_rest_;
    Positions delta_;  // the detail that smoothing removes [m], #V x 3
};

// Delta mush and direct delta mush share in packed code the rows of four numbers, and the vertices whose rotation the
// formulae refuse.

// Rows x, y, z, `fourth` of points relative to an origin.
template <class Scalar>
std::vector<Scalar> padded_rows(const Positions& points, const Vec3& origin, Scalar fourth = 0);

// Room for refused rotations of #V vertices.
template <class Scalar>
class PackedRotations {
public:
    explicit PackedRotations(Eigen::Index vertices) : vertex_(vertices), covariance_(9 * vertices) {}

    RefusedRotations<Scalar> none_yet();

    // Adds R detail to each of them, R by nearest_rotation. detail: rows of four; posed: rows of three.
    static void turn(const RefusedRotations<Scalar>& refused, const std::vector<Scalar>& detail,
                     std::vector<Scalar>& posed);

private:
    std::vector<int> vertex_;
    std::vector<Scalar> covariance_;
};

// Delta mush in packed float or double: every vertex is a row of four numbers, and rotations are computed in all lanes
// of a register at once.
//   PackedDeltaMush<float> mush(mesh, {.iterations = 20});
//   BlendSkinning<float> skinning(mesh.rest, weights);
//   mush.apply(skinning, pose, posed);         // LBS, then delta mush
// Float differs from double by rounding, eps = 1.2e-7. It works relative to the middle of the body, so that far from
// the origin no digits are lost. Smoothing averages, and its error is that of a coordinate, a few eps times the size of
// the body. A rotation is in error by a few eps times the size of the body over the smoothed edges' length, divided by
// the share s of the second and third singular value in the covariance, and moves the detail by that share of its
// length. On bodies of this project that is below a micrometre per metre. Scalar: float or double. One thread at a
// time: the last pose is kept in it.
template <class Scalar>
class PackedDeltaMush {
public:
    PackedDeltaMush(const TetMesh& mesh, const DeltaMushOptions& options);

    // Posed positions [m], #V x 3, from LBS by `skinning`, which has the same rest shape.
    void apply(BlendSkinning<Scalar>& skinning, const Pose& pose, Positions& posed);

    // The same without conversion. blended: LBS position - origin [m], #V rows x, y, z; the result posed() has the same
    // origin.
    void apply_rows(const Scalar* blended);
    const std::vector<Scalar>& posed() const { return posed_; }

private:
    std::vector<int> first_, neighbour_;
    std::vector<Scalar> one_over_;                           // the number of neighbours, #V
    std::vector<Scalar> rest_, smoothed_rest_, detail_;      // #V rows x, y, z, 0 [m]
    std::vector<Scalar> smoothed_, next_, posed_, blended_;  // of the last pose
    std::vector<Scalar> unsmoothed_;                         // rows as smoothed_; empty: they do not count
    PackedRotations<Scalar> refused_;
    DeltaMushOptions options_;
    Vec3 middle_;  // of the rest shape [m]
};

}  // namespace pbs
