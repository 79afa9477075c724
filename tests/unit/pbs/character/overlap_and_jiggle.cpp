// Reference: a bar that is folded by hand so that its ends overlap.

#include "pbs/character/bodies.hpp"
#include "pbs/character/bone_capsules.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

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

// Reference: the built-in limb, whose skin is farther from the bones than the mean vertex, and a zone that consists of two known pieces.

TEST(JiggleZoneContents, OfTheLimbIsMostlySkinInOnePieceOnBothBones)
{
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 600});
    const auto zone = pbs::zone_contents(limb);
    const auto flags = pbs::jiggle_zone(limb.binding);
    EXPECT_DOUBLE_EQ(zone.share, double(std::count(flags.begin(), flags.end(), true)) / double(flags.size()));
    EXPECT_GT(zone.skin_share, 0.9);
    EXPECT_EQ(zone.pieces.size(), 1u);
    ASSERT_EQ(zone.bones.size(), 2u);
    EXPECT_DOUBLE_EQ(zone.bones[0].share_of_zone + zone.bones[1].share_of_zone, 1.0);
}

// Only the two ends of a bar are farther away than a prescribed distance.
TEST(JiggleZoneContents, TwoEndsAreTwoPiecesAndTogetherTheWholeZone)
{
    pbs::Character bar = test_support::character_of(test_support::two_bone_limb({10, 2, 2}, {0, 0, 1}, 0.0));
    for (Eigen::Index v = 0; v < bar.mesh.rest.rows(); ++v) bar.binding.distance(v) = std::abs(bar.mesh.rest(v, 0)) > 0.7 ? 1.0 : 0.0;
    const auto zone = pbs::zone_contents(bar);
    ASSERT_EQ(zone.pieces.size(), 2u);
    std::set<int> seen;
    for (const auto& piece : zone.pieces) seen.insert(piece.begin(), piece.end());
    EXPECT_EQ(seen.size(), zone.pieces[0].size() + zone.pieces[1].size());
    EXPECT_DOUBLE_EQ(zone.share, double(seen.size()) / double(bar.mesh.rest.rows()));
}

}  // namespace
