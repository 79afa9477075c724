// Reference: the built-in limb, whose skin is farther from the bones than the mean vertex, and a zone that consists of two known pieces.
#include "pbs/character/jiggle_zone_contents.hpp"

#include "pbs/character/bodies.hpp"
#include "tests/support/limb_character.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace {

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
