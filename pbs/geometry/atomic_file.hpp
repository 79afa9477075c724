// Whole files or none: bytes are written to a new file next to the target, .NAME.PROCESS.RANDOM, flushed to disk and renamed over it, so
// that a killed writer leaves no torn file.
//   write_atomically("results/run.json", document.dump(2) + "\n");
#pragma once

#include <string>

namespace pbs {

// An InputError where a device or a named pipe is there: renaming would leave a file in its place.
void require_no_device(const std::string& path);

// An InputError with the system's reason where the folder is missing, cannot be written or is full; nothing is left behind then. And as
// require_no_device.
void write_atomically(const std::string& path, const std::string& bytes);

}  // namespace pbs
