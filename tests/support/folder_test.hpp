// A test with a temporary folder of its own. Suites of such tests get their names by aliases:
//   using WriteAtomically = test_support::FolderTest;
//   TEST_F(WriteAtomically, WritesAndReplaces) { write_atomically(folder / "limb.vtu", "new"); }
#pragma once

#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

namespace test_support {

class FolderTest : public testing::Test {
protected:
    const ScratchFolder folder;
};

}  // namespace test_support
