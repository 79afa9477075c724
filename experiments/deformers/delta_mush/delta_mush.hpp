// Delta mush: the purely geometric answer to what blending breaks (J. Mancewicz, M. Derksen, H. Rijpkema, C. Wilson, DigiPro 2014). LBS is
// smoothed, and what smoothing took from the rest shape is put back in frames that have turned with the smoothed body.
//   const DeltaMush mush(mesh, {.iterations = 20});
//   mush.apply(lbs_positions, posed);
// The paper's frames are those of a surface's normals; every vertex of a tet mesh, inside ones too, has the rotation instead that
// best carries its smoothed rest edges to its smoothed posed ones (polar decomposition). Smoothing is Laplacian with uniform weights.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

namespace experiments {

struct DeltaMushOptions {
    int iterations = 20;  // of smoothing
    double step = 0.5;    // share of the way to the neighbours' mean
};

class DeltaMush {
public:
    DeltaMush(const pbs::TetMesh& mesh, const DeltaMushOptions& options);

    void apply(const pbs::Positions& blended, pbs::Positions& posed) const;  // [m], #V x 3

private:
    pbs::Positions smoothed(pbs::Positions positions) const;
    Eigen::Matrix3d rotation(const pbs::Positions& smoothed_posed, int vertex) const;

    DeltaMushOptions options_;
    pbs::Adjacency neighbours_;
    pbs::Positions smoothed_rest_;
    pbs::Positions delta_;  // what smoothing took [m], #V x 3
};

}  // namespace experiments
