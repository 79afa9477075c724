// Reference: counts by hand on one tet.
#include "pbs/solver/xpbd_work.hpp"

#include <gtest/gtest.h>

namespace {

constexpr pbs::BodyCounts one_tet = {4.0, 6.0, 1.0};

TEST(XpbdWork, OnOneTet)
{
    const double bind = 3 + 6 + 1 + 3 + 6 + 6 + 7, stretch = 3 + 6 + 1 + 3 + 13 + 6 + 14, volume = 9 + 36 + 6 + 6 + 27 + 6 + 28;
    EXPECT_EQ(pbs::work_of_xpbd(one_tet, false).flops, 4 * bind + 6 * stretch);
    EXPECT_EQ(pbs::work_of_xpbd(one_tet, true).flops, 4 * bind + 6 * stretch + volume);
    EXPECT_EQ(pbs::work_of_xpbd(one_tet, true).bytes - pbs::work_of_xpbd(one_tet, false).bytes, (4 * 4 + 4 * 8) + 4 * 7 * 8);
}

}  // namespace
