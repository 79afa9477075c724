// Truth: the table that is told of.
#include "experiments/studies/timing/timing_report.hpp"

#include "experiments/studies/timing/timing_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace experiments;

TimedMesh human(const std::string& model, int vertices, double wall_ms)
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
    mesh.timings = {timing};
    return mesh;
}

analysis::CsvTable table_of(const std::vector<TimedMesh>& meshes)
{
    analysis::CsvTable all{{}};
    for (const TimedMesh& mesh : meshes) all.append(timing_table(mesh));
    return analysis::parse_csv(all.text(), "timing.csv");
}

TEST(TimingReport, TellsFrameRatesBesideThePapersAndTheProcessor)
{
    const analysis::CsvTable table = table_of({human("Man", 1654, 2.0)});
    for (const std::string& text : {timing_markdown(table), timing_text(table)})
        for (const char* told : {"500", "250", "90.5", "a processor"}) EXPECT_NE(text.find(told), std::string::npos) << told;
}

// A head and its rule have as many columns as a row.
TEST(TimingReport, HasAColumnAHead)
{
    const std::string page = timing_markdown(table_of({human("Man", 1654, 2.0)}));
    const auto bars_after = [&](const char* start) {
        const auto line = page.find(start);
        return std::count(page.begin() + line, page.begin() + page.find('\n', line), '|');
    };
    EXPECT_EQ(bars_after("|---"), bars_after("| mesh"));
    EXPECT_EQ(bars_after("| human"), bars_after("| mesh"));
}

// 1 / 30 s by wall time at 100,000 vertices, on a straight line.
TEST(TimingReport, RealTimeEndsByWallTimeOfTheLadder)
{
    const std::string text = timing_text(table_of({human("", 1000, 1.0 / 3.0), human("", 10000, 10.0 / 3.0), human("Man", 1654, 9e9)}));
    EXPECT_NE(text.find("30 frames a second up to 1e+05 vertices (beyond what was measured)"), std::string::npos) << text;
}

}  // namespace
