// Writes records as whole files or not at all, by pbs::write_atomically, and removes what killed writers left behind.
//   write_text_atomically("results/run.json", document.dump(2) + "\n");
#pragma once

#include <string>

namespace analysis {

// InputError with the system's reason if the folder is missing, cannot be written or is full; nothing is left behind in that case.
void write_text_atomically(const std::string& path, const std::string& text);

// Checks before long work whether the file can be written: the same InputError if its folder, or an existing entry in its place, forbids
// it.
void require_writable(const std::string& path);

// Removes the half-written files that killed writers left in a folder and in those below it: temporary files whose process no longer
// exists. A folder that does not exist holds none.
void remove_abandoned_files(const std::string& folder, bool and_below = true);

// pbs::read_text_file: InputError if the file cannot be read.
std::string read_text(const std::string& path);

}  // namespace analysis
