// The poses in which references are solved and methods are compared (cases.toml).
//   for (const ReferencePose& pose : reference_poses()) ...
#pragma once

#include "analysis/verdicts/case_record.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/settings/option_names.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "experiments/studies/study.hpp"

#include <string>
#include <vector>

namespace experiments {

// training: the poses on which the settings of methods are chosen. movement: ends of joints' ranges of motion, on which
// methods are compared. fold: deep folds, which are compared by themselves. played: frames of clips.
enum class Stratum { training, movement, fold, played };
NAMED_OPTIONS(Stratum, training, movement, fold, played)

struct ReferencePose {
    std::string name;
    analysis::CaseKey of;  // body, motion, and the pose or the angle
    Stratum stratum = Stratum::movement;
    Scene scene = {};  // its character and motion
    int frame = 0;     // of its motion
};

nlohmann::json to_json(const ReferencePose& pose);

// The pose of a case of cases.toml. InputError as read_scene.
ReferencePose reference_pose(const StudyCase& in_file);

// The members of the family that a pose is solved with: all, or on played frames two that differ much.
bool is_played(const EnsembleMember& member);
std::vector<EnsembleMember> members_of(Stratum stratum);

// The poses of all installed bodies.
std::vector<ReferencePose> reference_poses();

// The transforms of the bones in the pose, of a character of the scene.
pbs::Pose bones_in(const ReferencePose& pose, const pbs::Skeleton& skeleton);

}  // namespace experiments
