// One run of a study in its folder: a scene or a piece of work. With run.json it is finished.
#pragma once

#include "experiments/studies/study.hpp"

#include <string>

namespace experiments {

// True if the run in `folder` finished with this scene or these settings and this revision, so that it need not be repeated.
bool is_finished(const StudyRun& run, const std::string& folder);

// Does the run and returns what broke down numerically, or "".
std::string carry_out(const StudyRun& run, const std::string& folder);

// The text that carry_out returned for the finished run in `folder`.
std::string breakdown_on_record(const StudyRun& run, const std::string& folder);

}  // namespace experiments
