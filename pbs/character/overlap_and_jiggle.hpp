// The part of a body where a reference overlaps itself: no deformer has contact, and where a fold has no contact, finer tets do not make it
// converge. Errors can be measured outside of this part (analysis::ErrorMetrics). A skin vertex next to an inverted tet counts too.
//   const OverlapMask mask(character);
//   error_metrics.measure(positions, reference, mask.of(reference));
#pragma once

#include "pbs/character/character.hpp"

#include <string>
#include <vector>

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

// The paper's jiggling zone (Sec. 4: vertices farther from the nearest bone than the mean over all vertices) on a body: its share of the
// body, its pieces and its bones.
//   const ZoneContents zone = zone_contents(character);
//   zone.share, zone.pieces.size(), zone.bones.front().name
struct BoneInZone {
    std::string name;
    double share_of_zone = 0.0;  // of the zone's vertices
    double share_of_bone = 0.0;  // of the vertices that are bound to the bone
};

struct ZoneContents {
    double share = 0.0;                    // of all vertices
    double skin_share = 0.0;               // of the zone's vertices that lie on the skin
    std::vector<std::vector<int>> pieces;  // vertices connected by edges inside the zone, the largest piece first
    std::vector<BoneInZone> bones;         // those with vertices in the zone, the largest share of the zone first
};

ZoneContents zone_contents(const Character& character);

}  // namespace pbs
