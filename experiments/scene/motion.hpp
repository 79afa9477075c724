// The motion that a scene asks for: a sweep of a joint, movements, a clip or an animation of the character's model.
//   const CaseMotion motion = make_case_motion(scene.motion, character, scene.file);
//   for (const pbs::Pose& pose : motion.motion.steps) ...
#pragma once

#include "experiments/characters/character.hpp"
#include "experiments/characters/remark.hpp"
#include "experiments/clips/clip.hpp"
#include "pbs/skinning/pose.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace experiments {

struct MotionSpec {
    std::string joint;                    // a sweep of this joint
    pbs::Vec3 axis = pbs::Vec3::UnitX();  // in rest world axes, of any length
    double angle_deg = 0.0;               // of the last frame
    std::vector<std::string> movements;   // or movements of scenes/movements.toml; A+B: both at once
    int frames = 18;                      // of a sweep; of each movement, after the rest pose
    std::string clip;                     // or a clip: its path
    bool of_model = false;                // or an animation of the character's model, which may have none
    std::string animation;  // its name, or of the clip's file; empty: the first one, of a clip the first that moves
    bool allow_partial = false;  // of a clip: fewer than half of its moving joints may match
    double start_s = 0.0, duration_s = 0.0, rate_hz = 100.0;
    double time_step_s = 0.01;
};

// A sweep, movements or a clip on a skeleton. `scene_file` is named in errors.
pbs::Motion make_motion(const MotionSpec& spec, const pbs::Skeleton& skeleton, const std::string& scene_file);

struct StretchedBone {
    std::string bone;
    double change_pct = 0.0;  // of its distance from its parent, where it changes most
    int frame = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StretchedBone, bone, change_pct, frame)

// Any motion, with what looks wrong about it, a sentence each: a motion in which no bone turns, bones that the
// animation scales, joints that move apart, joints and bones that a clip leaves out. An InputError where accepted_match
// throws one.
struct CaseMotion {
    pbs::Motion motion;
    pbs::RemarkList remarks;
    // what the reader of a clip chose, and parts that point elsewhere by more than 10 degrees
    std::vector<std::string> notes;
    std::vector<pbs::PartAngle> angles = {};    // between the body and a clip
    std::vector<StretchedBone> stretched = {};  // by more than 10 %, the most stretched first: squash and stretch
    int clip_joints = 0, matched_joints = 0;    // of a clip: its joints that move, and those of them that move a bone
    double largest_rotation_deg = 0.0;          // of a bone, from the first frame to another one
    bool is_far_from_clip() const               // some part of the body points elsewhere by more than 30 degrees
    {
        return std::ranges::any_of(angles, [](const pbs::PartAngle& angle) { return angle.largest_deg > 30.0; });
    }
    std::string time_zero;     // what time_s = 0 of the records is
    double time_zero_s = 0.0;  // that time in the file of the clip or the animation; 0 of a sweep
};
CaseMotion make_case_motion(const MotionSpec& spec, const pbs::Character& character, const std::string& scene_file);

// Bones of a model from a rigged file that the motion never moves apart are one bone to what is held
// (Character::moves_with).
void take_bones_that_move_as_one(const pbs::Motion& motion, pbs::Character& character);

// The moving joints of a clip that move a bone of the skeleton. An InputError if there are none, or if the scene does
// not allow it and they are fewer than one half or leave out a half of a limb. Fingers, toes and the like of a clip
// whose scheme of names is known do not count where the skeleton lacks them.
pbs::ClipMatch accepted_match(const MotionSpec& spec, const pbs::Clip& clip, const pbs::Skeleton& skeleton);

pbs::MotionSampling sampling_of(const MotionSpec& spec);

}  // namespace experiments
