// The files that a user means by frames: files, `frames_%04d.vtu`, `frames_*.vtu` (quoted), or a folder with one sequence.
//   for (const std::string& path : frame_files({"out/frames_%04d.vtu"})) ...
#pragma once

#include <string>
#include <vector>

namespace experiments {

// The files in the order of their numbers. The number is the one in place of %d, or the one that differs between the names
// (frame_7_v2.vtu, frame_8_v2.vtu). Files that are named one by one are taken as they are. InputError:
// - for a pattern or a folder that has no frames,
// - for names that differ in several numbers,
// - for a folder with several sequences,
// - for a number that is missing between the first and the last of a sequence, by its own smallest step: every fifth frame is no gap.
std::vector<std::string> frame_files(const std::vector<std::string>& arguments);

// The names of the frames in reports: the file's name, or its path as given if several files have that name.
std::vector<std::string> frame_names(const std::vector<std::string>& paths);

}  // namespace experiments
