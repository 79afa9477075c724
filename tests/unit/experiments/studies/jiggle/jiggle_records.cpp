// Reference: for the values of C09 from invented responses that do not swing, or of too few settings, the ranks and
// counts of the given ones. The kept records check all values of responses that swing
// (tests/regression/experiments/kept_values.cpp).

#include "experiments/characters/bodies.hpp"
#include "experiments/characters/bone_capsules.hpp"
#include "experiments/studies/jiggle/jiggle_records.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/solver/options.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/step_rounding.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace {

using experiments::ResponseRow;

// Invented responses of flesh to a jolt.
ResponseRow swinging(ResponseRow setting, double hz, double width = 0.1)
{
    setting.response = {.overshoot_over_jolt = 0.3};
    setting.response.swing.outcome = analysis::OscillationOutcome::found;
    setting.response.swing.frequency_hz = {hz, (1.0 - width) * hz, (1.0 + width) * hz};
    setting.response.swing.damping_ratio = {0.1, 0.08, 0.12};
    return setting;
}

ResponseRow creeping(const ResponseRow& setting)
{
    ResponseRow measured = swinging(setting, 0.0);
    measured.response.swing = {};
    measured.response.swing.outcome = analysis::OscillationOutcome::overdamped;
    return measured;
}

std::vector<analysis::Measurement> of_quantity(const std::vector<ResponseRow>& measured, const std::string& quantity)
{
    std::vector<analysis::Measurement> chosen;
    for (const auto& measurement : experiments::jiggle_values("limb", measured))
        if (measurement.quantity == quantity) chosen.push_back(measurement);
    return chosen;
}

const char* const share = "share_of_settings_that_swing";
const char* const correlation = "rank_correlation_of_frequency_and_k_stretch";
const char* const range = "frequency_ratio_over_k_stretch";

TEST(JiggleFigures, WhatDoesNotSwingCountsInTheShareAndHasNeitherFrequencyNorDamping)
{
    const auto shares = of_quantity({swinging({}, 3.0), creeping({.iterations = 96}), creeping({.iterations = 48}),
                                     swinging({.k_stretch = 0.5}, 4.0), creeping({.masses = "lumped"})},
                                    share);
    ASSERT_EQ(shares.size(), 1u);
    EXPECT_DOUBLE_EQ(shares[0].value, 0.5);
    EXPECT_EQ(shares[0].of, analysis::CaseKey{.body = "limb"});
    EXPECT_EQ(shares[0].n, 4);
    ResponseRow still = creeping({});
    still.response.left_over_peak = 0.25;
    const auto measurements = experiments::jiggle_values("limb", {still});
    ASSERT_EQ(measurements.size(), 3u);  // amplitude, last share of the peak, and the share of settings
    EXPECT_EQ(measurements[0].quantity, "amplitude");
    EXPECT_EQ(measurements[1].value, 0.25);
    EXPECT_EQ(measurements[2].value, 0.0);
    still.response.finished = false;
    EXPECT_TRUE(of_quantity({still}, "amplitude").empty()) << "it broke down";
    EXPECT_TRUE(std::isnan(of_quantity({still}, "last_share_of_peak").at(0).value)) << "it does not come to rest";
    EXPECT_EQ(of_quantity({still}, share).size(), 1u);
    EXPECT_TRUE(experiments::jiggle_values("limb", {}).empty());
    EXPECT_TRUE(of_quantity({swinging({}, 3.0)}, range).empty()) << "one value of k_stretch has no ends";
}

// The correlation of ranks 1 to n is a sum of n products of differences from the mean over the sum of n squares, (n^3 -
// n) / 12. A difference of at most n goes through three roundings of the running mean for each of the n ranks, and so
// do sums and squares.
double correlation_error(int n)
{
    const double sum = n * (2.0 * 3.0 * n + 3.0) * double(n) * double(n);
    return test_support::rounding_error(2.0 * sum, 12.0 / (std::pow(n, 3) - n)) + test_support::rounding_error(4, 1.0);
}

TEST(JiggleFigures, CorrelationIsOfRanksAndTakesTheLeastWithoutOne)
{
    std::vector<ResponseRow> measured = {swinging({.k_stretch = 0.05}, 2.0), swinging({}, 3.0),
                                         swinging({.k_stretch = 0.2}, 50.0), swinging({.k_stretch = 0.5}, 51.0)};
    ASSERT_EQ(of_quantity(measured, correlation).size(), 1u);
    EXPECT_DOUBLE_EQ(of_quantity(measured, correlation)[0].value, 1.0);
    measured.push_back(swinging({.k_stretch = 1.0}, 1.0));
    // The sum of squared differences of ranks is 20: 1 - 6 * 20 / (5 * 24).
    EXPECT_NEAR(of_quantity(measured, correlation)[0].value, 0.0, correlation_error(5));
    EXPECT_LT(of_quantity(measured, correlation)[0].low, 0.0);

    // For any number of settings, rounding must neither move the correlation of a perfect order out of [-1, 1] nor the
    // value out of its interval.
    measured.clear();
    for (int n = 1; n <= 12; ++n) {
        measured.push_back(swinging({.k_stretch = 0.07 * n}, 1.0 + 0.1 * n));
        for (const auto& measurement : of_quantity(measured, correlation)) {
            EXPECT_LE(measurement.low, measurement.value) << n;
            EXPECT_GE(measurement.high, measurement.value) << n;
            EXPECT_LE(measurement.high, 1.0) << n;
            EXPECT_NEAR(measurement.value, 1.0, correlation_error(n)) << n;
        }
    }
}

