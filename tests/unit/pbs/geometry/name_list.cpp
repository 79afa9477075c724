// Reference: the specification in name_list.hpp.
#include "pbs/geometry/name_list.hpp"

#include <gtest/gtest.h>

namespace {

TEST(NameList, HasAtMostSixNames)
{
    EXPECT_EQ(pbs::name_list({}), "");
    EXPECT_EQ(pbs::name_list({"a"}), "a");
    EXPECT_EQ(pbs::name_list({"a", "b", "c", "d", "e", "f"}), "a, b, c, d, e, f");
    EXPECT_EQ(pbs::name_list({"a", "b", "c", "d", "e", "f", "g", "h"}), "a, b, c, d, e, f and 2 others");
}

}  // namespace
