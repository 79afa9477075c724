// Reference: a number that counts its operations, and counts by hand on one tet.
#include "pbs/skinning/skinning_work.hpp"

#include "tests/support/counted_number.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::BodyCounts;
using test_support::Counted;

// Three of four vertices have rows of two bones, the other one moves with a matrix.
TEST(SkinningWork, OfBlendsOnOneTet)
{
    const BodyCounts body = {4.0, 6.0, 1.0, {6.0, 3.0}};
    EXPECT_EQ(pbs::work_of_linear_blend(body, 4.0).flops, 6 * 24 + 4 * 18);
    EXPECT_EQ(pbs::work_of_dual_quaternion_blend(body, 4.0).flops, 6 * 16 + 3 * (8 + 18 + 27) + 18);
    EXPECT_EQ(pbs::work_of_linear_blend(body, 8.0).bytes, 4 * (3 * 8 + 3 * 8) + 6 * (4 + 8) + 4 * 4);
}

// Each of four vertices has three neighbours.
TEST(SkinningWork, OfDeltaMushesOnOneTet)
{
    const BodyCounts body = {4.0, 6.0, 1.0, {0.0, 0.0}};
    const double rotation = pbs::work_of_delta_mush(body, 4.0, 0).flops - 4 * 18 - 12 * 24 - 4 * (15 + 3);
    EXPECT_EQ(rotation, 4 * 691);
    EXPECT_EQ(pbs::work_of_delta_mush(body, 4.0, 5).flops - pbs::work_of_delta_mush(body, 4.0, 0).flops, 5 * (12 * 3 + 4 * 12));
    EXPECT_EQ(pbs::work_of_delta_mush(body, 4.0, 1).bytes - pbs::work_of_delta_mush(body, 4.0, 0).bytes, 12 * 4 + 4 * (4 + 4 + 2 * 16));
    const BodyCounts two_bones = {4.0, 6.0, 1.0, {8.0}};
    EXPECT_EQ(pbs::work_of_direct_mush(two_bones, 4.0).flops, 8 * (21 + 3 * 24 + 24) + 4 * (18 + 691 + 15 + 3));
}

TEST(SkinningWork, ARotationIsCountedByANumberThatCounts)
{
    pbs::rotation_formula::Matrix3<Counted> f = {{1.1, 0.2, 0.3, -0.1, 0.9, 0.2, 0.1, -0.2, 1.2}}, rotation;
    Counted::operations = 0;
    pbs::rotation_formula::nearest(f, Counted(1e-12), rotation);
    EXPECT_EQ(Counted::operations, 691);
}

}  // namespace
