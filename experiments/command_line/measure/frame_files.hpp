// Which files a user means by frames: files, `frames_%04d.vtu`, `frames_*.vtu` (quoted), or a folder with one sequence.
//   for (const std::string& path : frame_files({"out/frames_%04d.vtu"})) ...
#pragma once

#include <string>
#include <vector>

namespace experiments {

// In the order of their numbers: that of %d, or the one that differs between names (frame_7_v2.vtu, frame_8_v2.vtu). InputError for a
// pattern or folder that has no frames, for names that differ in several numbers, for a folder with several sequences, and for a number
// that is missing in a sequence: between its first and last, by its own smallest step (every fifth frame is no gap). Files that are named
// one by one are taken as they are.
std::vector<std::string> frame_files(const std::vector<std::string>& arguments);

// What reports call them: the file's name, or the path as it is where a name is there twice.
std::vector<std::string> frame_names(const std::vector<std::string>& paths);

}  // namespace experiments
