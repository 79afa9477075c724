// An artist's skin weights in the flesh.
#pragma once

#include "pbs/character/embedding.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/weights.hpp"

namespace pbs {

struct TransferredWeights {
    Weights weights;                  // of the tets' vertices, #V
    double largest_distance_m = 0.0;  // from a vertex of the tets' boundary to the surface
};

// A vertex on the boundary of the tets gets the weights of the surface's nearest point (linear in its triangle), a vertex inside their
// harmonic extension. surface [m], #S x 3; triangles #F x 3 with #F > 0; skin: weights of the surface's points, #S. Small weights (1e-6)
// are removed and the others normalised.
TransferredWeights transfer_weights(const TetMesh& mesh, const Positions& surface, const Triangles& triangles, const Weights& skin,
                                    int bones);

// How much of the artist's weights the tets carry: at a point of the surface, the lesser of the artist's weight of a bone and the one that
// the tets have there.
struct CarriedWeight {
    std::vector<double> of_artist, carried;  // sums over the points, #bones
    double share_pct() const;                // 100: the tets move every point as the artist does
};
CarriedWeight carried_weight(const Weights& skin, const Weights& in_tets, const EmbeddedSurface& surface, const Tets& tets, int bones);

}  // namespace pbs
