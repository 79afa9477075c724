// Reference: the solver, LBS and the metrics, called directly; the definitions of the values and the claims' own rules.

#include "experiments/studies/ambiguity/moved_readings.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "experiments/studies/shared/posed_character.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/bar_character.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace {

using analysis::Extent;
using experiments::Overrides;
using experiments::Reading;
using experiments::ReadMotion;
using experiments::VolumeChange;

const test_support::TwoBoneLimb limb = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0);
const pbs::Character character = test_support::character_of(limb);

ReadMotion bending(const pbs::Character& character, const Overrides& overrides, int frames = 4)
{
    Overrides all = {"motion.angle_deg=60", "motion.frames=" + std::to_string(frames), "motion.axis=[0,0,1]", "pbs.k_stretch=0.2"};
    all.insert(all.end(), overrides.begin(), overrides.end());
    return experiments::move(character, experiments::read_scene("limb_bend", all));
}

TEST(ReadMotion, OfTheScenesOwnReadingIsTheSolvers)
{
    const ReadMotion moved = bending(character, {});
    ASSERT_EQ(moved.shapes.size(), 4u);
    const pbs::Pose pose = pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitZ(), 60.0, 4, 0.01).steps[2];
    pbs::Positions lbs;
    pbs::BlendSkinning<double>(limb.mesh.rest, limb.weights).linear(pose, lbs);
    pbs::PbsSolver solver(limb.mesh, limb.binding.distance, {}, {});
    solver.advance(lbs, pbs::posed_bind_points(limb.binding, pose), 0.01);
    EXPECT_EQ(moved.shapes[2], solver.positions());
    const analysis::MeshMetrics mesh_metrics(limb.mesh.rest, limb.mesh.tets);
    EXPECT_EQ(moved.pbs.volume_change_pct[2], mesh_metrics.measure(solver.positions()).volume_change_pct);
    EXPECT_EQ(moved.lbs.volume_change_pct[2], mesh_metrics.measure(lbs).volume_change_pct);
    EXPECT_EQ(moved.pbs.angle_deg, (std::vector<double>{0.0, 20.0, 40.0, 60.0}));
    EXPECT_TRUE(moved.finite);
}

TEST(ReadMotion, ByIncrementDependsOnThePathAndByStartDoesNot)
{
    const Overrides increment = {"pbs.variant.lbs_entry=increment"};
    EXPECT_EQ(bending(character, {}).shapes.back(), bending(character, {}, 2).shapes.back());
    EXPECT_NE(bending(character, increment).shapes.back(), bending(character, increment, 2).shapes.back());
}

// The bones touch only in the middle, so near the outer ends either_end blends where nearest_end does not.
TEST(ReadMotion, EitherEndMovesWhatEqTwoLeavesToOneBone)
{
    const pbs::Character other = experiments::reweighted(character, experiments::read_scene("limb_bend", {"skinning.weights=either_end"}));
    const ReadMotion nearest = bending(character, {}), either = bending(other, {});
    EXPECT_EQ(nearest.lbs.volume_change_pct[0], either.lbs.volume_change_pct[0]);  // at rest
    EXPECT_NE(nearest.lbs.volume_change_pct[3], either.lbs.volume_change_pct[3]);
    EXPECT_EQ(experiments::reweighted(character, experiments::read_scene("limb_bend", {})).weights.weight, character.weights.weight);
}

TEST(ReadMotion, BindPointsAndTheZoneAreThoseOfTheOptions)
{
    EXPECT_NE(bending(character, {"pbs.variant.bind_point=reprojected"}).shapes[3], bending(character, {}).shapes[3]);
    const Overrides falling = {"pbs.jiggle.zone_mean=of_bone", "pbs.gravity_m_s2=[0,-9.81,0]"};
    const ReadMotion moved = bending(character, falling, 2);
    pbs::PbsOptions options;
    options.jiggle = pbs::Jiggle{};
    options.gravity_m_s2 = {0.0, -9.81, 0.0};
    pbs::PbsSolver solver(limb.mesh, limb.binding.distance, pbs::jiggle_zone_by_bone(limb.binding), options);
    solver.advance(limb.mesh.rest, limb.binding.rest_point, 0.01);
    EXPECT_EQ(moved.shapes.at(0), solver.positions());
}

// The definitions of the values of volume.

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
    return experiments::volume_changes("walk", Reading{.place = "Eq. 2", .name = "B", .baseline = "A"}, a, b, a, {});
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

TEST(JudgedValue, OfVolumeIsTheMeanOfC01AndTheShareOfC02)
{
    const auto values = judged(motion_of(-14.0, 0.0));
    ASSERT_EQ(values.size(), 4u);
    EXPECT_EQ(values[0].quantity, "mean_volume_loss_pct");
    EXPECT_EQ(values[0].value, 14.0);
    EXPECT_EQ(values[0].extent, Extent::whole);
    EXPECT_EQ(values[2].quantity, "share_of_frames_by_volume_change_pct");
    EXPECT_EQ(values[2].value, 0.0);
    EXPECT_EQ(judged(motion_of(-0.25, 0.0))[2].value, 1.0);
    EXPECT_EQ(judged(motion_of(-0.25, 0.0))[2].extent, Extent::whole);
    for (const auto& value : judged(motion_of(std::numeric_limits<double>::quiet_NaN(), 0.0))) EXPECT_EQ(value.extent, Extent::none);
}

// Gravity acts only on integrated particles. If all are integrated, a huge weight leaves nothing finite; if none is, it has no effect.
TEST(FrameTimes, OfReadingsAreOneTimeEachAndStateABreakdown)
{
    const experiments::StudyCase of("ambiguity",
                                    {{"name", "limb"},
                                     {"quick_s", 1.0},
                                     {"scene", "limb_bend"},
                                     {"overrides", {"character.vertices=400", "pbs.gravity_m_s2=[0,-1e308,0]"}},
                                     {"timing_s", 0.05}},
                                    false);
    const auto all = experiments::values_of_frames(of, {{}, {"pbs.time_step_s=0.0025"}, {"pbs.variant.lbs_entry=increment"}});
    ASSERT_EQ(all.size(), 3u);
    for (const experiments::JudgedReading& read : all) {
        ASSERT_EQ(read.values.size(), 1u);
        EXPECT_EQ(read.values[0].quantity, "processor_time_of_a_frame_ms");
        EXPECT_EQ(read.values[0].unit, "ms");
        EXPECT_GT(read.values[0].value, 0.0);
        EXPECT_EQ(read.broke_down, &read == &all[2]);
    }
}

}  // namespace