// A setting that does not swing has an amplitude as well. Other time steps, iterations and readings do not enter.
TEST(JiggleFigures, AmplitudesAreComparedOverKStretchAlone)
{
    std::vector<ResponseRow> measured = {swinging({}, 3.0), creeping({.k_stretch = 1.0}),
                                         swinging({.k_stretch = 0.05}, 2.0), swinging({.k_stretch = 0.5}, 4.0),
                                         swinging({.iterations = 96}, 4.0)};
    const double amplitudes[] = {0.25, 0.125, 0.5, 0.1875, 100.0};
    for (std::size_t i = 0; i < measured.size(); ++i) measured[i].response.overshoot_over_jolt = amplitudes[i];
    const auto ratio = of_quantity(measured, "amplitude_ratio_over_k_stretch");
    ASSERT_EQ(ratio.size(), 1u);
    EXPECT_EQ(ratio[0].value, 4.0);
    EXPECT_EQ(text_of(ratio[0].of), "limb, pbs, plain, f64, masses unit");
    const char* const falling = "rank_correlation_of_amplitude_and_k_stretch";
    EXPECT_NEAR(of_quantity(measured, falling).at(0).value, -1.0, correlation_error(4));
    EXPECT_EQ(of_quantity(measured, falling)[0].of, ratio[0].of);
    measured[1].response.finished = false;  // three are left
    EXPECT_TRUE(of_quantity(measured, falling).empty());
    EXPECT_DOUBLE_EQ(of_quantity(measured, "amplitude_ratio_over_k_stretch").at(0).value, 0.5 / 0.1875);
    for (ResponseRow& one : measured) one.response.overshoot_over_jolt = 0.0;
    EXPECT_TRUE(std::isnan(of_quantity(measured, "amplitude_ratio_over_k_stretch").at(0).value)) << "nothing swings";
}

// Reference: necessary behaviour. Flesh that does not jiggle follows the bones; flesh without constraints stays behind,
// at rest; a jolt in the opposite direction gives the mirror image.

// As in the study: the zone is bound, and everything else has a k_stretch of 1.
void jiggle(pbs::PbsOptions& options, double k_stretch)
{
    options.k_stretch = 1.0;
    options.jiggle = pbs::Jiggle{.k_stretch = k_stretch, .k_bind = 1.0};
    options.order = pbs::Order::plain;
    options.precision = pbs::Precision::f64;
}

class JoltResponseOfLimb : public testing::Test {
protected:
    JoltResponseOfLimb()
    {
        options().precision = pbs::Precision::f64;
        jolt.direction = pbs::Vec3::UnitX();
        jolt.steps = 40;
    }
    pbs::PbsOptions& options() { return experiments::options_of<pbs::PbsOptions>(spec); }
    experiments::JoltResponse response() const { return experiments::jolt_response(limb, spec, probe, jolt); }

    pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 400});
    std::vector<int> probe = pbs::zone_contents(limb).pieces.front();
    experiments::DeformerSpec spec = experiments::default_spec("pbs");
    experiments::Jolt jolt;
};

TEST_F(JoltResponseOfLimb, NothingSwingsWithoutJiggle)
{
    options().jiggle.reset();
    const auto still = response();
    // Every step begins with LBS, so that two steps differ by their roundings alone.
    const double rounding_m = 2.0 * test_support::step_rounding_m(test_support::two_bones_in(limb.mesh), options());
    EXPECT_LT(still.peak_over_jolt, rounding_m / jolt.length_m);
    EXPECT_FALSE(still.swing.found());
}

TEST_F(JoltResponseOfLimb, FreeFleshStaysBehind)
{
    options().k_stretch = options().k_volume = options().k_bind = 0.0;
    options().jiggle = pbs::Jiggle{.k_stretch = 0.0};
    const auto free = response();
    const double rounding_m = test_support::mean_error(probe.size(), jolt.length_m);
    for (const double excursion_m : free.excursion_m) EXPECT_NEAR(excursion_m, -jolt.length_m, rounding_m);
    EXPECT_EQ(free.left_over_peak, 1.0);  // all excursions are equal
    EXPECT_EQ(free.overshoot_over_jolt, 0.0);
}

