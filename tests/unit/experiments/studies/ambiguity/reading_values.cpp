// Reference: the studies' own functions, called directly, and what a reading cannot change.

#include "experiments/scene/scene.hpp"
#include "experiments/studies/ambiguity/reading_values.hpp"
#include "experiments/studies/momentum/momentum_drift.hpp"
#include "experiments/studies/shared/posed_character.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

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

// Reference: C04 has two values per pose and joint, the smallest radius and the smallest area, and a shape that is not finite has none.

experiments::ArtefactCase twisted()
{
    experiments::ArtefactCase of;
    of.scene = experiments::read_scene("limb_twist", {"character.vertices=400", R"(deformers.use=["lbs","pbs"])", R"(reference.name="")",
                                                      "motion.angle_deg=90", "motion.frames=3"});
    of.claim = experiments::ArtefactCase::Claim::candy_wrapper;
    of.poses = {{1, "twist_45_deg"}, {2, "twist_90_deg"}};
    return of;
}

TEST(ReadingSections, AreTwoFiguresAPoseThatTheReadingChanges)
{
    Reading either = own();
    either.blended_bones = experiments::BlendedBones::either_end;
    const auto all = values_of_sections(twisted(), {own(), either});
    ASSERT_EQ(all[0].values.size(), 4u);
    ASSERT_EQ(all[1].values.size(), 4u);
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(all[0].values[i].claim, "C04");
        EXPECT_EQ(all[0].values[i].of, all[1].values[i].of);
        EXPECT_NE(all[0].values[i].value, all[1].values[i].value);
    }
}

TEST(ReadingSections, OfAReadingThatBreaksDownAreNone)
{
    Reading falling = own();
    falling.options.jiggle = pbs::Jiggle{};
    falling.options.gravity_m_s2.y() = -std::numeric_limits<double>::infinity();
    const auto all = values_of_sections(twisted(), {own(), falling});
    EXPECT_FALSE(all[0].broke_down);
    EXPECT_TRUE(all[1].broke_down);
    EXPECT_TRUE(all[1].values.empty());
}

// Reference: the definitions of the values, and the claims' own rules for whether a verdict changes.

using experiments::ReadMotion;
using experiments::VolumeChange;

// A clip of 100 frames with one vertex at x [m].
ReadMotion motion_of(double change_pct, double x)
{
    ReadMotion moved;
    for (auto* record : {&moved.pbs, &moved.lbs}) {
        record->scene = "walk";
        for (int frame = 0; frame < 100; ++frame) {
            record->frame.push_back(frame);
            record->time_s.push_back(0.2 * frame);
            record->volume_change_pct.push_back(change_pct);
            record->volume_abs_change_pct.push_back(2.0 * std::abs(change_pct));
            record->inverted_tets.push_back(0.0);
        }
    }
    moved.pbs.deformer = "pbs";
    moved.pbs.iterations = 24;
    moved.lbs.deformer = "lbs";
    for (int frame = 0; frame < 100; ++frame) moved.shapes.push_back((pbs::Positions(1, 3) << x, 0, 0).finished());
    return moved;
}

std::vector<VolumeChange> compared(const ReadMotion& a, const ReadMotion& b)
{
    return experiments::volume_changes("walk", Reading{.place = "Eq. 2", .name = "B", .baseline = "A", .options = {}}, a, b, a, {});
}

const VolumeChange& value(const std::vector<VolumeChange>& rows, const std::string& name)
{
    const auto found = std::ranges::find(rows, name, &VolumeChange::quantity);
    if (found == rows.end()) throw std::runtime_error("no " + name);
    return *found;
}

TEST(VolumeChanges, HaveTheValuesOfBothAndTheirChange)
{
    const auto rows = compared(motion_of(-0.25, 0.0), motion_of(-0.75, 0.5));
    EXPECT_EQ(value(rows, "mean_volume_change_pct").a, -0.25);
    EXPECT_EQ(value(rows, "mean_volume_change_pct").b, -0.75);
    EXPECT_EQ(value(rows, "mean_volume_change_pct").change, -0.5);
    EXPECT_EQ(value(rows, "mean_volume_abs_change_pct").b, 1.5);
    EXPECT_EQ(value(rows, "share_of_frames_within_printed").a, 1.0);
    EXPECT_EQ(value(rows, "share_of_frames_within_printed").b, 0.0);
    EXPECT_EQ(value(rows, "distance_of_b_from_a_rms_m").b, 0.5);
}

TEST(VolumeChanges, StateWhereAVerdictChangesAndWhereNot)
{
    const auto verdict = [](double a, double b) { return compared(motion_of(a, 0.0), motion_of(b, 0.0)).front().verdict_changed; };
    EXPECT_EQ(verdict(-0.25, -0.75).substr(0, 41), "C02 by volume_change_pct: whole -> none; ");
    EXPECT_EQ(verdict(-0.1, -0.2), "no");
    EXPECT_EQ(verdict(-11.0, -14.0).substr(0, 22), "C01 by volume_loss_pct");
}

}  // namespace
