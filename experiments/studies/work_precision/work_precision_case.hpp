// A case of the study: one body in one pose, and the extent to which it is measured.
//   WorkPrecisionCase of;
//   of.scene = read_scene("limb_twist", {"motion.angle_deg=90", "motion.frames=19"});
//   of.frame = 18;
#pragma once

#include "experiments/studies/shared/timed_rounds.hpp"
#include "experiments/studies/work_precision/point_row.hpp"

namespace experiments {

struct WorkPrecisionCase {
    analysis::CaseKey of;  // body, motion, and the pose or the angle
    Scene scene;           // its character and motion
    int frame = 0;         // of its motion; a timed frame begins in the one before it
    Half half = Half::evaluation;
    SettingRange range;
    Rounds rounds, newton_rounds;      // newton_rounds: of the nonlinear laws, which take seconds per frame; a failed round is dropped
    bool reference_is_refined = true;  // solved on tets cut into eight too, without which there is no bound
    std::vector<EnsembleMember> members = {};  // further references of the family
    int converged_iterations = 8000;           // of PBS for the parts of its error; 0: no parts
    double longest_frame_ms = 300.0;           // of a ladder of iterations
    std::vector<DeformerSpec> external = {};  // deformers of the user's own (external_entries.hpp); they are measured first
};

nlohmann::json to_json(const WorkPrecisionCase& of);  // everything that a run of the study depends on

}  // namespace experiments
