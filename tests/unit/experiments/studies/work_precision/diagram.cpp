// Diagrams, their tables and their texts. Reference: a few points whose fronts and crossings are obvious; altered points must change the
// text.
#include "experiments/studies/work_precision/diagram.hpp"

#include "experiments/studies/work_precision/certainty.hpp"
#include "experiments/studies/work_precision/diagram_tables.hpp"
#include "experiments/studies/work_precision/findings.hpp"

#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace {

using namespace experiments;
using analysis::CaseKey;
using analysis::CsvTable;
using test_support::mean_error;

struct Row {
    SettingKey key;
    double ms;
    std::optional<double> error_pct;
    std::string outcome = "finished";
};

std::vector<PointRow> points(const CaseKey& of, const std::vector<Row>& rows)
{
    constexpr double bar_pct = 6.0;
    std::vector<PointRow> points;
    for (const Row& row : rows) {
        PointRow& point = points.emplace_back(PointRow{of, row.key});
        point.outcome = row.outcome;
        point.ms_median = point.ms_q1 = row.ms;
        if (row.error_pct) point.error = {.l2_pct = *row.error_pct, .joint_pct = *row.error_pct, .linf_m = std::nan("")};
        point.reach_ms = 10.0 * row.ms;
        point.reference = "neo_hookean";
        point.reference_error_joint_pct = bar_pct;
        point.below_reference_error = row.error_pct.value_or(99.0) <= bar_pct;
        point.metrics.volume_abs_change_pct = 10.0 / row.ms;
        point.masked_share_pct = of.pose == "folded" ? 12.0 : 0.0;
    }
    return points;
}

const CaseKey bent_limb = {.body = "limb", .motion = "bend", .angle_deg = 90.0};
const SettingKey pbs_24 = {"pbs", 24, 0.2, "ordered", "f32", 1};

std::vector<Row> rows(double mush_pct)
{
    return {{{"lbs"}, 0.01, 60.0},
            {{"dqs"}, 0.02, 50.0},
            {{"delta_mush", 20}, 0.5, mush_pct},
            {pbs_24, 0.7, 20.0},
            {{"xpbd", 8}, 0.65, 25.0},
            {{.deformer = "fem_linear", .element_order = 1}, 5.0, 30.0},
            {{.deformer = "fem_corotational", .element_order = 1}, 100.0, 5.0},
            {{.deformer = "reference", .element_order = 2, .refined = true}, 900.0, std::nullopt, "reference"}};
}

Diagram diagram(double mush_pct)
{
    return diagrams_of({points(bent_limb, rows(mush_pct))}).front();
}

