// A clip as bytes, on its way from the process that reads it (pbs/geometry/child_process.hpp) to the one that retargets it.
#pragma once

#include "pbs/character/clip.hpp"

namespace pbs {

// The input of unpacked_clip; only for processes of this machine and version.
std::string packed(const Clip& clip);

// An InputError that names `path` where the bytes are no whole clip: at least one joint and frame, parents before their children, every
// number finite, rotations of unit length, a frame time that a motion can have.
Clip unpacked_clip(const std::string& bytes, const std::string& path);

}  // namespace pbs
