// The scene that `pbskin try` makes of a model: all that a user would otherwise write by hand.
#pragma once

#include "experiments/rigs/rigged_body.hpp"
#include "experiments/scene/scene.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace experiments {

struct TrialOptions {
    std::string model;      // the file, relative to the working folder
    std::string animation;  // one of the model's by name, a clip's FILE, or FILE:NAME; empty: the first one that moves
    std::string skeleton;   // of a model without joints: a file, or human
    std::string folder;     // where scene.toml will be
    int frames = 60;        // at most, distributed over the motion
    int vertices = 0;       // wanted of the tets; 0: the default of models
    double scale = 1.0;
    bool error_bar = false;            // bounds the reference's own error
    double reference_seconds = 120.0;  // of processor time, for all frames of the reference; 0: no limit
    bool reference = true;             // also left out, with a remark, where the finite elements are not installed
    bool allow_partial = false;
    bool bake = false;      // learns correctives from the reference, which then may not be left out
    bool paraview = false;  // the frames are kept as .vtu and .vtp too
};

// The text of scene.toml, and what the user should know about choices that were made, a sentence each. InputErrors are
// those of read_model and read_clip, fewer than two frames, a scale beyond 1e-6 to 1e6, and names that are not UTF-8,
// which a scene cannot hold.
struct TrialScene {
    std::string text;
    Remarks remarks;
    nlohmann::json animations;  // those of the model, in the order of the file: [{name, duration_s,
                                // largest_rotation_deg of a joint}]
};
TrialScene trial_scene(const TrialOptions& options);

// The animation of a model that a trial takes if none is named: the first one that turns a joint by more than 5
// degrees, else the one that moves most, else a pose; null: none moves a joint or poses one. made: gets a note on the
// choice, and the description of all animations.
const pbs::RigAnimation* moving_animation(const TrialOptions& options, const pbs::Rig& rig, const pbs::RiggedBody& body,
                                          TrialScene& made);

// The frames per second of a motion of which at most so many frames are wanted: 30 Hz or fewer. InputError for a motion
// so long that the rate would be below 1e-3 Hz.
double trial_rate_hz(double duration_s, int frames, const std::string& file);

// The scene of an earlier trial of the model in options.folder, which a new one replaces; empty: there is none. An
// InputError where the folder has the trial of another model, a scene that a user wrote or changed, or other files that
// a trial would replace.
std::string earlier_trial_scene(const TrialOptions& options);

// The results of a trial, computed from the records of its run.

// The facts of try.json: the model as the run read it (joints, dropped joints with reasons, containers, bind pose,
// unit, weights), the motion with its matched joints, what time_s = 0 of the records is (time_zero) and the bones that
// move away from their parents by more than 10 % or towards them (stretched_bones: bone, change_pct, frame; then volume
// is not judged), the run's warnings, the gravest first, and
//   volume        per deformer the lowest and highest change of the volume over the frames [%], and the most inverted
//                 tets in a frame
//   notes         of the run: warnings beyond the third one, and where nothing is wrong
//   deforms       whether some flesh changes its shape in some frame
//   joints        the two joints (of a bone and its parent) at which lbs loses most volume, with the mean change there
//                 of lbs and pbs [% of the joints' volume]
//   nearest       at the joints, or over the body where there is none (place): the methods by the median of their
//                 errors, the least first (methods: deformer, median_pct, and nearest_in, the number of frames in which
//                 it has the least error), over so many frames, in which all have an error and one of them is at least
//                 0.01 %. Null without a reference
//   doubtful_reference  why no method is called nearest: lag, where a bone turns by more than 5 degrees against flesh
//                       that it alone moves; far_from_all, where the median error of every method is above 50 %;
//                       null: there is no doubt
//   inverting     the deformers with inverted tets: the most in a frame, their share of the tets [%], and whether the
//                 method is excluded from `nearest` (is_excluded), because it has more than lbs by 0.5 % of the tets in
//                 more than a tenth of the frames
//   skin          distance of the skin from the reference on a body whose largest extent is 1.7 m, rms over the frames,
//                 under lbs (lbs_mm) and pbs (pbs_mm); the share of lbs's that pbs removes (removed_pct); null without
//                 a reference, and where lbs's is below 0.01 % of the body's diagonal
//   widest_frame  the frame in which the surfaces of pbs and lbs are farthest apart; null where they never differ
//   frame_ms      median time of a frame, per deformer
//   error_bar     of the reference: the number of frames in which its own error is bounded, of how many, the largest
//                 bound at the joints [%] and the wall time of the further solutions [s]; null without an error bar
//   reference_lag the largest angle between a bone and the flesh that it alone moves, in the reference
//                 (largest_turn_deg), the bone and the frame, and in how many of the compared frames 1 % of the body or
//                 more lag by more than 5 degrees (lagging_frames, frames); null without a reference, and where no bone
//                 moves a tet alone
//   reference_frames  what the budget of time allowed: frames of the motion, solved, kept (solved by an earlier trial),
//                     cpu_seconds, budget_s, contact, not_reached [{frame, cpu_seconds, bone that held it up}]; null
//                     without a budget
//   interrupted   whether the trial was interrupted and has only what was finished by then
//   from_artist   where the surface carried by the tets under lbs is farthest from the artist's: largest_pct of the
//                 model's size, frame, the bones of surface and flesh there, and the gap between them at rest; null:
//                 not compared
//   correctives   what `--bake` learned (bake.hpp); not there without it
//   control       the files of the surface by the format's own skinning; null: the model has no joints and so no
//                 skinning
// An InputError where the run's records are missing or damaged.
nlohmann::json trial_facts(const std::string& folder);

// The first two sentences of the summary, which the page shows first: the nearest method and the next one, and which
// methods turn tets inside out. Where the reference is doubtful, why, and what to do.
std::string nearest_sentence(const nlohmann::json& facts);

// The nearest method, then the joints, where bones are not stretched, since a warning says why the volume is not judged
// there, and the error of FEM itself where it was estimated. The last sentence is that for whoever decides: what PBS
// changes on this model, by how much, at what cost, and which frame to look at.
std::string trial_sentence(const nlohmann::json& facts);

// What was learned with --bake, in how many seconds, how near it is in the frames that were held out, and where it is.
// correctives: the facts of bake.hpp.
std::string bake_sentence(const nlohmann::json& correctives, const std::string& folder);

}  // namespace experiments
