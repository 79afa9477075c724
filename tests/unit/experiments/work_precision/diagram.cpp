// Diagrams, their tables and their words. Truth: a few points whose fronts and crossings are seen by eye; altered points must change what
// is said.
#include "experiments/work_precision/diagram.hpp"

#include "experiments/work_precision/diagram_tables.hpp"
#include "experiments/work_precision/findings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace {

using namespace experiments;
using analysis::CsvTable;

struct Row {
    std::string deformer, setting;
    double ms;
    std::optional<double> error_pct;
    std::string outcome = "finished";
};

CsvTable points(const std::string& pose, const std::vector<Row>& rows, double bar_pct = 6.0)
{
    const auto cell = [](const std::optional<double>& value) { return value ? CsvTable::Cell(*value) : CsvTable::Cell(std::nullopt); };
    CsvTable table({"body", "pose", "deformer", "setting", "outcome", "ms_median", "ms_q1", "ms_q3", "error_joint_pct",
                    "error_joint_beside_pct", "reference", "reference_error_joint_pct", "below_reference_error"});
    for (const Row& row : rows)
        table.add_row({"limb", pose, row.deformer, row.setting, row.outcome, row.ms, row.ms, row.ms, cell(row.error_pct),
                       row.error_pct ? CsvTable::Cell(*row.error_pct + 1.0) : CsvTable::Cell(2.0), "snh_p2", bar_pct,
                       int(row.error_pct.value_or(99.0) <= bar_pct)});
    return analysis::parse_csv(table.text(), "points.csv");
}

const std::string pbs_24 = "24 iterations, k_stretch 0.2, ordered f32";

std::vector<Row> rows(double mush_pct)
{
    return {{"lbs", "", 0.01, 60.0},
            {"dqs", "", 0.02, 50.0},
            {"delta_mush", "20 iterations", 0.5, mush_pct},
            {"pbs", pbs_24, 0.7, 20.0},
            {"xpbd", "8 iterations", 0.65, 25.0},
            {"fem_linear", "P1", 5.0, 30.0},
            {"fem_corotational", "P1", 100.0, 5.0},
            {"fem_stable_neo_hookean", "P2", 900.0, std::nullopt, "reference"}};
}

Diagram diagram(double mush_pct)
{
    return diagrams_of({points("90 deg", rows(mush_pct))}).front();
}

