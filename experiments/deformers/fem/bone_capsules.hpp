// Each bone as a rigid capsule inside the flesh: what the reference is held by. The capsule is the bone's middle (1/6 to 5/6 of its
// length, the part that Eq. 2 gives to one bone alone) with core_radius times the local limb radius. It is defined by the character
// alone, so the continuous problem does not depend on the elements. Its ends are flat: a cylinder, no half spheres.
#pragma once

#include "pbs/character/character.hpp"

#include <string>
#include <vector>

namespace experiments {

struct BoneCapsule {
    pbs::Vec3 start, end;  // of its axis [m]
    double radius_m = 0.0;
    std::string radius_from;  // which vertices gave the limb radius

    bool contains(const pbs::Vec3& point) const;  // between the ends and within the radius
    double volume_m3() const;
};

// The local limb radius is the mean rest distance to the bone over the skin vertices that are nearest to it and project on its middle;
// where there are none, over all skin vertices nearest to it; where there are none either, over the whole skin to its nearest bones.
// A refined character has the capsules of the unrefined one, though its skin vertices are others. A bone without length is a
// pbs::InputError.
std::vector<BoneCapsule> bone_capsules(const pbs::Character& character, double core_radius);

// Sample points of a capsule [m], 7,720 x 3, each standing for the same share of its volume: 40 stations along the axis, and in each disc
// the centre and eight rings of 24, at the radii that halve the areas they stand for. The same for every mesh and element order, and dense
// enough to be a volume also to tets refined twice: a few points would be point loads there, which give way without limit.
pbs::Positions sample_points(const BoneCapsule& capsule);

}  // namespace experiments
