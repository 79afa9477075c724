// Reference: the definitions of the values, and the claims' own rules for whether a verdict changes.
#include "experiments/studies/ambiguity/volume_readings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace {

using experiments::Reading;
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
