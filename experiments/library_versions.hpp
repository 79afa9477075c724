// The versions of the libraries a run was made with, for provenance.
#pragma once

#include <map>
#include <string>

namespace experiments {

std::map<std::string, std::string> library_versions();

}  // namespace experiments
