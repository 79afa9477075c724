// The lines above the table of claims about frames of a study's runs that need attention: frames in which the reference intersects itself
// (no deformer has contact), errors that are not above those of the reference, and frames that broke down, with the worst element of the
// first one.
//   fmt::print("{}", marked_frames(finished_runs(folder).folders));
#pragma once

#include <string>
#include <vector>

namespace experiments {

// Reads run.json in the folders of finished runs. InputError if such a file is not one that this program wrote.
std::string marked_frames(const std::vector<std::string>& folders);

}  // namespace experiments
