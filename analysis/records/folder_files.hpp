// What lies in a folder, listed and removed; where the system refuses, the file and its reason are told.
//   remove_record(folder / "run.json");  for (const fs::path& file : files_in(folder / "frames")) ...
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace analysis {

// Of an earlier run, so that it does not lie beside the next one's; one that is not there is removed already.
void remove_record(const std::filesystem::path& file);

// Of a file in a folder.
std::string path_in(const std::string& folder, const std::string& name);

// In no order.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder);

}  // namespace analysis
