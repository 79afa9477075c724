// Expected values are those of the reported table.
#include "experiments/studies/timing/timing_records.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

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
