// Which files a user means by frames: files, `frames_%04d.vtu`, `frames_*.vtu` (quoted), or a folder with one sequence.
//   for (const std::string& path : frame_files({"out/frames_%04d.vtu"})) ...
#pragma once

#include <string>
#include <vector>

namespace experiments {

// In the order of their numbers. InputError for a pattern or folder that has no frames, for a folder with several sequences, and for a
// number that is missing in a sequence: between its first and last, by its own smallest step (every fifth frame is no gap). Files that are
// named one by one are taken as they are.
std::vector<std::string> frame_files(const std::vector<std::string>& arguments);

}  // namespace experiments
