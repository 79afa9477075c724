// One run of a study in its folder: a scene or a piece of work, whole with run.json or not there.
#pragma once

#include "experiments/studies/study.hpp"

#include <string>

namespace experiments {

// The run in `folder` is of this scene or these settings and of this revision, and ended: nothing of it need be done again.
bool is_finished(const StudyRun& run, const std::string& folder);

// Carries it out; what broke down numerically, if anything.
std::string carry_out(const StudyRun& run, const std::string& folder);

// Of a finished run in `folder`: what carry_out returned then.
std::string breakdown_on_record(const StudyRun& run, const std::string& folder);

}  // namespace experiments
