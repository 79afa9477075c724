// Reference: the rules in the header, by hand.
#include "reference_fem/verification/verification_record.hpp"

#include "analysis/records/tables.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace reference_fem;

VerificationRow row()
{
    return {.problem = "beam",
            .quantity = {"mean_deflection", "deflection, \"mean\"", "newmark"},
            .elements = {2, "taylor_hood"},
            .material = {"linear", 0.3},
            .mesh = "4 x 1 x 1",
            .h_m = 0.25,
            .dofs = 90,
            .value = 1.96,
            .reference = -2.0,
            .unit = "m",
            .source = "closed form: a beam",
            .low = 1.95,
            .high = 2.05,
            .bound_from = "theory"};
}

TEST(VerificationRowTest, TheDifferenceIsSignedAndOfTheReferencesSize)
{
    EXPECT_DOUBLE_EQ(*difference_pct(row()), 198.0);
    VerificationRow without = row();
    without.reference = 0.0;
    EXPECT_FALSE(difference_pct(without));
}

TEST(VerificationRowTest, HoldsBetweenItsBounds)
{
    VerificationRow bounded = row();
    EXPECT_TRUE(*holds(bounded));
    for (const double value : {1.94, 2.06, std::nan("")}) {
        bounded.value = value;
        EXPECT_FALSE(*holds(bounded)) << value;
    }
    bounded = row();
    bounded.high = std::nullopt;
    bounded.value = 1e300;
    EXPECT_TRUE(*holds(bounded));
}

TEST(VerificationRowTest, TheOrderIsJudgedBesideTheBounds)
{
    VerificationRow ordered = row();
    ordered.expected_order = 2.0;
    EXPECT_FALSE(*holds(ordered)) << "none was observed";
    ordered.observed_order = 1.91;
    EXPECT_TRUE(*holds(ordered));
    ordered.observed_order = 2.11;
    EXPECT_FALSE(*holds(ordered));
    ordered.observed_order = 2.0;
    ordered.value = 0.0;
    EXPECT_FALSE(*holds(ordered));
}

TEST(VerificationRowTest, WithoutBoundsThereIsNothingToHold)
{
    VerificationRow seen = row();
    seen.low = seen.high = std::nullopt;
    seen.observed_order = 1.2;
    EXPECT_FALSE(holds(seen));
}

TEST(VerificationRowTest, ComesBackFromJson)
{
    VerificationRow written = row();
    written.observed_order = 1.9;
    written.value = std::nan("");
    const VerificationRow read = verification_row(nlohmann::json::parse(to_json(written).dump()));
    EXPECT_TRUE(std::isnan(read.value));
    VerificationRow comparable = read;
    comparable.value = written.value = 1.0;
    EXPECT_EQ(to_json(comparable), to_json(written));
}

TEST(VerificationRecordTest, IsWrittenAsCsvJsonAndMarkdown)
{
    const test_support::ScratchFolder folder;
    VerificationRow seen = row();
    seen.low = seen.high = std::nullopt;
    seen.material = {"none"};
    seen.elements = {.formulation = "pbs"};
    write_verification_record(folder.path().string(), {row(), seen});
    const analysis::CsvTable table = analysis::read_csv(folder / "verification.csv");
    EXPECT_EQ(table.rows(), 2);
    EXPECT_EQ(table.text_at(0, "quantity"), "mean_deflection");
    EXPECT_EQ(table.text_at(0, "description"), "deflection, \"mean\"");
    EXPECT_EQ(table.text_at(0, "element_order"), "2");
    EXPECT_EQ(table.text_at(0, "formulation"), "taylor_hood");
    EXPECT_EQ(table.number(0, "value"), 1.96);
    EXPECT_EQ(table.text_at(0, "setting"), "newmark");
    EXPECT_EQ(table.text_at(0, "material"), "linear");
    EXPECT_EQ(table.number(0, "poisson"), 0.3);
    EXPECT_EQ(table.text_at(0, "holds"), "yes");
    EXPECT_EQ(table.text_at(1, "poisson"), "");
    EXPECT_EQ(table.text_at(1, "element_order"), "");
    EXPECT_EQ(table.text_at(1, "formulation"), "pbs");
    EXPECT_EQ(table.text_at(1, "holds"), "");
    EXPECT_TRUE(std::filesystem::exists(folder / "verification.json"));
    EXPECT_TRUE(std::filesystem::exists(folder / "verification.md"));
}

TEST(VerificationRecordTest, TheTableCountsWhatHoldsAndNamesWhatDoesNot)
{
    VerificationRow failing = row(), seen = row();
    failing.value = 3.0;
    failing.observed_order = 1.75;
    failing.expected_order = 2.0;
    seen.low = seen.high = std::nullopt;
    const std::string table = verification_table({row(), failing, seen});
    EXPECT_NE(table.find("+198 to +250"), std::string::npos) << table;
    EXPECT_NE(table.find("-0.25"), std::string::npos) << table;
    EXPECT_NE(
        table.find(
            "does not hold: deflection, \"mean\", P2 taylor_hood, linear, poisson 0.3, 4 x 1 x 1: 3 m, expected 1.95 to 2.05 1.75 (2)"),
        std::string::npos)
        << table;
    EXPECT_NE(table.find("1 of 2 rows hold; 1 more"), std::string::npos) << table;
}

}  // namespace
