// Reference: counts by hand on one tet.
#include "pbs/solver/xpbd_work.hpp"

#include <gtest/gtest.h>

namespace {

constexpr pbs::BodyCounts one_tet = {4.0, 6.0, 1.0};

TEST(XpbdWork, OnOneTet)
{
    const double bind = 3 + 6 + 1 + 3 + 6 + 6 + 7, stretch = 3 + 6 + 1 + 3 + 13 + 6 + 14, volume = 9 + 36 + 6 + 6 + 27 + 6 + 28;
    for (const double scalar : {4.0, 8.0}) {
        EXPECT_EQ(pbs::work_of_xpbd(one_tet, false, scalar).flops, 4 * bind + 6 * stretch);
        EXPECT_EQ(pbs::work_of_xpbd(one_tet, true, scalar).flops, 4 * bind + 6 * stretch + volume);
        EXPECT_EQ(pbs::work_of_xpbd(one_tet, true, scalar).bytes - pbs::work_of_xpbd(one_tet, false, scalar).bytes,
                  (4 * 4 + 4 * scalar) + 4 * 7 * scalar);
    }
}

}  // namespace
