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

// How much of the artist's weights the tets carry [%]: 100 times the mean, over the points of the surface, of the sum over the bones of the
// lesser of the artist's weight and the one that the tets have at that point. 100: the tets move every point as the artist does.
double carried_weight_pct(const Weights& skin, const Weights& in_tets, const EmbeddedSurface& surface, const Tets& tets);

}  // namespace pbs
