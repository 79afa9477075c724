// The table of a growing mesh. Expected: costs that were made to grow with a known power.
#include "experiments/studies/scale/scale_records.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace experiments;

ScaleRow row_of(double constraints, double step_power)
{
    ScaleRow row;
    row.constraints = constraints;
    row.step_ms = 1e-3 * std::pow(constraints, step_power);
    row.character_s = row.set_up_s = row.metrics_ms = row.write_ms = row.peak_mb = constraints;
    return row;
}

std::string report(const std::vector<ScaleRow>& rows)
{
    return scale_markdown(table_of(scale_columns, rows));
}

TEST(ScaleTable, TheExponentIsTheOneTheCostsWereMadeWith)
{
    for (const auto& [power, exponent] : {std::pair(1.0, "1.00"), std::pair(1.5, "1.50"), std::pair(2.0, "2.00")}) {
        const std::string text = report({row_of(400, power), row_of(4000, power), row_of(40000, power)});
        const std::string p = std::string("| ") + exponent + " [" + exponent + ", " + exponent + "] |";  // no scatter, no width
        EXPECT_NE(text.find("| a step of PBS, mean over the frames " + p), std::string::npos) << text;
    }
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
                                    {"metrics_set_up", 0.5},
                                    {"records", 0.25},
                                    {"metrics", 0.6},
                                    {"frames", 0.3},
                                    {"deformers", {{"pbs", {{"step", 0.012}}}}},
                                    {"total", 9.0}}}}}};
    const auto metrics =
        analysis::parse_csv("deformer,iterations,step_ms\nlbs,,0.1\npbs,24,7\nlbs,,0.1\npbs,24,3\nlbs,,0.1\npbs,24,4\n", "metrics.csv");
    const ScaleRow row = scale_row(run, metrics);
    EXPECT_EQ(row.step_ms, 4.0);  // of PBS alone, per frame
    EXPECT_EQ(row.iterations, 24);
    EXPECT_DOUBLE_EQ(row.metrics_ms, 100.0);  // six measurements
    EXPECT_DOUBLE_EQ(row.write_ms, 50.0);
    EXPECT_EQ(row.constraints, 60.0);  // of all three classes
    EXPECT_DOUBLE_EQ(row.ns_per_constraint, 4e6 / (60.0 * 24.0));
}

TEST(ScaleTable, OneSizeHasNoExponents)
{
    EXPECT_EQ(report({row_of(400, 1.0)}).find("grows with"), std::string::npos);
    EXPECT_NE(report({row_of(400, 1.0), row_of(800, 1.0)}).find("grows with"), std::string::npos);
}

}  // namespace
