// Deformers of the user's own in the comparison: the [[external]] tables of a file, which is written like a scene.
//   of.external = external_entries("mine.toml");
// An entry has no ladder of iterations, no grid of settings and one code, so that it is one point per pose, on the case's own mesh.
#pragma once

#include "experiments/deformers/deformer.hpp"

#include <string>
#include <vector>

namespace experiments {

// Throws an InputError for a file that cannot be read, has no such table or other tables, a name that is that of a compared deformer or
// used twice, a program that cannot be started, and a library that cannot be loaded. Paths are relative to the file. Libraries are loaded
// in another process.
std::vector<DeformerSpec> external_entries(const std::string& file);

}  // namespace experiments
