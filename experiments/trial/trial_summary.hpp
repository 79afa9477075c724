// The results of a trial, computed from the records of its run.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace experiments {

// The facts of try.json: the model as the run read it (joints, dropped joints with reasons, containers, bind pose, unit, weights), the
// motion with its matched joints, the run's warnings, and
//   volume        per deformer the lowest and highest change of the volume over the frames [%], and the most inverted tets in a frame
//   joints        the two joints at which lbs loses most volume, with the mean change there of lbs and pbs [% of the joints' volume]
//   nearer        number of frames in which pbs is nearer to the reference than lbs, of how many that can be compared
//   frame_ms      median time of a frame, per deformer
// An InputError where the run's records are missing or damaged.
nlohmann::json trial_facts(const std::string& folder);

// One sentence per fact that the records hold.
std::string trial_sentence(const nlohmann::json& facts);

}  // namespace experiments
