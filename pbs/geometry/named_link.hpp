// Another name for a file, for libraries that choose their reader by the extension. A link in a new folder for temporary files, which is
// removed with the object.
//   const NamedLink link("arm.txt", ".mesh");
//   read(link.path());   // .../arm.txt.mesh
#pragma once

#include <string>

namespace pbs {

class NamedLink {
public:
    // An InputError that asks for the file to be renamed if no link can be made.
    NamedLink(const std::string& path, const std::string& extension);
    ~NamedLink();
    NamedLink(const NamedLink&) = delete;
    NamedLink& operator=(const NamedLink&) = delete;

    const std::string& path() const { return link_; }  // the file's own path if it has that extension, in small or capital letters

private:
    std::string folder_, link_;
};

}  // namespace pbs
