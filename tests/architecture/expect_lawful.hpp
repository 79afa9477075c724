// How the architecture tests report violations: one per line. A law that accepts a planted violation proves nothing, so each test file also
// plants some.
#pragma once

#include "tests/architecture/source_tree.hpp"

#include <gtest/gtest.h>

namespace architecture {

inline void expect_lawful(Violations (*law)(const SourceTree&))
{
    const SourceTree tree = read_source_tree();
    ASSERT_TRUE(tree.contains("CMakeLists.txt")) << "the source tree was not found";
    std::string found;
    for (const std::string& violation : law(tree)) found += "\n" + violation;
    EXPECT_TRUE(found.empty()) << found;
}

// The law finds exactly one violation in the planted files, and its text contains `expected`.
inline void expect_found(Violations (*law)(const SourceTree&), const SourceTree& planted, const std::string& expected)
{
    const Violations violations = law(planted);
    ASSERT_EQ(violations.size(), 1u);
    EXPECT_NE(violations[0].find(expected), std::string::npos) << violations[0];
}

}  // namespace architecture
