// Delta mush corrects the artefacts of blending by geometry alone (J. Mancewicz, M. Derksen, H. Rijpkema, C. Wilson, DigiPro 2014). It
// smooths LBS, and adds the detail that smoothing removes from the rest shape, in local frames that rotate with the smoothed body.
//   const DeltaMush mush(mesh, {.iterations = 20});
//   mush.apply(lbs_positions, posed);
// The local frames of that paper are those of the normals of a surface. Here every vertex of the tet mesh, also in the interior, has the
// rotation that best maps its smoothed rest edges to its smoothed posed edges (nearest_rotation.hpp). Smoothing is Laplacian with uniform
// weights. This is plain code in double; delta_mush.hpp computes the same in packed float.
#pragma once

#include "pbs/geometry/precision.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

namespace pbs {

struct DeltaMushOptions {
    int iterations = 20;  // of smoothing
    double step = 0.5;    // share of the way to the neighbours' mean
    // Which code a deformer runs: f64 this plain one, f32 PackedDeltaMush<float>. Neither class reads it.
    Precision precision = Precision::f64;
};

class DeltaMush {
public:
    DeltaMush(const TetMesh& mesh, const DeltaMushOptions& options);

    void apply(const Positions& blended, Positions& posed) const;  // [m], #V x 3

    // These do not depend on the pose: the smoothed rest shape, and the detail that smoothing removes from it [m], #V x 3.
    const Positions& smoothed_rest() const { return smoothed_rest_; }
    const Positions& detail() const { return delta_; }
    const Adjacency& neighbours() const { return neighbours_; }
    const DeltaMushOptions& options() const { return options_; }

private:
    Positions smoothed(Positions positions) const;
    Eigen::Matrix3d rotation(const Positions& smoothed_posed, int vertex) const;

    DeltaMushOptions options_;
    Adjacency neighbours_;
    Positions smoothed_rest_;
    Positions delta_;  // the detail that smoothing removes [m], #V x 3
};

}  // namespace pbs
