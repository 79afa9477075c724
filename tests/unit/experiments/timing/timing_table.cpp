// Truth: timings made up as a power of the size; Table 1 as the paper prints it.
#include "experiments/timing/timing_table.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiments;

Spread spread(double median)
{
    return {median, 0.5 * median, 2.0 * median, 5};
}

TimedMesh man()
{
    TimedMesh mesh{.name = "man_1654", .body = "man", .model = "Man"};
    mesh.vertices = 1654;
    mesh.edges = 3 * 6342;
    mesh.tets = 2 * 4998;
    FrameTiming timing{.variant = "plain", .precision = "f64"};
    for (Spread FrameTiming::*part : {&FrameTiming::lbs_ms, &FrameTiming::bind_ms, &FrameTiming::stretch_ms, &FrameTiming::volume_ms,
                                      &FrameTiming::rest_ms, &FrameTiming::total_ms, &FrameTiming::total_wall_ms})
        timing.*part = spread(2.0);
    mesh.timings = {timing};
    return mesh;
}

TEST(TimingTable, StandsBesideTableOne)
{
    const analysis::CsvTable table = timing_table(man());
    EXPECT_EQ(table.number(0, "vertices_over_table_1"), 1.0);
    EXPECT_EQ(table.number(0, "edges_over_table_1"), 3.0);
    EXPECT_EQ(table.number(0, "tets_over_table_1"), 2.0);
    EXPECT_EQ(table.number(0, "frames_per_s"), 500.0);
    EXPECT_EQ(table.number(0, "total_ms_high"), 4.0);
    EXPECT_NEAR(table.number(0, "paper_ms"), 1e3 / 90.5, 1e-12);
    EXPECT_NEAR(table.number(0, "paper_ct_ms"), 0.52, 1e-12);
    EXPECT_FALSE(table.number_or_nothing(0, "surface_ms"));
}

TEST(TimingTable, FiguresOfTheClaim)
{
    const auto measured = timing_measurements(man());
    ASSERT_EQ(measured.size(), 7u);
    EXPECT_EQ(measured[0].quantity, "frames a second");
    EXPECT_EQ(measured[0].of, "man, 1654 vertices, 01_01, plain f64, one core");
    EXPECT_EQ(measured[0].value, 500.0);
    EXPECT_EQ(measured[0].low, 250.0);
    EXPECT_EQ(measured[0].high, 1000.0);
    EXPECT_NEAR(measured[1].value, 500.0 / 90.5, 1e-12);
    TimedMesh of_the_ladder = man();
    of_the_ladder.model.clear();
    EXPECT_TRUE(timing_measurements(of_the_ladder).empty());
}

// total = c V^1.2 is 1000 / 30 ms at 50,000 vertices.
double total_ms(double vertices)
{
    return 1e3 / 30.0 * std::pow(vertices / 50e3, 1.2);
}

TEST(TimingTable, RealTimeEndsWhereAFrameTakesAThirtieth)
{
    for (const std::vector<double>& sizes : {std::vector<double>{1e3, 1e4, 1e5}, {1e5, 1e3, 1e4}}) {
        std::vector<double> ms;
        for (const double vertices : sizes) ms.push_back(total_ms(vertices));
        const RealTimeEnd end = real_time_end(sizes, ms);
        EXPECT_NEAR(end.vertices, 50e3, 1e-6);
        EXPECT_NEAR(end.exponent, 1.2, 1e-10);
        EXPECT_FALSE(end.beyond);
    }
}

TEST(TimingTable, RealTimeEndBeyondWhatWasMeasuredIsToldSo)
{
    const RealTimeEnd above = real_time_end({1e3, 1e4}, {total_ms(1e3), total_ms(1e4)});
    EXPECT_NEAR(above.vertices, 50e3, 1e-6);
    EXPECT_TRUE(above.beyond);
    EXPECT_TRUE(real_time_end({1e5, 1e6}, {total_ms(1e5), total_ms(1e6)}).beyond);
}

TEST(TimingTable, TellsWhatItHas)
{
    const std::string text = timing_markdown(timing_table(man()));
    EXPECT_NE(text.find("| 500 |"), std::string::npos);
    EXPECT_NE(text.find("90.5"), std::string::npos);
}

}  // namespace
