// Expected values follow from made-up timings and from Table 1 as the paper prints it; all of them are single
// quotients. Times themselves are not compared, since others use the machine too.
#include "experiments/studies/timing/timing.hpp"

#include "pbs/skinning/pose.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <map>

namespace frames_tests {
namespace {

using namespace experiments;

// A whole takes longer than its parts, and every variant has the same number of rounds.
TEST(FrameTiming, OfEveryVariantByTurns)
{
    const pbs::Character limb =
        test_support::character_of(test_support::two_bone_limb({20, 6, 6}, pbs::Vec3::UnitZ(), 0.0));
    // fewer frames than the turns need
    const pbs::Motion motion = pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitZ(), 60.0, 4, 0.01);
    const auto timings = time_frames(limb, motion, 0.5, {.seconds = 0.0, .fewest = 5, .most = 5}, 3);
    ASSERT_EQ(timings.size(), 3u);
    const char* const variants[] = {"plainf64", "plainf32", "orderedf32"};
    for (const FrameTiming& timing : timings) {
        EXPECT_EQ(timing.variant + timing.precision, variants[&timing - timings.data()]);
        EXPECT_EQ(timing.total_ms.rounds, 5);
        EXPECT_GT(timing.lbs_ms.median, 0.0);
        EXPECT_GT(timing.bind_ms.median, 0.0);
        EXPECT_GT(timing.stretch_ms.median, timing.bind_ms.median);  // seven times as many constraints
        EXPECT_GT(timing.total_ms.median, timing.lbs_ms.median);
        EXPECT_GT(timing.rest_ms.lower, 0.0);
        EXPECT_GT(timing.total_ms.median, timing.rest_ms.median);  // which has no iterations
        EXPECT_GT(timing.total_wall_ms.median, 0.0);
        EXPECT_FALSE(timing.surface_ms);  // the limb has none
        EXPECT_FALSE(timing.drawn_wall_ms);
    }
}

Spread spread(double median)
{
    return {median, 0.5 * median, 2.0 * median, 5};
}

FrameTiming of_variant(const char* variant, const char* precision, double total_ms, double wall_ms)
{
    FrameTiming timing{.variant = variant, .precision = precision};
    for (Spread FrameTiming::*part : {&FrameTiming::lbs_ms, &FrameTiming::bind_ms, &FrameTiming::stretch_ms,
                                      &FrameTiming::volume_ms, &FrameTiming::rest_ms})
        timing.*part = spread(0.1);
    timing.total_ms = spread(total_ms);
    timing.total_wall_ms = spread(wall_ms);
    return timing;
}

// Three variants, the first one with a surface.
std::vector<TimingRow> rows_of_mesh(const std::string& model = "Man", int vertices = 1654, double wall_ms = 2.0)
{
    std::vector<FrameTiming> timings = {of_variant("plain", "f64", 1.6, wall_ms), of_variant("plain", "f32", 1.0, 4.0),
                                        of_variant("ordered", "f32", 0.5, 1.0)};
    timings[0].drawn_wall_ms = spread(1.25 * wall_ms);
    return timing_rows({.mesh = "man_1654",
                        .body = "man",
                        .model = model,
                        .vertices = vertices,
                        .edges = 3 * 6342,
                        .tets = 2 * 4998,
                        .cpu_model = "a processor"},
                       timings);
}

double measurement(const std::vector<analysis::Measurement>& measured, const std::string& quantity,
                   const analysis::CaseKey& of = {})
{
    for (const auto& one : measured)
        if (one.quantity == quantity && analysis::matches(one.of, of)) return one.value;
    ADD_FAILURE() << quantity;
    return 0.0;
}

TEST(TimingTable, ComparesWithTableOne)
{
    const analysis::CsvTable table = table_of(timing_columns, rows_of_mesh());
    for (const auto& [column, value] : std::map<std::string, double>{{"vertices_over_table_1", 1.0},
                                                                     {"edges_over_table_1", 3.0},
                                                                     {"tets_over_table_1", 2.0},
                                                                     {"frames_per_s", 500.0},
                                                                     {"drawn_frames_per_s", 400.0},
                                                                     {"total_wall_ms_high", 4.0},
                                                                     {"paper_ms", 1e3 / 90.5},
                                                                     {"paper_ct_ms", 0.52}})
        EXPECT_EQ(table.number(0, column), value) << column;
    EXPECT_EQ(table.text_at(0, "cpu_model"), "a processor");
    EXPECT_FALSE(table.number_or_nothing(0, "surface_ms"));
    EXPECT_FALSE(table.number_or_nothing(1, "drawn_frames_per_s")) << "it has no surface";
}

// By wall time; plain and f64 alone are judged.
TEST(TimingTable, ValuesOfTheClaim)
{
    const auto measured = timing_measurements(rows_of_mesh());
    EXPECT_EQ(measured[0].quantity, "frames_per_s");
    EXPECT_EQ(text_of(measured[0].of), "man, 01_01, pbs, table_1, plain, f64, vertices 1654, model Man");
    EXPECT_EQ(measured[0].value, 500.0);
    EXPECT_EQ(measured[0].low, 250.0);
    EXPECT_EQ(measured[0].high, 1000.0);
    EXPECT_EQ(measurement(measured, "frames_per_s_of_processor_time"), 625.0);
    EXPECT_EQ(measurement(measured, "frames_per_s", {.order = "plain", .precision = "f32"}), 250.0);
    EXPECT_EQ(measurement(measured, "frames_per_s", {.order = "ordered", .precision = "f32"}), 1000.0);
    EXPECT_EQ(measurement(measured, "frames_per_s_over_table_1"), 500.0 / 90.5);
    EXPECT_TRUE(timing_measurements(rows_of_mesh("")).empty());  // a step of the ladder
}

TEST(TimingTable, ARefinedMeshHasTheFrameRateThatIsJudgedAlone)
{
    std::vector<TimingRow> rows = rows_of_mesh("", 96525, 500.0);
    for (TimingRow& row : rows) row.is_refined = true;
    const auto measured = timing_measurements(rows);
    ASSERT_EQ(measured.size(), 1u);
    EXPECT_EQ(measured[0].quantity, "frames_per_s");
    EXPECT_EQ(measured[0].value, 2.0);
    EXPECT_EQ(text_of(measured[0].of), "man, 01_01, pbs, refined, plain, f64, vertices 96525");
}

TEST(TimingTable, TheAuthorsLaterCodeIsTimedOnTheSameMesh)
{
    const pbs::Character limb =
        test_support::character_of(test_support::two_bone_limb({20, 6, 6}, pbs::Vec3::UnitZ(), 0.0));
    const pbs::Motion motion = pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitZ(), 60.0, 8, 0.01);
    const auto rate = author_frame_rate({.mesh = "man_1654", .body = "man", .model = "Man", .vertices = 1654}, limb,
                                        motion, {.seconds = 0.0, .fewest = 3, .most = 3});
    EXPECT_EQ(rate.quantity, "frames_per_s");
    EXPECT_EQ(text_of(rate.of),
              "man, 01_01, pbs_author, table_1, first_fit, f64, vertices 1654, iterations 12, model Man");
    EXPECT_GT(rate.low, 0.0);
    EXPECT_LE(rate.low, rate.value);
    EXPECT_LE(rate.value, rate.high);
}

// 1 / 30 s by wall time at 100,000 vertices, on a straight line.
TEST(RealTime, EndsByWallTimeOfTheLadder)
{
    std::vector<TimingRow> rows = rows_of_mesh("", 1000, 1.0 / 3.0);
    rows.push_back(rows_of_mesh("", 10000, 10.0 / 3.0).front());
    rows.push_back(rows_of_mesh("Man", 1654, 9e9).front());
    const analysis::CsvTable ends = real_time_ends(table_of(timing_columns, rows));
    ASSERT_EQ(ends.rows(), 1);
    EXPECT_NEAR(ends.number(0, "vertices"), 1e5, 1e5 * test_support::rounding_error(20, 1.0));
    EXPECT_NEAR(ends.number(0, "exponent"), 1.0, test_support::rounding_error(20, 1.0));
    EXPECT_TRUE(ends[0].has({{"is_beyond", true}}));
    EXPECT_EQ(real_time_ends(table_of(timing_columns, rows_of_mesh())).rows(), 0)
        << "a size of Table 1 is no step of the ladder";
}

}  // namespace
}  // namespace frames_tests
