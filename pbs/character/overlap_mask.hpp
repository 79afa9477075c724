// The part of a body where a reference overlaps itself: no deformer has contact, and where a fold has no contact, finer tets do not make it
// converge. Errors can be measured outside of this part (analysis::ErrorMetrics). A skin vertex next to an inverted tet counts too.
//   const OverlapMask mask(character);
//   error_metrics.measure(positions, reference, mask.of(reference));
#pragma once

#include "pbs/character/character.hpp"

namespace pbs {

class OverlapMask {
public:
    explicit OverlapMask(const Character& character);  // which outlives it

    // reference: deformed vertices [m], #V x 3. True for the skin vertices that lie inside another part of the body, and for each vertex
    // whose distance from one of them at rest is at most the limb radius of that skin vertex's bone, #V.
    std::vector<bool> of(const Positions& reference) const;

private:
    const Character& character_;
    std::vector<int> skin_;
    std::vector<double> limb_radius_m_;  // of each vertex's bone, #V
};

}  // namespace pbs
