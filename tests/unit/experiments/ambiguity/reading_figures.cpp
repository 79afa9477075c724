// Truth: the studies' own functions called by hand, and what a reading cannot change.
#include "experiments/ambiguity/reading_figures.hpp"

#include "experiments/cases/motion_case.hpp"
#include "experiments/error_split/posed_character.hpp"
#include "experiments/momentum/momentum_drift.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using analysis::Extent;
using experiments::JudgedFigure;
using experiments::Reading;
using experiments::ReadingFigures;
using experiments::ReadingsCase;

ReadingsCase small_limb()
{
    return {.scene = experiments::read_scene("limb_bend", {"character.vertices=400"}),
            .frame = 18,
            .pose = "bend 90",
            .jolt_direction = pbs::Vec3::UnitX(),
            .most_iterations = 60,
            .jolt_steps = 60,
            .timing_s = 0.05};
}

Reading own()
{
    return {.place = "", .name = "own", .baseline = "own", .options = experiments::spec_of(small_limb().scene, "pbs").pbs};
}

template <typename Change>
std::vector<Reading> own_and(const Change& change)
{
    std::vector<Reading> readings = {own(), own()};
    change(readings[1]);
    return readings;
}

const JudgedFigure& figure(const ReadingFigures& read, const std::string& quantity)
{
    const auto found = std::find_if(read.figures.begin(), read.figures.end(), [&](const auto& one) { return one.quantity == quantity; });
    if (found == read.figures.end()) throw std::runtime_error("no " + quantity);
    return *found;
}

TEST(ReadingFigures, OfStartsAreThreeStartsByTwoTolerancesAtMost)
{
    const auto all = figures_of_starts(small_limb(), own_and([](Reading& r) { r.options.k_stretch = 0.9; }));
    ASSERT_EQ(all.size(), 2u);
    EXPECT_GE(all[0].figures.size(), 3u);
    EXPECT_LE(all[0].figures.size(), 6u);
    for (const JudgedFigure& one : all[0].figures) EXPECT_EQ(one.claim, "C03");
    EXPECT_EQ(figure(all[0], all[1].figures[0].quantity).of, all[1].figures[0].of);
}

TEST(ReadingFigures, OfProjectionsAreTheMomentumStudysDrifts)
{
    const auto all = figures_of_projections(small_limb(), own_and([](Reading& r) { r.options.masses = pbs::Masses::lumped; }));
    const ReadingsCase of = small_limb();
    const pbs::Character character = pbs::make_character(of.scene.character);
    const pbs::Pose pose = experiments::make_motion(of.scene.motion, character.skeleton, of.scene.file).steps.at(18);
    const auto drift =
        experiments::drift_of_projections(character, pose, own().options, experiments::ProjectedClass::stretch, pbs::Masses::unit);
    EXPECT_EQ(figure(all[0], "linear drift").value, drift.linear);
    EXPECT_EQ(figure(all[0], "angular drift").value, drift.angular);
    EXPECT_NE(figure(all[1], "linear drift of a pass").value, figure(all[0], "linear drift of a pass").value);
    EXPECT_EQ(figure(all[1], "linear drift of a pass").extent, Extent::whole);  // masses that the projection knows
}

// Algorithm 1 has the next position from the last two alone, whatever the step: half the step swings twice as fast.
TEST(ReadingFigures, OfJoltsHaveTheSameDampingInSubstepsThatAreTheSameSteps)
{
    const auto all = figures_of_jolts(small_limb(), own_and([](Reading& r) { r.substeps = 2; }));
    EXPECT_EQ(figure(all[0], "share of settings that swing").of, figure(all[1], "share of settings that swing").of);
    EXPECT_NEAR(figure(all[0], "frequency at half the time step over at the whole").value, 2.0, 1e-6);
    // twice the samples of a series that has died away by then
    EXPECT_NEAR(figure(all[1], "damping ratio").value, figure(all[0], "damping ratio").value, 1e-3);
}

// LBS moves it by the jolt beforehand, and a body that is moved as a whole violates no constraint.
TEST(ReadingFigures, OfAJoltThatCarriesTheFleshAlongHaveNoSwing)
{
    const auto all = figures_of_jolts(small_limb(), own_and([](Reading& r) { r.options.lbs_entry = pbs::LbsEntry::increment; }));
    EXPECT_EQ(figure(all[0], "share of settings that swing").value, 1.0);
    EXPECT_EQ(figure(all[1], "share of settings that swing").value, 0.0);
    EXPECT_EQ(figure(all[1], "share of settings that swing").extent, Extent::none);
    EXPECT_EQ(all[1].figures.size(), 1u);
}

TEST(ReadingFigures, OfFramesGrowWithSubsteps)
{
    const auto all = figures_of_frames(small_limb(), own_and([](Reading& r) { r.substeps = 4; }));
    EXPECT_EQ(all[0].figures[0].unit, "ms");
    const double ratio = all[1].figures[0].value / all[0].figures[0].value;
    EXPECT_GT(ratio, 2.0);  // four steps, of the same work each; a busy machine disturbs both alike
    EXPECT_LT(ratio, 8.0);
}

// Weight acts on what is integrated alone: where all is, an infinite one leaves nothing finite; where nothing is, it is not felt.
TEST(ReadingFigures, OfFramesTellABreakdown)
{
    const auto all = figures_of_frames(small_limb(), own_and([](Reading& r) {
                                           r.options.lbs_entry = pbs::LbsEntry::increment;
                                           r.options.gravity_m_s2 = pbs::Vec3(0.0, -std::numeric_limits<double>::infinity(), 0.0);
                                       }));
    EXPECT_FALSE(all[0].broke_down);
    EXPECT_TRUE(all[1].broke_down);
}

}  // namespace
