// Whole files or none: text goes to a temporary file in the target's folder, is flushed to disk and renamed over the target, so that a
// killed run leaves no half-written record.
//   write_text_atomically("results/run.json", document.dump(2) + "\n");
#pragma once

#include <string>

namespace analysis {

// InputError with the system's reason where the folder is missing, cannot be written or is full; nothing is left behind then.
void write_text_atomically(const std::string& path, const std::string& text);

// InputError where the file cannot be read.
std::string read_text(const std::string& path);

}  // namespace analysis
