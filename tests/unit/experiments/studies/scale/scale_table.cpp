// The table of a growing mesh. Truth: costs that were made to grow with a known power.
#include "experiments/studies/scale/scale_table.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiments;

ScaleRow row_of(long long vertices, double step_power)
{
    const double n = static_cast<double>(vertices);
    return {.vertices = vertices,
            .edges = 6 * vertices,
            .tets = 5 * vertices,
            .iterations = 24,
            .frames = 6,
            .step_ms = 1e-3 * std::pow(n, step_power),
            .character_s = 1e-4 * n,
            .set_up_s = 1e-5 * n,
            .ruler_set_up_s = 1e-5 * n,
            .records_s = 0.01,
            .total_s = 1.0,
            .ruler_ms = 1e-3 * n,
            .write_ms = 1e-2 * n,
            .peak_mb = 30.0 + 1e-3 * n};
}

TEST(ScaleTable, TheExponentIsTheOneTheCostsWereMadeWith)
{
    for (const double power : {1.0, 1.5, 2.0}) {
        const auto table = scale_csv({row_of(400, power), row_of(4000, power), row_of(40000, power)});
        const analysis::Interval p = growth_exponent(table, "step_ms");
        EXPECT_NEAR(p.estimate, power, 1e-12);
        EXPECT_NEAR(p.low, power, 1e-6);  // no scatter, no width
    }
}

TEST(ScaleTable, AConstraintsShareIsOfAllThreeClassesAndAllIterations)
{
    const ScaleRow row = row_of(1000, 1.0);
    EXPECT_EQ(row.constraints(), 12000.0);
    EXPECT_DOUBLE_EQ(row.ns_a_constraint(), 1e6 / (12000.0 * 24.0));  // 1 ms
}

TEST(ScaleTable, ARunIsReadFromItsRecords)
{
    const nlohmann::json run = {{"character", {{"vertices", 10}, {"tets", 20}, {"quality", {{"edges", 30}}}}},
                                {"outcome", {{"frames", 3}}},
                                {"cost",
                                 {{"peak_memory_mb", 50.0},
                                  {"cpu_seconds",
                                   {{"character", 1.0},
                                    {"set_up", 2.0},
                                    {"ruler_set_up", 0.5},
                                    {"records", 0.25},
                                    {"ruler", 0.6},
                                    {"frames", 0.3},
                                    {"deformers", {{"pbs", {{"step", 0.012}}}}},
                                    {"total", 9.0}}}}}};
    const auto metrics =
        analysis::parse_csv("deformer,iterations,step_ms\nlbs,,0.1\npbs,24,7\nlbs,,0.1\npbs,24,3\nlbs,,0.1\npbs,24,4\n", "metrics.csv");
    const ScaleRow row = scale_row(run, metrics);
    EXPECT_EQ(row.step_ms, 4.0);  // of PBS alone, a frame
    EXPECT_EQ(row.iterations, 24);
    EXPECT_DOUBLE_EQ(row.ruler_ms, 100.0);  // of six measurements
    EXPECT_DOUBLE_EQ(row.write_ms, 50.0);
    EXPECT_EQ(row.constraints(), 60.0);
}

TEST(ScaleTable, OneSizeHasNoExponents)
{
    const std::string text = scale_markdown(scale_csv({row_of(400, 1.0)}));
    EXPECT_EQ(text.find("grows with"), std::string::npos);
    const std::string two = scale_markdown(scale_csv({row_of(400, 1.0), row_of(800, 1.0)}));
    EXPECT_NE(two.find("| a step | 1.00 ["), std::string::npos) << two;
}

}  // namespace