bool says(const std::vector<std::string>& lines, const std::string& text)
{
    return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

TEST(Diagram, HoldsThePointsWithTimeAndErrorAndTheReferenceBeside)
{
    const Diagram read = diagram(30.0);
    EXPECT_EQ(read.name, "limb, 90 deg");
    EXPECT_EQ(read.points.size(), 7u);
    EXPECT_EQ(read.reference, "snh_p2");
    EXPECT_EQ(read.reference_ms, 900.0);
    EXPECT_EQ(read.reference_error_pct, 6.0);
    EXPECT_EQ(read.reference_difference_pct, 2.0);
    EXPECT_TRUE(read.points.back().below_reference_error);
}

TEST(Diagram, AMeanTakesThreePosesAndTheSettingsThatAllOfThemHave)
{
    std::vector<Row> other = rows(36.0), without = rows(24.0);
    without.erase(without.begin() + 1);  // no DQS
    const auto two = diagrams_of({points("a", rows(30.0)), points("b", other)});
    EXPECT_EQ(two.size(), 2u);
    const auto three = diagrams_of({points("a", rows(30.0)), points("b", other), points("c", without)});
    ASSERT_EQ(three.size(), 5u);  // the poses, the body's mean, that of all bodies
    const Diagram& mean = three[3];
    EXPECT_EQ(mean.name, "limb, mean of 3 poses");
    EXPECT_EQ(mean.points.size(), 6u);
    EXPECT_NEAR(mean.points[1].error_pct, 30.0, 1e-12);
    EXPECT_NEAR(mean.points[1].beside_pct.value(), 31.0, 1e-12);
}

TEST(Diagram, WithoutAReferenceHasNoPointsAndSaysSo)
{
    std::vector<Row> unreached = rows(30.0);
    for (Row& row : unreached) row.error_pct.reset(), row.outcome = "finished";
    unreached.back().outcome = "not_converged";
    const Diagram empty = diagrams_of({points("90 deg", unreached)}).front();
    EXPECT_TRUE(empty.points.empty());
    EXPECT_TRUE(says(findings(empty), "no reference was reached"));
    EXPECT_EQ(fronts_table({empty}).rows(), 0);
    EXPECT_EQ(crossings_table({empty}).rows(), 0);
}

TEST(DiagramTables, FrontsOfAllAndOfEachDeformer)
{
    const CsvTable fronts = analysis::parse_csv(fronts_table({diagram(30.0)}).text(), "fronts.csv");
    std::vector<std::string> all;
    for (int row = 0; row < fronts.rows(); ++row)
        if (fronts.text_at(row, "front") == "all") all.push_back(fronts.text_at(row, "deformer"));
    EXPECT_EQ(all, (std::vector<std::string>{"lbs", "dqs", "delta_mush", "xpbd", "pbs", "fem_corotational"}));
    EXPECT_EQ(fronts.rows(), 6 + 7);
}

// One against another: outcome, from, told apart, holds beside.
std::vector<std::string> crossing(const Diagram& of, const std::string& one, const std::string& other)
{
    const CsvTable table = analysis::parse_csv(crossings_table({of}).text(), "crossings.csv");
    for (int row = 0; row < table.rows(); ++row)
        if (table.text_at(row, "deformer") == one && table.text_at(row, "other") == other)
            return {table.text_at(row, "outcome"), table.text_at(row, "from_ms"), table.text_at(row, "told_apart"),
                    table.text_at(row, "holds_beside")};
    return {};
}

TEST(DiagramTables, CrossingsTurnRoundWithTheErrors)
{
    EXPECT_EQ(crossing(diagram(30.0), "PBS", "delta mush"), (std::vector<std::string>{"from", "0.7", "1", "1"}));
    EXPECT_EQ(crossing(diagram(22.0), "PBS", "delta mush"), (std::vector<std::string>{"from", "0.7", "0", "1"}));  // within the bar of 6 %
    EXPECT_EQ(crossing(diagram(15.0), "PBS", "delta mush"), (std::vector<std::string>{"never", "", "", ""}));
    EXPECT_EQ(crossing(diagram(15.0), "LBS", "DQS")[0], "never");
    EXPECT_EQ(crossing(diagram(15.0), "delta mush", "PBS")[0], "always");
}

TEST(Findings, SayWhatTheFiguresSay)
{
    const std::vector<std::string> lines = findings(diagram(30.0));
    EXPECT_TRUE(says(lines, "below 0.5 ms a frame only LBS and DQS are there; delta mush is the next"));
    EXPECT_TRUE(says(lines, "from 100 ms nonlinear FEM is nearest: 5.0 % off"));
    EXPECT_TRUE(says(lines, "PBS is nearer than delta mush from 0.7 ms on"));
    EXPECT_TRUE(says(lines, "the physics takes 33 % off the error of geometry alone"));
    EXPECT_TRUE(says(lines, "1 of 7 points lie below that"));
    const std::vector<std::string> other = findings(diagram(16.0));
    EXPECT_TRUE(says({physics_text(diagram(30.0))},
                     "within the 0.5 ms of delta mush at its best, 20 iterations: delta mush 30.0 % off, PBS not so quick"));
    EXPECT_TRUE(says(other, "PBS does not stay nearer than delta mush"));
    EXPECT_TRUE(says(other, "the physics adds 25 % to the error of geometry alone"));
}

TEST(Findings, EveryDeformerOfTheStudyHasAGroup)
{
    EXPECT_EQ(group_of("xpbd_small_steps").words, "XPBD");
    EXPECT_THROW(group_of("wishful"), std::logic_error);
}

}  // namespace
