// Reference: the jiggle zone as the paper defines it: vertices farther from the nearest bone than the mean over all vertices (Sec. 4).
#include "pbs/character/character.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

std::vector<bool> zone_of(const std::vector<double>& distances)
{
    BoneBinding binding;
    binding.distance = Eigen::Map<const Eigen::VectorXd>(distances.data(), static_cast<Eigen::Index>(distances.size()));
    return jiggle_zone(binding);
}

TEST(JiggleZone, IsFartherThanTheMean)
{
    EXPECT_EQ(zone_of({1.0, 2.0, 3.0, 10.0}), (std::vector<bool>{false, false, false, true}));
}

TEST(JiggleZone, AtTheMeanIsOutside)
{
    EXPECT_EQ(zone_of({1.0, 2.0, 3.0}), (std::vector<bool>{false, false, true}));
}

TEST(JiggleZone, EqualDistancesHaveNone)
{
    EXPECT_EQ(zone_of({0.25, 0.25}), (std::vector<bool>{false, false}));
}

TEST(JiggleZone, NoVerticesNoZone)
{
    EXPECT_TRUE(zone_of({}).empty());
}

// Bone 0 has the mean 2, bone 1 the mean 15; the mean over all vertices would be 8.5.
TEST(JiggleZoneByBone, IsFartherThanTheMeanOfItsOwnBone)
{
    BoneBinding binding;
    binding.bone = {0, 1, 0, 1};
    binding.distance = Eigen::Vector4d(1.0, 10.0, 3.0, 20.0);
    EXPECT_EQ(jiggle_zone_by_bone(binding), (std::vector<bool>{false, false, true, true}));
    EXPECT_EQ(jiggle_zone(binding), (std::vector<bool>{false, true, false, true}));
    EXPECT_TRUE(jiggle_zone_by_bone({}).empty());
}

}  // namespace
