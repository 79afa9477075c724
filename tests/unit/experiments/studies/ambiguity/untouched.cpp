// Reference: how each claim's values are measured (reading_values.hpp).
#include "experiments/studies/ambiguity/reading.hpp"

#include <gtest/gtest.h>

namespace {

using experiments::Reading;
using experiments::untouched_because;

Reading own()
{
    return {.place = "", .name = "own", .baseline = "own", .options = {}};
}

Reading jiggling()
{
    Reading reading = own();
    reading.options.jiggle = pbs::Jiggle{.k_stretch = 0.9};
    return reading;
}

template <typename Change>
bool touches(const std::string& claim, const Reading& baseline, const Change& change)
{
    Reading reading = baseline;
    reading.place = "a place";
    reading.name = "B";
    change(reading);
    return untouched_because(claim, reading, baseline).empty();
}

TEST(Untouched, IsWhatDoesNotDifferFromItsBaseline)
{
    for (const char* claim : {"C01", "C03", "C04", "C07", "C09", "C10"}) EXPECT_FALSE(touches(claim, own(), [](Reading&) {}));
}

TEST(Untouched, IsLbsByWhatTheSolverAloneIsTold)
{
    EXPECT_FALSE(touches("C01", own(), [](Reading& r) { r.options.k_stretch = 0.9; }));
    EXPECT_TRUE(touches("C02", own(), [](Reading& r) { r.options.k_stretch = 0.9; }));
    EXPECT_TRUE(touches("C01", own(), [](Reading& r) { r.blended_bones = experiments::BlendedBones::either_end; }));
}

TEST(Untouched, IsMomentumByBindAndByTheOrderOfClasses)
{
    EXPECT_FALSE(touches("C07", own(), [](Reading& r) { r.options.k_bind = 0.5; }));
    EXPECT_FALSE(touches("C07", own(), [](Reading& r) { r.options.class_order = pbs::ClassOrder::volume_bind_stretch; }));
    EXPECT_TRUE(touches("C07", own(), [](Reading& r) { r.options.masses = pbs::Masses::lumped; }));
    EXPECT_TRUE(touches("C07", own(), [](Reading& r) { r.blended_bones = experiments::BlendedBones::either_end; }));
}

TEST(Untouched, AreSectionsAndStartsWhereSomethingJiggles)
{
    const auto by_bone = [](Reading& r) { r.zone_mean = experiments::ZoneMean::of_bone; };
    for (const char* claim : {"C03", "C12", "C04", "C05"}) EXPECT_FALSE(touches(claim, jiggling(), by_bone));
    EXPECT_TRUE(touches("C09", jiggling(), by_bone));
    const auto increment = [](Reading& r) { r.options.lbs_entry = pbs::LbsEntry::increment; };
    EXPECT_FALSE(touches("C03", own(), increment));
    EXPECT_TRUE(touches("C04", own(), increment));
}

TEST(Untouched, IsTheJoltByGravityAndByWhatTurningBonesAloneMake)
{
    EXPECT_FALSE(touches("C09", jiggling(), [](Reading& r) { r.options.gravity_m_s2 = {0, 1, 0}; }));
    EXPECT_FALSE(touches("C09", own(), [](Reading& r) { r.bind_point = experiments::BindPoint::reprojected; }));
    EXPECT_TRUE(touches("C09", jiggling(), [](Reading& r) { r.substeps = 2; }));
}

// A stiffness of zero leaves a class out, which is less work.
TEST(Untouched, IsTheTimeOfAFrameByFactorsOtherThanZero)
{
    EXPECT_FALSE(touches("C10", own(), [](Reading& r) { r.options.k_stretch = 0.9; }));
    EXPECT_FALSE(touches("C10", jiggling(), [](Reading& r) { r.options.jiggle->k_stretch = 0.6; }));
    EXPECT_TRUE(touches("C10", jiggling(), [](Reading& r) { r.options.jiggle->k_bind = 0.0; }));
    EXPECT_TRUE(touches("C10", jiggling(), [](Reading& r) { r.substeps = 2; }));
}

}  // namespace
