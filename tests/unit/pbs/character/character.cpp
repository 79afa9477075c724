// Truth: the jiggle zone as the paper defines it: farther from the nearest bone than the mean over all vertices (Sec. 4).
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

}  // namespace
