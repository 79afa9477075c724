// Records: whole files or none, by pbs::write_atomically, and what killed writers left of them.
//   write_text_atomically("results/run.json", document.dump(2) + "\n");
#pragma once

#include <string>

namespace analysis {

// InputError with the system's reason where the folder is missing, cannot be written or is full; nothing is left behind then.
void write_text_atomically(const std::string& path, const std::string& text);

// To be asked before the work that a file is to hold: the same InputError where its folder or what lies in its place forbids it.
void require_writable(const std::string& path);

// Removes what writers that were killed left half-written in a folder, and in those below it: temporary files whose
// process is gone. A folder that is not there holds none.
void remove_abandoned_files(const std::string& folder, bool and_below = true);

// pbs::read_text_file: an InputError where the file cannot be read.
std::string read_text(const std::string& path);

}  // namespace analysis
