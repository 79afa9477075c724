// What stands below the table of claims about the frames of a study's runs: where the reference intersects itself (no deformer has
// contact), errors that are not above the reference's own, and frames that broke, each deformer's first with its worst element.
//   fmt::print("{}", marked_frames(finished_runs(folder).folders));
#pragma once

#include <string>
#include <vector>

namespace experiments {

// Of the folders of runs that ended, from their run.json; InputError where one of them is none of ours.
std::string marked_frames(const std::vector<std::string>& folders);

}  // namespace experiments
