// What the paper's jiggling zone (Sec. 4: farther from the nearest bone than the mean over all vertices) is on a body: how much of it, in
// how many pieces, on which bones.
//   const ZoneContents zone = zone_contents(character);
//   zone.share, zone.pieces.size(), zone.bones.front().name
#pragma once

#include "pbs/character/character.hpp"

#include <string>
#include <vector>

namespace experiments {

struct BoneInZone {
    std::string name;
    double share_of_zone = 0.0;  // of the zone's vertices
    double share_of_bone = 0.0;  // of the vertices that hang on the bone
};

struct ZoneContents {
    double share = 0.0;                    // of all vertices
    double skin_share = 0.0;               // of the zone's vertices that lie on the skin
    std::vector<std::vector<int>> pieces;  // vertices connected by edges inside the zone, the largest piece first
    std::vector<BoneInZone> bones;         // those with any of it, the largest share of the zone first
};

ZoneContents zone_contents(const pbs::Character& character);

}  // namespace experiments
