// A temporary folder of the test, which is removed with the object.
//   const test_support::ScratchFolder folder;  write(folder / "limb.msh");
#pragma once

#include "analysis/records/record_files.hpp"

#include <gtest/gtest.h>

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

// A test with a temporary folder of its own. Suites of such tests get their names by aliases:
//   using WriteAtomically = test_support::FolderTest;
//   TEST_F(WriteAtomically, WritesAndReplaces) { write_atomically(folder / "limb.vtu", "new"); }
class FolderTest : public testing::Test {
protected:
    const ScratchFolder folder;
};

}  // namespace test_support
