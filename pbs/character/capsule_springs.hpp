// The springs by which bones hold the flesh: at sample points of a capsule around each bone (bone_capsules.hpp), so that they act as a
// volume. The density of their stiffness is q E / r^2 times a relative density, r the capsule's radius.
//   const CapsuleSprings held = smooth_springs(character, {});
#pragma once

#include "pbs/character/bone_capsules.hpp"
#include "pbs/flesh/bone_springs.hpp"

#include <functional>

namespace pbs {

// The springs of a smooth attachment: their density decreases to zero at the surface of the capsules.
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
};

CapsuleSprings smooth_springs(const Character& character, const SmoothSpringOptions& options);

// density: relative, of a point of a capsule [m]. InputError for a bone without length.
CapsuleSprings capsule_springs(const Character& character, const SmoothSpringOptions& options,
                               const std::function<double(const BoneCapsule&, const Vec3&)>& density);

}  // namespace pbs
