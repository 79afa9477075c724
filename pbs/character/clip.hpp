// Motion capture clips (BVH, glTF, FBX, by assimp) and how they reach our skeletons.
#pragma once

#include "pbs/skinning/pose.hpp"

#include <string>
#include <vector>

namespace pbs {

// Joint rotations and root positions as the clip has them. End sites are joints without motion, so that every limb has a direction.
struct Clip {
    std::string name;                                    // the file
    double frame_time_s = 0.0;                           // between frames, 1e-6 to 1000 s
    std::vector<std::string> joints;                     // names, each once, #joints
    std::vector<int> parent;                             // -1: root; parents precede their children
    Positions zero_pose;                                 // joint positions of the zero pose [clip's units], #joints x 3
    std::vector<std::vector<Eigen::Quaterniond>> local;  // relative to the parent, identities in the zero pose, #frames x #joints
    Positions root;                                      // root position per frame [clip's units], #frames x 3
    // 1 or more of a clip that was read.
    int frames() const { return static_cast<int>(local.size()); }
};

// The first motion in the file. BVH keeps its frames; motions with free keys (glTF, FBX) are sampled at 120 Hz. Unreadable, empty and
// non-finite clips are InputErrors, and so are two joints of one name, times of keys that go back, a motion that moves none of the joints,
// files over 256 MiB, and every clip in a build without rig import (PBS_WITH_RIG_IMPORT).
Clip read_clip(const std::string& path);

// An InputError where damage may have led the library astray: a number that is not finite or beyond 1e9, a rotation that is not of unit
// length, a frame time that no motion can have. read_clip has called it.
void check_clip(const Clip& clip);

// The stretch of a clip that is taken; start_s is after the dropped frame.
struct ClipSampling : MotionSampling {
    bool drop_first_frame = true;  // cgspeed's conversions begin with a T pose
};

// The clip's motion on a skeleton: R_bone(t) = R_joint(t) A, A the least rotation from the bone's rest direction to the joint's limb in the
// zero pose (none where the joint branches). joint_map() determines the joint of each bone; bones without one follow their parent.
// Rotations only, so that bones keep their lengths; the root's path is scaled by leg length, and the clip's first frame (the T pose
// dropped) is at the skeleton's rest place. Poses between frames by slerp. A clip none of whose names match is an InputError, and so is a
// stretch of time it does not hold, one without a frame after the dropped one, a rate_hz or time_step_s that is not positive, and a product
// of the two that is not 1 / n with n from 1 to 100,000.
Motion retarget(const Clip& clip, const Skeleton& skeleton, const ClipSampling& sampling);

// Full path of a clip given by name: as it is, relative to `folder`, or in Debian's assimp-testmodels. InputError where it is
// in none of them.
std::string find_clip(const std::string& name, const std::string& folder);

// The joint of a clip that moves a bone, and how. Joints are indices into Clip::joints; -1: none.
struct JointMapping {
    int joint = -1;
    int limb_end = -1;         // where the joint's limb ends; -1: at its first descendant
    int twist_joint = -1;      // the bone takes a share of this joint's twist about the limb
    double twist_share = 0.0;  // 0 to 1
    bool aligned = false;      // the bone turns to the joint's limb; false: it keeps its own rest direction (spine, neck, clavicles)
    bool leg = false;          // its length counts in the scale of the root's path
};

// Where clip and skeleton have the names of two schemes that are known (the table in joint_names.cpp: bodies by name, CMU, Mixamo, Rigify,
// Unreal), a bone follows the joint of the same part of the body. All other bones follow the joint of the same name; where there is none,
// names are compared without capitals, separators, namespaces and the spelling of the side (LeftHand, hand_l, L.Hand).
struct JointMap {
    std::vector<JointMapping> bones;  // #bones
    std::vector<bool> is_small;       // fingers, toes and the like of a clip with a known scheme, #joints
};
JointMap joint_map(const Clip& clip, const Skeleton& skeleton);

// Angle [rad], in (-pi, pi], of the twist of `rotation` about the unit vector `axis` (swing-twist decomposition).
double twist_angle(const Eigen::Quaterniond& rotation, const Vec3& axis);

// How much of a clip reaches a skeleton.
struct ClipMatch {
    int moving = 0;                                // joints of the clip whose rotation changes
    int matched = 0;                               // of these, joints that a bone follows
    std::vector<std::string> unmatched;            // names of the others
    int small = 0;                                 // of the others, fingers, toes and the like, which a body may lack
    std::vector<std::string> bones_without_joint;  // names of the bones that follow their parent
};

// By the same names as retarget().
ClipMatch match_of(const Clip& clip, const Skeleton& skeleton);

// The largest rotation of a bone from the first pose to another one [deg]; translations do not count.
double largest_rotation_deg(const Motion& motion);

// The largest displacement of an end of a bone from the first pose to another one [m].
double largest_displacement_m(const Motion& motion, const Skeleton& skeleton);

// The skeleton that a clip's file (BVH, glTF, FBX) carries: its joints in the zero pose.
//   const Skeleton skeleton = skeleton_from_clip(read_clip("01_01.bvh"), 0.0254 / 0.45);   // CMU's unit in metres
// A bone runs from each joint to its first child that lies elsewhere; joints without one (ends, and joints that coincide with their child)
// have none, and what is attached to them is attached to the next bone above. scale: metres per unit of the clip. InputError where no bone
// is left.
Skeleton skeleton_from_clip(const Clip& clip, double scale);

// Whether a file is BVH, by its extension or its first word, HIERARCHY, as assimp decides. White space and a byte-order mark may precede.
bool is_bvh(const std::string& text, const std::string& path);

// Checks what assimp does not. InputError: Frames or Frame Time is not a positive number, the header announces more frames than the text
// can hold, or joints are nested deeper than a reader's stack allows. The reader itself refuses a file without a header.
void check_bvh_header(const std::string& text, const std::string& path);

}  // namespace pbs
