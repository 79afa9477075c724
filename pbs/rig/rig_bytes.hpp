// A rig as bytes, for the child process that reads it and its parent (child_process.hpp).
#pragma once

#include "pbs/rig/rig.hpp"

namespace pbs {

std::string packed(const Rig& rig);

// The rig of those bytes with every index and number checked, since damage may have led the child astray. An InputError names `path`.
Rig unpacked_rig(const std::string& bytes, const std::string& path);

}  // namespace pbs
