// Each bone as a rigid cylinder inside the flesh, by which a deformable body can be held. Here and in the keys it is
// called a capsule, although its ends are flat. It is the bone's middle (1/6 to 5/6 of its length, the part that Eq. 2
// gives to one bone alone); its radius is core_radius times the local limb radius. It depends on the character alone,
// so the continuous problem does not depend on the elements.
#pragma once

#include "experiments/characters/character.hpp"
#include "pbs/flesh/bone_springs.hpp"

#include <string>
#include <vector>

namespace pbs {

struct BoneCapsule {
    Vec3 start, end;  // of its axis [m]
    double radius_m = 0.0;
    std::string radius_from;  // the vertices that gave the limb radius

    bool contains(const Vec3& point) const;  // between the ends and within the radius
    double volume_m3() const;
};

// The local limb radius is the mean rest distance to the bone over the skin vertices that are nearest to it and project
// on its middle; where there are none, over all skin vertices nearest to it; where there are none either, over the
// whole skin to its nearest bones. A refined character has the capsules of the unrefined one, although its skin has
// other vertices. InputError for a bone without length.
std::vector<BoneCapsule> bone_capsules(const Character& character, double core_radius);

// Sample points of a capsule [m], each with the same share of its volume: 40 stations along the axis, and in each disc
// the centre and eight rings of 24 points, at the radii that halve their areas. That is 7,720 x 3; `samples` multiplies
// the three numbers. The points are the same for every mesh and element order, and dense enough to act as a volume on
// tets refined twice: a few points would be point loads there, under which the flesh yields without limit.
// std::invalid_argument for samples < 1.
Positions sample_points(const BoneCapsule& capsule, int samples = 1);

// How the density of a smooth attachment decreases from 1 on the middle of the axis to 0 on the capsule's surface:
// across the bone by a function of s = rho / R, along it by a step over `ends` radii R at each end (at most half of the
// length).
//   biweight: (1 - s^2)^2 (Tukey's; Beaton, Tukey, Technometrics 16, 1974), the cubic step 3 t^2 - 2 t^3,
//             continuously differentiable
//   wendland: (1 - s)^4 (4 s + 1) and the step 6 t^5 - 15 t^4 + 10 t^3, twice continuously differentiable (H. Wendland,
//             Adv. Comput. Math. 4, 1995)
enum class AttachmentKernel { biweight, wendland };

// The relative density at a point [m]; 0 outside the capsule. `ends` > 0.
double smooth_density(const BoneCapsule& capsule, AttachmentKernel kernel, double ends, const Vec3& point);

// The springs of a smooth attachment. Their density decreases to zero at the surface of the capsules.
struct SmoothSpringOptions {
    double core_radius = 0.7;     // capsule radius over local limb radius
    double spring_factor = 10.0;  // q on the axis
    AttachmentKernel kernel = AttachmentKernel::biweight;
    double ends = 1.0;  // the density decreases over so many capsule radii at each end
    int samples = 1;    // multiplies the numbers of sample points along, across and around a bone
};

struct CapsuleSprings {
    std::vector<BoneCapsule> capsules;  // #bones
    BoneSprings springs;
    std::vector<double> density;  // #springs, relative
    int loose_parts = 0;          // parts that follow linear blend skinning, for no bone could hold them
    double loose_share = 0.0;     // of the volume
};

// Where the springs are.
//   smooth    in the capsules, their density decreasing to zero at the capsules' surface (smooth_density)
//   embedded  in the capsules, of one density: bones that are rigid capsules in the flesh
//   held      as smooth, and stiff ones (rigid_spring_factor over the square of rigid_core_radius) throughout the tets
//             that one bone alone moves, as a skull holds a head: its weight is above weight_alone at all four corners.
//             The weights are the artist's, or those of Eq. 2 smoothed over the mesh's edges. Of a model from a rigged
//             file, a separate part in which no springs span a plane follows linear blend skinning by the artist's
//             weights
enum class SpringPlacement { smooth, embedded, held };
inline constexpr double rigid_spring_factor = 1e4, rigid_core_radius = 0.35, weight_alone = 0.99;

// Where the flesh is cut between parts, a bone has no springs in tets that it does not move. InputError for a bone
// without length.
//   const BoneSprings springs = bone_springs(character, SpringPlacement::smooth, {}).springs;
CapsuleSprings bone_springs(const Character& character, SpringPlacement placement, const SmoothSpringOptions& options);

// The bone that alone moves each tet, #T; -1: none. Bones that move as one (Character::moves_with) are one bone, the
// first of them: a cape that is tied to hips and thighs stands as stiffly as those while they stand still.
std::vector<int> bones_that_move_alone(const Character& character);

// The paper's jiggling zone (Sec. 4: vertices farther from the nearest bone than the mean over all vertices) on a body:
// its share of the body, its pieces and its bones.
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
