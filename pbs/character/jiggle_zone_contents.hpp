// The paper's jiggling zone (Sec. 4: vertices farther from the nearest bone than the mean over all vertices) on a body: its share of the
// body, its pieces and its bones.
//   const ZoneContents zone = zone_contents(character);
//   zone.share, zone.pieces.size(), zone.bones.front().name
#pragma once

#include "pbs/character/character.hpp"

#include <string>
#include <vector>

namespace pbs {

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