// The motion from step to step does not depend on time (Algorithm 1, lines 7, 8 and 16). A quarter of a time step and
// four times a velocity are exact.
TEST_F(JoltResponseOfLimb, WithoutWeightTheSeriesIsTheSameAtEveryTimeStep)
{
    jiggle(options(), 0.1);
    const auto slow = response();
    jolt.time_step_s /= 4.0;
    const auto quick = response();
    EXPECT_EQ(quick.excursion_m, slow.excursion_m);
}

// The bones hold the skin: it swings about the place to which they move it, and comes to rest.
TEST_F(JoltResponseOfLimb, HeldFleshSwingsAndCalmsDown)
{
    jiggle(options(), 0.1);
    const auto held = response();
    EXPECT_TRUE(held.finished);
    EXPECT_GT(held.peak_over_jolt, 0.05);
    EXPECT_LT(held.peak_over_jolt, 1.0);
    EXPECT_LT(held.left_over_peak, 0.5);
    EXPECT_LT(held.speed_growth, 1.0);
}

// Flesh that LBS carries along answers a jolt by rounding alone. A fit would find a swing in it.
TEST(JoltRecords, HaveNoSwingWhereTheFleshIsCarriedAlong)
{
    const test_support::ScratchFolder folder;
    const experiments::JoltCase carried_along{
        .scene = "limb_bend",
        .overrides = {"pbs.variant.lbs_entry=increment", "pbs.jiggle.k_stretch=0.9", "pbs.order=plain",
                      "pbs.precision=f64", "pbs.gravity_m_s2=[0,0,0]"},
        .settings = {{}},
        .jolt = {.direction = pbs::Vec3::UnitX()}};
    record_jolts(carried_along, folder.path().string());
    for (const analysis::Measurement& measured : analysis::measurements(folder / "measurements.csv"))
        EXPECT_FALSE(measured.of.deformer == "pbs" && measured.quantity == "damping_ratio") << text_of(measured.of);
}

// LBS has no inertia: it stands in its place at once. A point at the radius r goes along an arc in chords of 2 r
// sin(step / 2).
TEST(JiggleStop, LbsStopsAtOnceAfterThePathOfItsBones)
{
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 400});
    const std::vector<bool> zone = pbs::jiggle_zone(limb.binding);
    const int forearm = pbs::find_bone(limb.skeleton, "forearm");
    std::vector<int> probe;
    pbs::Vec3 mean = pbs::Vec3::Zero();
    for (std::size_t v = 0; v < zone.size(); ++v)
        if (zone[v] && limb.binding.bone[v] == forearm) {
            probe.push_back(static_cast<int>(v));
            mean += limb.mesh.rest.row(static_cast<Eigen::Index>(v)).transpose();
        }
    mean /= static_cast<double>(probe.size());
    const int frames = 5;
    const double angle_deg = 40.0;
    const pbs::Motion bend = pbs::joint_sweep(limb.skeleton, forearm, pbs::Vec3::UnitZ(), angle_deg, frames, 0.01);
    const auto response = experiments::stop_response(limb, experiments::default_spec("lbs"), probe, bend, 20);
    const pbs::Vec3 from_joint = mean - limb.skeleton.bones[forearm].head;
    const double step_rad = angle_deg / (frames - 1) * std::numbers::pi / 180.0;
    EXPECT_NEAR(response.path_m, (frames - 1) * 2.0 * from_joint.head<2>().norm() * std::sin(step_rad / 2.0), 1e-12);
    EXPECT_EQ(response.peak_over_jolt, 0.0);
    EXPECT_EQ(response.rest_over_jolt, 0.0);
    EXPECT_EQ(response.settling_s, 0.0);
    const pbs::Motion still = pbs::joint_sweep(limb.skeleton, forearm, pbs::Vec3::UnitZ(), 0.0, frames, 0.01);
    EXPECT_THROW(experiments::stop_response(limb, experiments::default_spec("lbs"), probe, still, 20), pbs::InputError);
    experiments::DeformerSpec loose = experiments::default_spec("pbs");
    jiggle(experiments::options_of<pbs::PbsOptions>(loose), 0.05);
    const auto swings = experiments::stop_response(limb, loose, probe, bend, 100);
    EXPECT_GT(swings.peak_over_jolt, 1e-3);
    const double bound = 0.1 * swings.peak_over_jolt * swings.path_m;
    for (std::size_t step = 0; step < swings.excursion_m.size(); ++step)
        if (0.01 * static_cast<double>(step) >= swings.settling_s) {
            EXPECT_LE(std::abs(swings.excursion_m[step]), bound) << step;
        } else if (0.01 * static_cast<double>(step + 1) >= swings.settling_s) {
            EXPECT_GT(std::abs(swings.excursion_m[step]), bound) << "the last step beyond";
        }
}

}  // namespace
