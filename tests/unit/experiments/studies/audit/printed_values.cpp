// Reference: the paper's Table 1 counted by hand; difference quotients of Eq. 11, which is linear in each coordinate.
#include "experiments/studies/audit/printed_values.hpp"

#include "experiments/studies/shared/bodies.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using analysis::PrintedValue;

bool consistent(const PrintedValue& value)
{
    return value.is_consistent();
}

PrintedValue value_of(const std::vector<PrintedValue>& values, const std::string& model, const std::string& quantity)
{
    const auto found =
        std::find_if(values.begin(), values.end(), [&](const PrintedValue& f) { return f.of.model == model && f.quantity == quantity; });
    return found == values.end() ? PrintedValue{} : *found;
}

TEST(TableOne, EdgesOfManAndBunnyAreFewerThanAnyTetMeshHas)
{
    const auto values = experiments::table_1_values();
    EXPECT_EQ(value_of(values, "Man", "stretch_constraints").least, 1654 + 4998 + 1);
    EXPECT_FALSE(consistent(value_of(values, "Man", "stretch_constraints")));
    EXPECT_FALSE(consistent(value_of(values, "bunny", "stretch_constraints")));
    EXPECT_TRUE(consistent(value_of(values, "ManHQ", "stretch_constraints")));
    EXPECT_TRUE(consistent(value_of(values, "bunnyHQ", "stretch_constraints")));
    EXPECT_TRUE(consistent(value_of(values, "Lady", "stretch_constraints")));
}

TEST(TableOne, NoTotalHoldsItsParts)
{
    for (const auto& row : experiments::table_1())
        EXPECT_FALSE(consistent(value_of(experiments::table_1_values(), row.model, "ct_total_ms"))) << row.model;
}

TEST(TableOne, FrameRateAsksForTwentyTimesTheTotal)
{
    const PrintedValue man = value_of(experiments::table_1_values(), "Man", "ct_total_of_1_s_ms");
    // 90.5 frames per second and totals in ms have one digit after the point; each bound goes through three roundings.
    EXPECT_NEAR(man.least, 1e5 / 90.55 - 0.05, test_support::rounding_error(2 * 3, 1e5 / 90.55));
    EXPECT_NEAR(man.most, 1e5 / 90.45 + 0.05, test_support::rounding_error(2 * 3, 1e5 / 90.45));
    EXPECT_EQ(man.printed, 52.0);
    EXPECT_FALSE(consistent(man));
}

TEST(TableOne, EveryVertexIsBound)
{
    for (const auto& row : experiments::table_1())
        EXPECT_TRUE(consistent(value_of(experiments::table_1_values(), row.model, "bind_constraints"))) << row.model;
}

TEST(TableOne, MeshesOfRoughly2KVerticesHaveFewerThan10KTets)
{
    const auto values = experiments::mesh_size_values();
    ASSERT_EQ(values.size(), 3u);
    EXPECT_TRUE(consistent(values[0]));
    EXPECT_TRUE(consistent(values[1]));
    EXPECT_EQ(values[2].most, 7827);
    EXPECT_FALSE(consistent(values[2]));
}

TEST(PrintedEquationsAudit, SumsHoldLabelsAndSignsDoNot)
{
    const auto values = experiments::equation_values(50, 7);
    ASSERT_EQ(values.size(), 10u);
    const auto consistent = [&](int i) { return values[i].printed <= values[i].most; };
    EXPECT_TRUE(consistent(0)) << "Eq. 15-16 are right as printed";
    for (int i = 1; i <= 8; ++i) EXPECT_FALSE(consistent(i)) << analysis::text_of(values[i].of);
    EXPECT_TRUE(consistent(9)) << "the derived form";
}

TEST(PrintedEquationsAudit, DoesNotDependOnTheSeed)
{
    const auto one = experiments::equation_values(50, 1), other = experiments::equation_values(50, 2);
    for (std::size_t i = 0; i < one.size(); ++i)
        EXPECT_EQ(one[i].printed <= one[i].most, other[i].printed <= other[i].most) << analysis::text_of(one[i].of);
}

}  // namespace
