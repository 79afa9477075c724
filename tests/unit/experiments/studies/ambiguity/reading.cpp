// Reference: a reading belongs to a place and differs from its baseline, which comes before it.
#include "experiments/studies/ambiguity/reading.hpp"

#include <gtest/gtest.h>

#include <set>

namespace {

using experiments::Reading;

// All that its motion depends on, without its names.
nlohmann::json all_of(const Reading& reading)
{
    nlohmann::json settings = experiments::to_json(reading);
    for (const char* name : {"place", "name", "baseline"}) settings.erase(name);
    return settings;
}

void expect_readings(const std::vector<Reading>& readings)
{
    std::set<std::string> names;
    const Reading* baseline = nullptr;
    for (const Reading& reading : readings) {
        EXPECT_TRUE(names.insert(reading.name).second) << reading.name;
        if (reading.place.empty()) {
            baseline = &reading;
            continue;
        }
        ASSERT_NE(baseline, nullptr);
        EXPECT_EQ(reading.baseline, baseline->name);
        EXPECT_NE(all_of(reading), all_of(*baseline)) << reading.name;
    }
}

pbs::PbsOptions falling()
{
    pbs::PbsOptions options;
    options.gravity_m_s2 = {0, -9.81, 0};
    return options;
}

TEST(Readings, OfAStepDifferFromTheirBaseline)
{
    expect_readings(experiments::readings_of_a_step(falling()));
}

TEST(Readings, OfMotionDifferFromTheirBaseline)
{
    expect_readings(experiments::readings_of_motion(falling()));
}

TEST(Readings, OfAStepRememberNothing)
{
    for (const Reading& reading : experiments::readings_of_a_step(falling())) {
        EXPECT_FALSE(reading.options.jiggle.has_value()) << reading.name;
        EXPECT_EQ(reading.options.lbs_entry, pbs::LbsEntry::start) << reading.name;
    }
}

}  // namespace
