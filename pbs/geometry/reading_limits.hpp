// The resources that a process may use to read one file (isolated_reader.hpp): far more than a sound file needs, and no more than half of
// the memory that there is.
#pragma once

#include <string>

namespace pbs {

// [s] of time, not of processor time: other work may keep the machine busy.
double reading_limit_s(const std::string& path);

// Limits this process from here on: memory, processor time and no core file. Memory is not limited under a sanitizer.
void limit_reading(const std::string& path);

}  // namespace pbs
