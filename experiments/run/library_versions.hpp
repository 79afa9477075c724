// Versions of the libraries that characters and frames were made with, for provenance; empty where the build left one out. The ruler's own
// are in analysis/records/provenance.hpp, the reference's in its record.
#pragma once

#include <map>
#include <string>

namespace experiments {

std::map<std::string, std::string> library_versions();

}  // namespace experiments
