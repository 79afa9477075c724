// Reference: values by hand.
#include "analysis/verdicts/measurement.hpp"

#include "analysis/records/record_files.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace analysis;

Measurement drift(const std::string& body, double value)
{
    return {"C07", "linear_drift", {.body = body}, value, value, value, "1"};
}

TEST(Measurement, ComesBackFromItsTable)
{
    const test_support::ScratchFolder folder;
    const std::string path = folder / "measurements.csv";
    const CaseKey key = {
        .body = "limb \"soft\", thin", .motion = "bend", .angle_deg = 1.0 / 3.0, .deformer = "pbs", .iterations = 24.0};
    const Measurement written{"C07", "linear_drift", key, 1.0 / 3.0, 0.25, 0.5, "m", "", Limit::more_than, 4, 1};
    measurement_table({written, drift("human", 1e-300)}).write(path);
    const auto read = measurements(path);
    ASSERT_EQ(read.size(), 2u);
    EXPECT_EQ(read[0].quantity, written.quantity);
    EXPECT_EQ(read[0].of, written.of);
    EXPECT_EQ(read[0].limit, Limit::more_than);
    EXPECT_EQ(read[0].n, 4);
    EXPECT_EQ(read[0].not_reached, 1);
    EXPECT_EQ(read[1].of, CaseKey{.body = "human"});
    EXPECT_EQ(read[1].limit, Limit::none);
    EXPECT_EQ(read[0].value, written.value);
    EXPECT_EQ(read[0].high, written.high);
    EXPECT_EQ(read[1].value, 1e-300);
    write_text_atomically(path, "claim,quantity,value,low,high,unit,limit\nC07,linear_drift,1,1,1,1,roughly\n");
    EXPECT_THROW(measurements(path), pbs::InputError) << "an unknown limit";
}

TEST(MeasuredSeries, DifferInOneFieldAlone)
{
    const auto amplitude = [](const char* body, std::optional<double> k_stretch, double value) {
        return Measurement{"C09", "amplitude", {.body = body, .k_stretch = k_stretch}, value, value, value, "1"};
    };
    Measurement other = amplitude("limb", 0.3, 9.0);
    other.quantity = "frequency_hz";
    const auto all = series_over({amplitude("limb", 0.5, 1.0), amplitude("man", 0.1, 4.0), other,
                                  amplitude("limb", {}, 5.0), amplitude("limb", 0.1, 2.0), amplitude("limb", 0.2, 3.0)},
                                 "amplitude", &CaseKey::k_stretch);
    ASSERT_EQ(all.size(), 2u);
    std::vector<std::pair<double, double>> of_limb;
    for (const auto& [k_stretch, measurement] : all.at({.body = "limb"}))
        of_limb.emplace_back(k_stretch, measurement.value);
    EXPECT_EQ(of_limb, (std::vector<std::pair<double, double>>{{0.1, 2.0}, {0.2, 3.0}, {0.5, 1.0}}));
    EXPECT_EQ(all.at({.body = "man"}).size(), 1u);
}

CaseRecord walk()
{
    CaseRecord walk;
    walk.scene = "human_walk";
    walk.deformer = "pbs";
    walk.variant = "default";
    walk.place = {.body = "human", .motion = "01_01"};
    walk.order = "plain";
    walk.precision = "f64";
    walk.iterations = 24;
    walk.run = "volume/walk";
    walk.frame = walk.time_s = walk.inverted_tets = {0, 1, 2, 3};
    walk.volume_change_pct = {0.5, -0.1, -0.9, -0.5};
    walk.volume_abs_change_pct = {0, 1, 2, 3};
    return walk;
}

TEST(FrameMeasurements, OfAClipAreItsMeansAndTheShareOfItsFrames)
{
    const auto measured = frame_measurements(walk());
    ASSERT_EQ(measured.size(), 3u);
    EXPECT_EQ(measured[0].quantity, "mean_volume_loss_pct");
    EXPECT_DOUBLE_EQ(measured[0].value, 0.25);
    EXPECT_EQ(measured[0].low, -0.5);
    EXPECT_EQ(measured[0].high, 0.9);
    EXPECT_EQ(measured[0].of, (CaseKey{.body = "human",
                                       .motion = "01_01",
                                       .deformer = "pbs",
                                       .variant = "default",
                                       .order = "plain",
                                       .precision = "f64",
                                       .iterations = 24.0}));
    EXPECT_EQ(measured[0].run, "volume/walk");
    EXPECT_DOUBLE_EQ(measured[1].value, 1.5);
    EXPECT_EQ(measured[2].quantity, "share_of_frames_within_half_pct");
    EXPECT_EQ(measured[2].value, 0.75) << "0.5 % is within 0.5 %";
    EXPECT_EQ(measured[2].n, 4);
}

TEST(FrameMeasurements, OfASweepAreOnePerAngle)
{
    CaseRecord sweep = walk();
    sweep.angle_deg = {0, 60, 120, 180};
    sweep.beside = true;
    const auto measured = frame_measurements(sweep);
    ASSERT_EQ(measured.size(), 8u);
    EXPECT_EQ(measured[4].quantity, "volume_loss_pct");
    EXPECT_EQ(measured[4].of.angle_deg, 120.0);
    EXPECT_EQ(measured[4].value, 0.9);
    EXPECT_TRUE(measured[4].beside);
}

TEST(FrameMeasurements, AFrameThatIsNotFiniteLiesWithinNoBound)
{
    CaseRecord broken = walk();
    broken.volume_change_pct[1] = std::nan("");
    const auto measured = frame_measurements(broken);
    EXPECT_TRUE(std::isnan(measured[0].value));
    EXPECT_EQ(measured[2].value, 0.5);
    EXPECT_TRUE(frame_measurements({}).empty());
    broken.volume_abs_change_pct.pop_back();
    EXPECT_THROW(frame_measurements(broken), pbs::InputError) << "series of different lengths";
}

}  // namespace
