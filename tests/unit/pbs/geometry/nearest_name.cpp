// Reference: edit distances counted by hand.
#include "pbs/geometry/nearest_name.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::nearest_name;

TEST(NearestName, TakesTheLeastEditDistanceAndTheFirstOfEquals)
{
    EXPECT_EQ(nearest_name("tial_m", {"head_m", "tail_m", "name"}), "tail_m");
    EXPECT_EQ(nearest_name("nam", {"head_m", "tail_m", "name"}), "name");
    EXPECT_EQ(nearest_name("", {"abc", "ab", "cd"}), "ab");
    EXPECT_EQ(nearest_name("iteration", {"iterations", "precision", "order"}), "iterations");
    EXPECT_EQ(nearest_name("k_volum", {"k_stretch", "k_volume", "k_bind"}), "k_volume");
}

TEST(NearestName, ANameOfMegabytesTakesNoTime)
{
    std::string endless;
    for (int i = 0; i < 2'000'000; ++i) endless += "elbow";
    // a comparison letter by letter would take half an hour
    EXPECT_EQ(nearest_name(endless, std::vector<std::string>(1000, "shoulder")), "shoulder");
    EXPECT_EQ(nearest_name(endless, {"shoulder", "elbow", "wrist"}), "elbow");
}

TEST(NearestName, IsEmptyWhereNoneIsKnown)
{
    EXPECT_EQ(nearest_name("anything", {}), "");
}

}  // namespace
