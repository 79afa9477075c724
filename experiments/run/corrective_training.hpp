// The training of correctives (pbs/skinning/correctives.hpp): poses that are drawn at random, and solved on linear
// elements.
//   const JointRotations known = rotations_in(skeleton, frames);
//   const auto samples = solved_on_linear_elements(character, reference, drawn_poses(skeleton, known));
//
// A pose turns many joints at once, each independently of the others, so that a thousand poses teach every joint by
// itself and together with its neighbours.
#pragma once

#include "experiments/characters/character.hpp"
#include "experiments/deformers/fem/fem_options.hpp"
#include "pbs/skinning/correctives.hpp"

#include <limits>
#include <vector>

namespace experiments {

// Rotations against the parent that each joint is known to take, #bones lists. A root has none.
using JointRotations = std::vector<std::vector<Eigen::Quaterniond>>;

// The rotations that the joints have in the poses. A pose in which a joint does not turn adds none to it.
JointRotations rotations_in(const pbs::Skeleton& skeleton, const std::vector<pbs::Pose>& poses);
// The rotations of all movements of scenes/movements.toml. A joint whose name ends in .R takes the mirror images, in
// the plane x = 0, of those of the joint whose name ends in .L.
JointRotations rotations_of_movements(const pbs::Skeleton& skeleton);

struct DrawnPoses {
    int count = 900;
    double further_deg = 30.0;  // beyond a known rotation, about any axis
};
// In one third of the poses each joint turns with the probability 0.12, in one third with 0.4, and in one third all do:
// by one of its known rotations, if there are any, and by a random angle up to further_deg about a random axis. No pose
// therefore has exactly a known rotation. The same arguments give the same poses on every system, except for rounding.
std::vector<pbs::Pose> drawn_poses(const pbs::Skeleton& skeleton, const JointRotations& known,
                                   const DrawnPoses& options = {});

// The equilibrium in each pose: the minimum of the energy of linear elements with the material and springs of
// `reference`, without contact. A quasi-Newton method finds it to 1e-5 of its first step (pbs/flesh/quasi_newton.hpp),
// a hundred times as fast as Newton's method along a way from rest. Poses that do not converge are left out, and those
// that are not begun within most_s seconds of processor time. std::invalid_argument for an attachment without springs
// in capsules.
std::vector<pbs::CorrectiveSample> solved_on_linear_elements(const pbs::Character& character,
                                                             const FemOptions& reference,
                                                             const std::vector<pbs::Pose>& poses,
                                                             double most_s = std::numeric_limits<double>::infinity());

}  // namespace experiments
