// Reference: a bar that is folded by hand so that its ends overlap.
#include "pbs/character/overlap_mask.hpp"

#include "tests/support/bar_character.hpp"
#include "tests/support/wound_bar.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace {

const pbs::Character& bar()
{
    static const pbs::Character character = test_support::bar_character({24, 2, 2});
    return character;
}

TEST(OverlapMask, IsEmptyForABodyThatDoesNotOverlap)
{
    const std::vector<bool> mask = pbs::OverlapMask(bar()).of(bar().mesh.rest);
    EXPECT_EQ(std::count(mask.begin(), mask.end(), true), 0);
}

// The limb radius is the mean distance of the skin from the axis, at most 0.15 sqrt(2): farther than that from the overlap nothing is
// masked. At the axis of the overlapping ends everything is, for there is skin inside the other winding on one side.
TEST(OverlapMask, CoversWhatLiesInsideAnotherPartAndTheFleshWithinALimbRadius)
{
    const std::vector<bool> mask = pbs::OverlapMask(bar()).of(test_support::wound(bar().mesh.rest));
    const double overlap = std::numbers::pi / 2.0 - 1.0, limb_radius = 0.15 * std::numbers::sqrt2;
    for (Eigen::Index v = 0; v < bar().mesh.rest.rows(); ++v) {
        const pbs::Vec3 rest = bar().mesh.rest.row(v);
        const bool on_axis = rest.tail<2>().norm() < 1e-12;
        EXPECT_TRUE(mask[v] || !on_axis || std::abs(rest.x()) < 0.7) << rest.x();
        EXPECT_FALSE(mask[v] && std::abs(rest.x()) < overlap - limb_radius) << rest.x();
    }
}

}  // namespace
