// Expected values follow from made-up timings and from Table 1 as the paper prints it; all of them are single quotients. Times themselves
// are not compared, since others use the machine too.
#include "experiments/studies/timing/frames.hpp"

#include "pbs/skinning/pose.hpp"
#include "tests/support/limb_character.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

// Expected: a whole takes longer than its parts, and every variant has the same number of rounds. The times themselves are not compared,
// since others use the machine too.

TEST(FrameTiming, OfEveryVariantByTurns)
{
    const pbs::Character limb = test_support::character_of(test_support::two_bone_limb({20, 6, 6}, pbs::Vec3::UnitZ(), 0.0));
    const pbs::Motion motion = pbs::joint_sweep(limb.skeleton, 1, pbs::Vec3::UnitZ(), 60.0, 4, 0.01);  // fewer frames than the turns need
    const auto timings = time_frames(limb, motion, {.k_jiggle = 0.5, .frames_per_turn = 3}, {.seconds = 0.0, .fewest = 5, .most = 5});
    ASSERT_EQ(timings.size(), 3u);
    EXPECT_EQ(timings[0].variant + timings[0].precision, "plainf64");
    EXPECT_EQ(timings[1].variant + timings[1].precision, "plainf32");
    EXPECT_EQ(timings[2].variant + timings[2].precision, "orderedf32");
    for (const FrameTiming& timing : timings) {
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

// Expected values follow from made-up timings and from Table 1 as the paper prints it; all of them are single quotients.

Spread spread(double median)
{
    return {median, 0.5 * median, 2.0 * median, 5};
}

FrameTiming of_variant(const char* variant, const char* precision, double total_ms, double wall_ms)
{
    FrameTiming timing{.variant = variant, .precision = precision};
    for (Spread FrameTiming::*part :
         {&FrameTiming::lbs_ms, &FrameTiming::bind_ms, &FrameTiming::stretch_ms, &FrameTiming::volume_ms, &FrameTiming::rest_ms})
        timing.*part = spread(0.1);
    timing.total_ms = spread(total_ms);
    timing.total_wall_ms = spread(wall_ms);
    return timing;
}

TimedMesh man_mesh(const std::string& model)
{
    TimedMesh mesh{.name = "man_1654", .body = "man", .model = model};
    mesh.vertices = 1654;
    mesh.edges = 3 * 6342;
    mesh.tets = 2 * 4998;
    mesh.cpu_model = "a processor";
    return mesh;
}

std::vector<FrameTiming> three_variants()
{
    return {of_variant("plain", "f64", 1.6, 2.0), of_variant("plain", "f32", 1.0, 4.0), of_variant("ordered", "f32", 0.5, 1.0)};
}

std::vector<TimingRow> man(const std::string& model = "Man")
{
    return timing_rows(man_mesh(model), three_variants());
}

double measurement(const std::vector<analysis::Measurement>& measured, const std::string& quantity, const analysis::CaseKey& of = {})
{
    for (const auto& one : measured)
        if (one.quantity == quantity && analysis::matches(one.of, of)) return one.value;
    ADD_FAILURE() << quantity;
    return 0.0;
}

TEST(TimingTable, ComparesWithTableOne)
{
    const analysis::CsvTable table = table_of(timing_columns, man());
    EXPECT_EQ(table.number(0, "vertices_over_table_1"), 1.0);
    EXPECT_EQ(table.number(0, "edges_over_table_1"), 3.0);
    EXPECT_EQ(table.number(0, "tets_over_table_1"), 2.0);
    EXPECT_EQ(table.number(0, "frames_per_s"), 500.0);
    EXPECT_EQ(table.number(0, "total_wall_ms_high"), 4.0);
    EXPECT_EQ(table.text_at(0, "cpu_model"), "a processor");
    EXPECT_EQ(table.number(0, "paper_ms"), 1e3 / 90.5);
    EXPECT_EQ(table.number(0, "paper_ct_ms"), 0.52);
    EXPECT_FALSE(table.number_or_nothing(0, "surface_ms"));
    EXPECT_FALSE(table.number_or_nothing(0, "drawn_frames_per_s"));
}

TEST(TimingTable, CountsTheSurfaceWhereThereIsOne)
{
    std::vector<FrameTiming> timings = three_variants();
    timings[0].drawn_wall_ms = spread(2.5);
    const analysis::CsvTable table = table_of(timing_columns, timing_rows(man_mesh("Man"), timings));
    EXPECT_EQ(table.number(0, "drawn_frames_per_s"), 400.0);
    EXPECT_EQ(table.number(0, "frames_per_s"), 500.0);
}

// By wall time; plain and f64 alone are judged.
TEST(TimingTable, ValuesOfTheClaim)
{
    const auto measured = timing_measurements(man());
    EXPECT_EQ(measured[0].quantity, "frames_per_s");
    EXPECT_EQ(text_of(measured[0].of), "man, 01_01, pbs, plain, f64, vertices 1654, model Man");
    EXPECT_EQ(measured[0].value, 500.0);
    EXPECT_EQ(measured[0].low, 250.0);
    EXPECT_EQ(measured[0].high, 1000.0);
    EXPECT_EQ(measurement(measured, "frames_per_s_of_processor_time"), 625.0);
    EXPECT_EQ(measurement(measured, "frames_per_s", {.order = "plain", .precision = "f32"}), 250.0);
    EXPECT_EQ(measurement(measured, "frames_per_s", {.order = "ordered", .precision = "f32"}), 1000.0);
    EXPECT_EQ(measurement(measured, "frames_per_s_over_table_1"), 500.0 / 90.5);
    EXPECT_TRUE(timing_measurements(man("")).empty());  // a step of the ladder
}

// Expected values are those of the reported table.

std::vector<TimingRow> human(const std::string& model, int vertices, double wall_ms)
{
    TimedMesh mesh{.name = "human", .body = "human", .model = model};
    mesh.vertices = vertices;
    mesh.cpu_model = "a processor";
    FrameTiming timing{.variant = "plain", .precision = "f64"};
    for (Spread FrameTiming::*part : {&FrameTiming::lbs_ms, &FrameTiming::bind_ms, &FrameTiming::stretch_ms, &FrameTiming::volume_ms,
                                      &FrameTiming::rest_ms, &FrameTiming::total_ms})
        timing.*part = {0.25, 0.2, 0.3, 5};
    timing.total_wall_ms = {wall_ms, wall_ms, wall_ms, 5};
    timing.drawn_wall_ms = {2.0 * wall_ms, wall_ms, wall_ms, 5};
    return timing_rows(mesh, {timing});
}

TEST(TimingReport, HasFrameRatesThoseOfThePaperAndTheProcessor)
{
    const auto rows = human("Man", 1654, 2.0);
    for (const std::string& text : {timing_markdown(rows), timing_text(rows)})
        for (const char* reported : {"500", "250", "90.5", "a processor"}) EXPECT_NE(text.find(reported), std::string::npos) << reported;
}

// 1 / 30 s by wall time at 100,000 vertices, on a straight line.
TEST(TimingReport, RealTimeEndsByWallTimeOfTheLadder)
{
    std::vector<TimingRow> rows = human("", 1000, 1.0 / 3.0);
    rows.push_back(human("", 10000, 10.0 / 3.0).front());
    rows.push_back(human("Man", 1654, 9e9).front());
    const std::string text = timing_text(rows);
    EXPECT_NE(text.find("30 frames per second up to 1e+05 vertices (beyond the measured sizes)"), std::string::npos) << text;
}

}  // namespace
