// Reference: counts by hand on one tet.
#include "pbs/author/author_work.hpp"

#include <gtest/gtest.h>

namespace {

TEST(AuthorWork, OnOneTet)
{
    const pbs::IterationWork work = pbs::work_of_author({4.0, 6.0, 1.0});
    const double volume = 9 + 15 + 1 + 24 + 23 + 2 + 24, bind = 8 + 9 + 6 + 9 + 1 + 3 + 6, stretch = 3 + 6 + 1 + 6 + 6;
    EXPECT_EQ(work.flops, volume + 4 * bind + 6 * stretch);
    const double data = (4 * 4 + 8) + (4 + 6) * (2 * 4 + 8), vertices = 4 + 4 + 6 * 2;
    EXPECT_EQ(work.bytes, data + vertices * 2 * 24);
    EXPECT_EQ(work.working_set_bytes, data + 4 * 24);
}

}  // namespace
