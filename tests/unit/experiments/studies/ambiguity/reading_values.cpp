// Reference: the studies' own functions, called directly, and what a reading cannot change.
#include "experiments/studies/ambiguity/reading_values.hpp"

#include "experiments/scene/scene.hpp"
#include "experiments/studies/momentum/momentum_drift.hpp"
#include "experiments/studies/shared/posed_character.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using analysis::Extent;
using experiments::JudgedValue;
using experiments::Reading;
using experiments::ReadingsCase;
using experiments::ReadingValues;

ReadingsCase small_limb()
{
    return {.scene = experiments::read_scene("limb_bend", {"character.vertices=400"}),
            .frame = 18,
            .pose = "bend_90",
            .jolt_direction = pbs::Vec3::UnitX(),
            .most_iterations = 60,
            .jolt_steps = 60,
            .timing_s = 0.05};
}

Reading own()
{
    return {.place = "",
            .name = "own",
            .baseline = "own",
            .options = experiments::options_of<pbs::PbsOptions>(experiments::spec_of(small_limb().scene, "pbs"))};
}

template <typename Change>
std::vector<Reading> own_and(const Change& change)
{
    std::vector<Reading> readings = {own(), own()};
    change(readings[1]);
    return readings;
}

const JudgedValue& value(const ReadingValues& read, const std::string& quantity)
{
    const auto found = std::find_if(read.values.begin(), read.values.end(), [&](const auto& one) { return one.quantity == quantity; });
    if (found == read.values.end()) throw std::runtime_error("no " + quantity);
    return *found;
}

int number_of(const ReadingValues& read, const std::string& quantity)
{
    return int(std::count_if(read.values.begin(), read.values.end(), [&](const auto& one) { return one.quantity == quantity; }));
}

TEST(ReadingValues, OfStartsAreThreeStartsByTwoTolerancesAtMost)
{
    const auto all = values_of_starts(small_limb(), own_and([](Reading& r) { r.options.k_stretch = 0.9; }));
    ASSERT_EQ(all.size(), 2u);
    EXPECT_GE(all[0].values.size(), 3u);
    EXPECT_LE(all[0].values.size(), 6u);
    for (const JudgedValue& one : all[0].values) EXPECT_EQ(one.claim, "C03");
    EXPECT_EQ(all[0].values[0].of, all[1].values[0].of);
    ASSERT_EQ(all[0].left_out.size(), 1u);
    EXPECT_EQ(all[0].left_out[0].claim, "C12");
    EXPECT_EQ(all[0].left_out[0].reason, "judged on characters alone");
}

TEST(ReadingValues, OfProjectionsAreTheMomentumStudysDrifts)
{
    const auto all = values_of_projections(small_limb(), own_and([](Reading& r) { r.options.masses = pbs::Masses::lumped; }));
    const ReadingsCase of = small_limb();
    const pbs::Character character = pbs::make_character(of.scene.character);
    const pbs::Pose pose = experiments::make_motion(of.scene.motion, character.skeleton, of.scene.file).steps.at(18);
    const auto drift =
        experiments::drift_of_projections(character, pose, own().options, experiments::ProjectedClass::stretch, pbs::Masses::unit);
    EXPECT_EQ(value(all[0], "linear_drift").value, drift.linear);
    EXPECT_EQ(value(all[0], "angular_drift").value, drift.angular);
    EXPECT_NE(value(all[1], "linear_drift_of_a_pass").value, value(all[0], "linear_drift_of_a_pass").value);
    EXPECT_EQ(value(all[1], "linear_drift_of_a_pass").extent, Extent::whole);  // the projection takes these masses into account
}

// In Algorithm 1 the next position depends on the last two alone, whatever the step, so half the step swings twice as fast, exactly.
TEST(ReadingValues, OfJoltsHaveTheSameDampingInSubstepsThatAreTheSameSteps)
{
    const auto all = values_of_jolts(small_limb(), own_and([](Reading& r) { r.substeps = 2; }));
    EXPECT_EQ(value(all[0], "frequency_ratio_at_half_time_step").value, 2.0);
    // The series is the same one with twice the samples. The fit uses those until 2 % of the largest excursion remain, so that the later
    // ones change the value at rest, and by it the ratio, by less than 2 %. Frequencies or decays by another step's time would double or
    // halve it.
    const double ratio = value(all[0], "damping_ratio").value;
    EXPECT_NEAR(value(all[1], "damping_ratio").value, ratio, 0.02 * ratio);
}

// LBS moves the flesh by the jolt beforehand, and a body that moves as a whole violates no constraint.
TEST(ReadingValues, OfAJoltThatCarriesTheFleshAlongHaveNoSwing)
{
    const auto all = values_of_jolts(small_limb(), own_and([](Reading& r) { r.options.lbs_entry = pbs::LbsEntry::increment; }));
    EXPECT_EQ(number_of(all[0], "damping_ratio"), 4);  // one per setting
    EXPECT_TRUE(all[1].values.empty());
    EXPECT_FALSE(all[1].broke_down);
}

// C09's bounds on these quantities are for the study's 16 settings.
TEST(ReadingValues, OfJoltsLeaveOutWhatIsOfAllSettingsOfTheStudy)
{
    const auto all = values_of_jolts(small_limb(), {own()});
    std::vector<std::string> left_out;
    for (const auto& one : all[0].left_out) {
        left_out.push_back(one.quantity);
        EXPECT_EQ(one.claim, "C09");
        EXPECT_EQ(one.reason, "the bound is for the study's 16 settings, a reading is jolted at 4");
        EXPECT_EQ(number_of(all[0], one.quantity), 0);
    }
    EXPECT_EQ(left_out, (std::vector<std::string>{"share_of_settings_that_swing", "rank_correlation_of_frequency_and_k_stretch",
                                                  "frequency_ratio_over_k_stretch"}));
    EXPECT_EQ(number_of(all[0], "frequency_ratio_at_half_time_step"), 1);
    EXPECT_EQ(number_of(all[0], "frequency_ratio_at_twice_iterations"), 1);
}

TEST(ReadingValues, OfFramesAreOneTimeAReading)
{
    const auto all = values_of_frames(small_limb(), own_and([](Reading& r) { r.substeps = 4; }));
    ASSERT_EQ(all.size(), 2u);
    for (const ReadingValues& read : all) {
        ASSERT_EQ(read.values.size(), 1u);
        EXPECT_EQ(read.values[0].quantity, "processor_time_of_a_frame_ms");
        EXPECT_EQ(read.values[0].unit, "ms");
        EXPECT_GT(read.values[0].value, 0.0);
        EXPECT_FALSE(read.broke_down);
    }
}

// Gravity acts only on integrated particles. If all are integrated, an infinite weight leaves nothing finite; if none is, it has no effect.
TEST(ReadingValues, OfFramesTellABreakdown)
{
    const auto all = values_of_frames(small_limb(), own_and([](Reading& r) {
                                          r.options.lbs_entry = pbs::LbsEntry::increment;
                                          r.options.gravity_m_s2 = pbs::Vec3(0.0, -std::numeric_limits<double>::infinity(), 0.0);
                                      }));
    EXPECT_FALSE(all[0].broke_down);
    EXPECT_TRUE(all[1].broke_down);
}

}  // namespace
