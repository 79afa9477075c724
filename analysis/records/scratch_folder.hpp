// A temporary folder for files that another program reads and writes. It is removed with this object.
//   const ScratchFolder folder;  write(folder / "deck.inp");
#pragma once

#include "pbs/geometry/input_error.hpp"

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

#include <stdlib.h>

namespace analysis {

class ScratchFolder {
public:
    ScratchFolder()
    {
        const std::filesystem::path parent = std::filesystem::temp_directory_path();
        std::string name = (parent / "pbskin_XXXXXX").string();
        if (!mkdtemp(name.data()))
            throw pbs::InputError(parent.string(), 0, "", "", "no folder can be made here: " + std::generic_category().message(errno));
        path_ = name;
    }
    ~ScratchFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace analysis
