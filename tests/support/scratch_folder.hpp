// A temporary folder of the test, which is removed with the object.
//   const test_support::ScratchFolder folder;  write(folder / "limb.msh");
#pragma once

#include "analysis/records/record_files.hpp"

#include <fstream>

namespace test_support {

class ScratchFolder : public analysis::ScratchFolder {
public:
    // Writes a file and returns its path.
    std::string file(const std::string& name, const std::string& text) const
    {
        std::ofstream(path() / name, std::ios::binary) << text;
        return *this / name;
    }
};

}  // namespace test_support