bool says(const std::vector<std::string>& lines, const std::string& text)
{
    return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

TEST(Diagram, HoldsThePointsWithTimeAndErrorAndTheReferenceBeside)
{
    const Diagram read = diagram(30.0);
    EXPECT_EQ(read.name, "limb, bend, 90 deg");
    EXPECT_EQ(read.key, "limb_bend_90");
    EXPECT_EQ(read.points.size(), 7u);
    EXPECT_EQ(read.reference, "reference, element_order 2, refined");
    EXPECT_EQ(read.reference_ms, 9000.0);
    EXPECT_EQ(read.reference_error_pct, 6.0);
    EXPECT_TRUE(read.points.back().below_reference_error);
}

TEST(Diagram, AMeanTakesThreePosesAndTheSettingsThatAllOfThemHave)
{
    std::vector<Row> other = rows(36.0), without = rows(24.0);
    without.erase(without.begin() + 1);  // no DQS
    const auto two = diagrams_of({points({.body = "limb", .pose = "a"}, rows(30.0)), points({.body = "limb", .pose = "b"}, other)});
    EXPECT_EQ(two.size(), 2u);
    const auto three = diagrams_of({points({.body = "limb", .pose = "a"}, rows(30.0)), points({.body = "limb", .pose = "b"}, other),
                                    points({.body = "limb", .pose = "c"}, without)});
    ASSERT_EQ(three.size(), 4u);
    const Diagram& mean = three[3];
    EXPECT_EQ(mean.name, "limb, mean of 3 poses");
    EXPECT_EQ(mean.key, "limb_mean_of_3_poses");
    EXPECT_EQ(mean.points.size(), 6u);
    EXPECT_NEAR(mean.points[1].error_pct, 30.0, mean_error(3, 30.0));
    EXPECT_NEAR(mean.points[1].ms_q1.value(), 0.5, mean_error(3, 0.5));
    EXPECT_FALSE(mean.points[1].ms_q3);
}

TEST(Diagram, AMeanThrowsNoBodyOfManyPosesTogetherWithOthersOfOne)
{
    std::vector<std::vector<PointRow>> tables;
    for (const char* pose : {"crouch", "standing", "folded"}) tables.push_back(points({.body = "human", .pose = pose}, rows(30.0)));
    for (const char* body : {"man", "lady"}) tables.push_back(points({.body = body, .pose = "crouch"}, rows(60.0)));
    for (const char* motion : {"twist", "bend"})
        tables.push_back(points({.body = "limb", .motion = motion, .angle_deg = 90.0}, rows(90.0)));
    const auto diagrams = diagrams_of(tables);
    ASSERT_EQ(diagrams.size(), 9u);
    EXPECT_EQ(diagrams[7].name, "human, mean of 3 poses");
    EXPECT_NEAR(diagrams[7].points[2].error_pct, 30.0, mean_error(3, 30.0));
    EXPECT_EQ(diagrams[8].name, "crouch, mean of 3 bodies");
    EXPECT_NEAR(diagrams[8].points[2].error_pct, 50.0, mean_error(3, 50.0));
    EXPECT_TRUE(says(findings(diagrams[7]), "4 % of the volume, where the reference overlaps itself, is left out"));
    EXPECT_TRUE(says(findings(diagrams[2]), "12 % of the volume, where the reference overlaps itself, is left out"));
    EXPECT_FALSE(says(findings(diagrams[8]), "left out"));
}

TEST(Diagram, WithoutAReferenceHasNoPointsAndSaysSo)
{
    std::vector<Row> unreached = rows(30.0);
    for (Row& row : unreached) row.error_pct.reset(), row.outcome = "finished";
    unreached.back().outcome = "not_converged";
    const Diagram empty = diagrams_of({points(bent_limb, unreached)}).front();
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
        if (fronts.text_at(row, "front") == "all" && fronts.text_at(row, "measure") == "error_joint_pct")
            all.push_back(fronts.text_at(row, "deformer"));
    EXPECT_EQ(all, (std::vector<std::string>{"lbs", "dqs", "delta_mush", "xpbd", "pbs", "fem_corotational"}));
    // Joints and L2 are the same here; the maximum is unknown. The volume falls with time, so all points are on its front.
    EXPECT_EQ(fronts.rows(), 2 * (6 + 7) + (7 + 7));
    EXPECT_EQ(fronts.text_at(0, "ms_q3"), "");
    EXPECT_EQ(fronts.text_at(fronts.rows() - 1, "measure"), "volume_abs_change_pct");
    EXPECT_EQ(fronts.number(fronts.rows() - 1, "value"), 0.1);
}

// One against another: outcome, from, decided.
std::vector<std::string> crossing(const Diagram& of, const std::string& one, const std::string& other)
{
    const CsvTable table = analysis::parse_csv(crossings_table({of}).text(), "crossings.csv");
    for (int row = 0; row < table.rows(); ++row)
        if (table.text_at(row, "deformer") == one && table.text_at(row, "other") == other)
            return {table.text_at(row, "outcome"), table.text_at(row, "from_ms"), table.text_at(row, "decided")};
    return {};
}

TEST(DiagramTables, CrossingsTurnRoundWithTheErrors)
{
    EXPECT_EQ(crossing(diagram(33.0), "pbs", "delta_mush"), (std::vector<std::string>{"from", "0.7", "1"}));
    EXPECT_EQ(crossing(diagram(31.0), "pbs", "delta_mush"), (std::vector<std::string>{"from", "0.7", "0"}));  // by less than 2 x 6 %
    EXPECT_EQ(crossing(diagram(15.0), "pbs", "delta_mush"), (std::vector<std::string>{"never", "", ""}));
    EXPECT_EQ(crossing(diagram(15.0), "lbs", "dqs")[0], "never");
    EXPECT_EQ(crossing(diagram(15.0), "delta_mush", "pbs")[0], "always");
}

TEST(Certainty, IsADifferenceOfMoreThanTwiceTheBound)
{
    const auto of = [](const Diagram& diagram) { return is_certain(diagram, diagram.points[3], diagram.points[2]); };
    EXPECT_EQ(of(diagram(33.0)), true);  // 33 - 20 > 2 x 6
    EXPECT_EQ(of(diagram(31.0)), false);
    Diagram without = diagram(33.0);
    without.reference_error_pct.reset();
    EXPECT_EQ(of(without), std::nullopt);
}

TEST(Certainty, FromATimeOnIsThatOfAllLaterTimes)
{
    std::vector<Row> later = rows(33.0);
    later.push_back({{"delta_mush", 50}, 2.0, 21.0});
    const Diagram closer = diagrams_of({points(bent_limb, later)}).front();
    EXPECT_EQ(is_certain_from(diagram(33.0), group_of("pbs"), group_of("delta_mush"), 0.7), true);
    EXPECT_EQ(is_certain_from(closer, group_of("pbs"), group_of("delta_mush"), 0.7), false);
    EXPECT_EQ(is_certain_from(closer, group_of("pbs"), group_of("pbs_exponent"), 0.0), std::nullopt);
}

TEST(Certainty, IsRemarkedBehindTheSentence)
{
    const auto pbs_or_mush = [](const Diagram& diagram) {
        for (const std::string& line : findings(diagram))
            if (line.starts_with("PBS is nearer than delta mush")) return line;
        return std::string();
    };
    EXPECT_TRUE(pbs_or_mush(diagram(33.0)).ends_with("20.0 %)"));
    EXPECT_TRUE(pbs_or_mush(diagram(31.0)).ends_with("[undecided: within the reference's own error of up to 6 %]"));
    Diagram without = diagram(33.0);
    without.reference_error_pct.reset();
    EXPECT_TRUE(pbs_or_mush(without).ends_with("[undecided: the reference's own error is not known]"));
}

TEST(Findings, SayWhatTheFiguresSay)
{
    const std::vector<std::string> lines = findings(diagram(30.0));
    EXPECT_TRUE(says(lines, "below 0.5 ms per frame there are only LBS and DQS; delta mush is next"));
    EXPECT_TRUE(says(lines, "PBS is nearer than delta mush from 0.7 ms on"));
    EXPECT_TRUE(says(lines, "the physics reduces the error of geometry alone by 33 %"));
    EXPECT_TRUE(
        says(lines,
             "the reference (reference, element_order 2, refined), which takes 9000 ms, has an own error of up to 6 %, and 1 of 7 points"));
    EXPECT_TRUE(says(lines, "linear FEM does not remain nearer than PBS at any time (30.0 and 20.0 % at best) [undecided: within"));
    const std::vector<std::string> other = findings(diagram(16.0));
    EXPECT_TRUE(says(
        lines,
        "within the 0.5 ms of delta mush at its best (delta_mush, iterations 20) the errors are: delta mush 30.0 %, PBS none as fast"));
    EXPECT_TRUE(says(other, "PBS does not remain nearer than delta mush"));
    EXPECT_TRUE(says(other, "the physics increases the error of geometry alone by 25 %"));
}

TEST(Diagram, BudgetsArePbsWithDefaultsOnTheCasesOwnMesh)
{
    std::vector<Row> with = rows(30.0);
    SettingKey coarser = pbs_24, stiffer = pbs_24, fewer = pbs_24;
    coarser.wanted_vertices = 300, stiffer.k_stretch = 0.9, fewer.iterations = 4;
    for (const SettingKey& key : {coarser, stiffer, fewer}) with.push_back({key, 0.3, 22.0});
    const std::vector<DiagramPoint> budgets = budgets_of(diagrams_of({points(bent_limb, with)}).front());
    ASSERT_EQ(budgets.size(), 2u);
    EXPECT_EQ(budgets[0].key, fewer);
    EXPECT_EQ(budgets[1].key, pbs_24);
}

TEST(DiagramTables, AtEqualCostRowsHaveTheKeyOfTheirSetting)
{
    const std::vector<BudgetRow> equal = equal_cost({diagram(30.0)});
    const auto xpbd = std::ranges::find(equal, "xpbd", &BudgetRow::group);
    ASSERT_NE(xpbd, equal.end());
    EXPECT_EQ(xpbd->budget_iterations, 24);
    const CsvTable table = analysis::parse_csv(table_of(budget_columns, equal).text(), "equal_cost.csv");
    const int row = static_cast<int>(xpbd - equal.begin());
    EXPECT_EQ(table.text_at(row, "deformer"), "xpbd");
    EXPECT_EQ(table.integer(row, "iterations"), 8);
    EXPECT_EQ(rows_of(budget_columns, table)[row].point.key, xpbd->point.key);
}

TEST(Settings, AreNamedByTheirKeysInOnePlace)
{
    EXPECT_EQ(text_of({"lbs"}), "lbs");
    EXPECT_EQ(text_of({.deformer = "delta_mush", .iterations = 0}), "delta_mush, iterations 0");
    EXPECT_EQ(text_of({.deformer = "pbs", .iterations = 4, .k_stretch = 0.2, .order = "ordered", .precision = "f32"}),
              "pbs, iterations 4, k_stretch 0.2, order ordered, precision f32");
    EXPECT_EQ(text_of({.deformer = "pbs", .iterations = 4, .substeps = 2, .wanted_vertices = 300}),
              "pbs, iterations 4, substeps 2, wanted_vertices 300");
    EXPECT_EQ(text_of({.deformer = "fem_linear", .element_order = 1, .refined = true}), "fem_linear, element_order 1, refined");
}

TEST(Findings, EveryDeformerOfTheStudyHasAGroup)
{
    EXPECT_EQ(group_of("xpbd_small_steps").words, "XPBD");
    EXPECT_THROW(group_of("wishful"), std::logic_error);
    EXPECT_EQ(group_named("linear_fem").words, "linear FEM");
    EXPECT_THROW(group_named("linear FEM"), std::logic_error);
}

TEST(WorkPrecisionFindings, OneRefinementIsToldWhereBothSolutionsAreThere)
{
    std::vector<Row> with = rows(30.0);
    const std::string model = "fem_neo_hookean";
    with.push_back({{.deformer = model, .element_order = 1}, 90.0, 9.0});
    EXPECT_FALSE(says(findings(diagrams_of({points(bent_limb, with)}).front()), "refinement"));
    with.push_back({{.deformer = model, .element_order = 1, .refined = true}, 800.0, 3.0});
    EXPECT_TRUE(says(findings(diagrams_of({points(bent_limb, with)}).front()),
                     "order 1 has an error of 9.0 % on the case's own tets and of 3.0 %"));
}

}  // namespace
