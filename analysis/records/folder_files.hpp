// Lists and removes the files of a folder. Where the system refuses, the error names the file and the reason.
//   remove_record(folder / "run.json");  for (const fs::path& file : files_in(folder / "frames")) ...
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace analysis {

// Removes a file of an earlier run, so that it does not remain next to the files of the next one; a missing file is no error.
void remove_record(const std::filesystem::path& file);

// The path of a file in a folder.
std::string path_in(const std::string& folder, const std::string& name);

// The files of a folder, in no particular order.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder);

}  // namespace analysis
