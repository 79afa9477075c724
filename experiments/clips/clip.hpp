// Motion capture clips, and how they reach the skeletons of characters. BVH files are read here; glTF, FBX and COLLADA
// files by the readers of rigs.
//   const Clip walk = read_clip("walk.bvh");
//   const Motion motion = retarget(walk, skeleton, {});
#pragma once

#include "pbs/skinning/pose.hpp"

#include <array>
#include <string>
#include <vector>

namespace pbs {

constexpr double shortest_frame_s = 1e-6, longest_frame_s = 1e3;  // time between two frames of a clip

// Joint rotations and places as the clip has them. End sites are joints without motion, so that every limb has a
// direction.
struct Clip {
    std::string name;                 // the file
    double frame_time_s = 0.0;        // between frames, 1e-6 to 1000 s
    std::vector<std::string> joints;  // names, each once, #joints
    std::vector<int> parent;          // -1: root; parents precede their children
    Positions zero_pose;              // joint positions of the zero pose [clip's units], #joints x 3
    // relative to the parent, identities in the zero pose, #frames x #joints
    std::vector<std::vector<Eigen::Quaterniond>> local;
    // joint positions in each frame [clip's units], #frames of #joints x 3
    std::vector<Positions> places;
    std::vector<bool> holds = {};              // joints whose keys are steps, #joints; empty: none
    std::vector<std::string> body_parts = {};  // as Bone::body_part, #joints; empty: the file has no table
    std::vector<std::string> remarks = {};     // what the reader chose or corrected, a sentence each
    // 1 or more of a clip that was read.
    int frames() const { return static_cast<int>(local.size()); }
};

// The motion in the file. BVH keeps its frames. Of a rig (glTF, FBX, COLLADA) the animation of that name is taken; if
// the name is empty, the first one that turns a joint by more than 5 degrees, or else the one that turns one most. It
// is sampled at 120 Hz, and its zero pose is the bind pose of the skin, or where there is none the pose of the nodes
// without an animation. Unreadable, empty and non-finite clips are InputErrors, and so are two joints of one name, a
// motion that moves none of the joints, files over 256 MiB, and every clip in a build without rig import
// (PBS_WITH_RIG_IMPORT).
Clip read_clip(const std::string& path, const std::string& animation = "");

// The parts of read_clip for BVH. Its dialects are read: keywords in any case, names with spaces, any white space and
// line breaks, several roots, a row more or less than Frames states, numbers without a blank before a minus sign, and
// positions in the channels in place of offsets. An InputError names the line, the field and the rule. is_bvh decides
// by the extension, or by the first word, HIERARCHY, after a byte-order mark.
bool is_bvh(const std::string& text, const std::string& path);
Clip read_bvh(const std::string& text, const std::string& path);

// An InputError where damage may have led the library astray: a number that is not finite or beyond 1e9, a rotation
// that is not of unit length, a frame time that no motion can have. read_clip has called it.
void check_clip(const Clip& clip);

// The frame with which the motion of a clip begins: 1 where the first frame is the zero pose or a T or A pose, as in
// cgspeed's conversions, else 0.
int first_frame_of_motion(const Clip& clip);

// The stretch of a clip that is taken; start_s is after the dropped frame.
struct ClipSampling : MotionSampling {
    bool drops_rest_pose = true;  // with which the clip may begin: first_frame_of_motion
};

// The angle between a part of the posed body and the same part of the clip.
struct PartAngle {
    std::string part;          // hips, chest, head, left upper arm, ...
    double largest_deg = 0.0;  // over the steps of the motion
};

// The clip's motion on a skeleton: R_bone(t) = C R_joint(t) C^-1 A. R_joint is the turn of the joint from the rest pose
// of the clip, C carries the axes of the clip's body into those of the skeleton's (body_axes.hpp), and A is the least
// rotation from the bone's rest direction to the joint's limb in the rest pose (none where the joint branches).
// joint_map() determines the joint of each bone; bones without one follow their parent. Rotations only, so that bones
// keep their lengths; the path of the joint that moves the root bone is scaled by leg length, and the clip's first
// frame (a rest pose dropped) is at the skeleton's rest place. Poses between frames by slerp. InputErrors: a clip none
// of whose names match; one whose rest pose cannot be known; a first frame in which the body's trunk or hips point more
// than 30 degrees away from the clip's; a stretch of time it does not hold, one without a frame after the dropped one;
// a rate_hz or time_step_s that is not positive, and a product of the two that is not 1 / n with n from 1 to 100,000.
// angles: the parts whose joints are known, if wanted.
Motion retarget(const Clip& clip, const Skeleton& skeleton, const ClipSampling& sampling,
                std::vector<PartAngle>* angles = nullptr);

// Full path of a clip given by name: as it is, relative to `folder`, or in Debian's assimp-testmodels. InputError where
// it is in none of them.
std::string find_clip(const std::string& name, const std::string& folder);

// The joint of a clip that moves a bone, and how. Joints are indices into Clip::joints; -1: none.
struct JointMapping {
    int joint = -1;
    int limb_end = -1;         // where the joint's limb ends; -1: at its first descendant
    int twist_joint = -1;      // the bone takes a share of this joint's twist about the limb
    double twist_share = 0.0;  // 0 to 1
    bool aligned =
        false;  // the bone turns to the joint's limb; false: it keeps its own rest direction (spine, neck, clavicles)
    bool leg = false;  // its length counts in the scale of the root's path
};

// The joints of a body, by the table of names: indices into the joints of a clip or the bones of a skeleton, -1:
// unknown. Left, right.
struct BodyJoints {
    int chest = -1, neck = -1, head = -1;
    std::array<int, 2> upper_arm = {-1, -1}, forearm = {-1, -1}, hand = {-1, -1}, thigh = {-1, -1}, shin = {-1, -1},
                       foot = {-1, -1};
};

// The joints of the clip's body, by the names of the joints or by the table of body parts in the clip's file
// (Clip::body_parts). All are unknown (-1) if no scheme of names has both the clip's thighs and its shins.
BodyJoints body_joints(const Clip& clip);

// A bone follows the joint of the same name. Where there is none, and clip and skeleton have the names of two schemes
// that are known (the table in joint_names.csv), it follows the joint of the same part of the body. For all others,
// names are compared without capitals, separators, namespaces, a prefix or a number at the end that all names have, and
// the spelling of the side (LeftHand, hand_l, L.Hand). If a file has a table of body parts (VRM), the name of the part
// is compared first, and then the name of the joint.
struct JointMap {
    std::vector<JointMapping> bones;  // #bones
    std::vector<bool> is_small;       // fingers, toes and the like of a clip with a known scheme, #joints
    BodyJoints of_clip, of_skeleton;
    // Limbs of which one half has a joint and the other one, whose joint moves in the clip, has none: "forearm.L".
    std::vector<std::string> torn;
};
JointMap joint_map(const Clip& clip, const Skeleton& skeleton);

// Angle [rad], in (-pi, pi], of the twist of `rotation` about the unit vector `axis` (swing-twist decomposition).
double twist_angle(const Eigen::Quaterniond& rotation, const Vec3& axis);

// Whether a joint turns in its parent by more than single precision's rounding, 1e-4 rad, from the first frame to
// another one.
bool joint_moves(const Clip& clip, std::size_t joint);

// How much of a clip reaches a skeleton.
struct ClipMatch {
    int moving = 0;                                // joints of the clip whose rotation changes
    int matched = 0;                               // of these, joints that a bone follows
    std::vector<std::string> unmatched;            // names of the others
    int small = 0;                                 // of the others, fingers, toes and the like, which a body may lack
    std::vector<std::string> bones_without_joint;  // names of the bones that follow their parent
    std::vector<std::string> torn;                 // bones of limbs whose other half follows the clip, as in JointMap
};

// By the same names as retarget().
ClipMatch match_of(const Clip& clip, const Skeleton& skeleton);

// The largest rotation of a bone from the first pose to another one [deg]; translations do not count.
double largest_rotation_deg(const Motion& motion);

// The largest displacement of an end of a bone from the first pose to another one [m].
double largest_displacement_m(const Motion& motion, const Skeleton& skeleton);

// The skeleton that a clip's file (BVH, glTF, FBX, COLLADA) carries: its joints in the clip's rest pose.
//   const Skeleton skeleton = skeleton_from_clip(read_clip("01_01.bvh"), 0.0254 / 0.45);   // CMU's unit in metres
// A bone runs from each joint to its first child that lies elsewhere; joints without one (ends, and joints that
// coincide with their child) have none, and what is attached to them is attached to the next bone above. scale: metres
// per unit of the clip. InputError where no bone is left.
Skeleton skeleton_from_clip(const Clip& clip, double scale);

}  // namespace pbs
