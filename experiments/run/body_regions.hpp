// A character cut into regions of tets: by the bone that carries a tet, and by the joint that a tet is blended at. By the weights of Eq. 2,
// whatever weights the character is skinned with.
#pragma once

#include "pbs/character/character.hpp"

#include <string>
#include <vector>

namespace experiments {

struct BodyRegions {
    std::string kind;  // bone, joint
    std::vector<std::string> names;
    std::vector<int> of_tet;  // index of `names`, -1: none, #T
};

// Every tet: the bone with most weight over its four corners; of equals, the one that more of them are nearest to.
BodyRegions regions_by_bone(const pbs::Character& character);

// Tets with a blended corner: the two bones with most weight, "thigh.L - shin.L"; joints without tets are left out.
BodyRegions regions_by_joint(const pbs::Character& character);

}  // namespace experiments
