// Expected values follow from made-up timings and from Table 1 as the paper prints it; all of them are single quotients.
#include "experiments/studies/timing/timing_records.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

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

}  // namespace
