// Diagrams, their tables and their texts. Reference: a few points whose fronts and crossings are obvious; altered points must change the
// text.
#include "experiments/studies/work_precision/diagram.hpp"

#include "experiments/studies/work_precision/diagram_tables.hpp"
#include "experiments/studies/work_precision/findings.hpp"

#include "tests/support/comparison_records.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace {

using namespace experiments;
using analysis::CaseKey;
using analysis::CsvTable;
using test_support::hand_case;
using test_support::hand_diagrams;
using test_support::hand_reference;
using test_support::HandPoint;
using test_support::mean_error;

const CaseKey bent_limb = {.body = "limb", .motion = "bend", .angle_deg = 90.0};

SettingKey in_f64(SettingKey key)
{
    key.precision = "f64";
    return key;
}
const SettingKey pbs_24 = in_f64({"pbs", 24, 0.2, "ordered"});

// All in plain f64, which takes part in both comparisons; the first diagrams are those of packed_f32.
std::vector<HandPoint> rows(double mush_pct)
{
    return {{in_f64({"lbs"}), 0.01, 60.0},
            {in_f64({"dqs"}), 0.02, 50.0},
            {in_f64({"delta_mush", 20}), 0.5, mush_pct},
            {pbs_24, 0.7, 20.0},
            {in_f64({"xpbd", 8}), 0.65, 25.0},
            {in_f64({.deformer = "fem_linear", .element_order = 1}), 5.0, 30.0},
            {in_f64({.deformer = "fem_corotational", .element_order = 1}), 100.0, 5.0},
            hand_reference()};
}

Diagram diagram(double mush_pct)
{
    return hand_diagrams({hand_case(bent_limb, rows(mush_pct))}).front();
}

std::vector<std::string> keys_of(const std::vector<Diagram>& diagrams, Comparison comparison)
{
    std::vector<std::string> keys;
    for (const Diagram& one : diagrams)
        if (one.comparison == comparison) keys.push_back(one.key);
    return keys;
}

const Diagram& of_key(const std::vector<Diagram>& diagrams, const std::string& key)
{
    return *std::ranges::find(diagrams, key, &Diagram::key);
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

TEST(Diagram, ThereIsOneForEachComparison)
{
    SettingKey packed = pbs_24;
    packed.precision = "f32", packed.packed = true;
    const std::vector<Diagram> both =
        hand_diagrams({hand_case(bent_limb, {{in_f64({"lbs"}), 0.01, 60.0}, {pbs_24, 5.0, 20.0}, {packed, 0.7, 20.0}, hand_reference()})});
    ASSERT_EQ(both.size(), 2u);
    EXPECT_EQ(both[0].comparison, Comparison::packed_f32);
    EXPECT_EQ(both[0].points.at(1).ms, 0.7);
    EXPECT_EQ(both[1].comparison, Comparison::plain_f64);
    EXPECT_EQ(both[1].points.at(1).ms, 5.0);
    for (const Diagram& one : both) EXPECT_EQ(one.points.at(0).key.deformer, "lbs");
}

TEST(Diagram, AMeanTakesThreeEvaluatedPosesAndTheSettingsThatAllOfThemHave)
{
    std::vector<HandPoint> other = rows(36.0), without = rows(24.0);
    without.erase(without.begin() + 1);  // no DQS
    const std::vector<CaseRows> two = {hand_case({.body = "limb", .pose = "a"}, rows(30.0)),
                                       hand_case({.body = "limb", .pose = "b"}, other),
                                       hand_case({.body = "limb", .pose = "t"}, rows(99.0), Half::training)};
    EXPECT_EQ(keys_of(hand_diagrams(two), Comparison::packed_f32),
              (std::vector<std::string>{"limb_a", "limb_b", "limb_t", "mean_of_2_evaluated_poses"}));
    std::vector<CaseRows> three = two;
    three.push_back(hand_case({.body = "limb", .pose = "c"}, without));
    const std::vector<Diagram> diagrams = hand_diagrams(three);
    for (const char* key : {"limb_mean_of_3_poses", "mean_of_3_evaluated_poses"}) {
        const Diagram& mean = of_key(diagrams, key);
        EXPECT_EQ(mean.points.size(), 6u);
        EXPECT_NEAR(mean.points[1].error_pct, 30.0, mean_error(3, 30.0));
        EXPECT_NEAR(mean.points[1].ms_q1.value(), 0.5, mean_error(3, 0.5));
        EXPECT_FALSE(mean.points[1].ms_q3);
        EXPECT_EQ(mean.poses, 3);
    }
    EXPECT_EQ(of_key(diagrams, "limb_mean_of_3_poses").name, "limb, mean of 3 poses");
}

TEST(Diagram, AMeanHasTheFurtherReferencesThatAllPosesHave)
{
    std::vector<CaseRecords> cases = {{hand_case({.body = "limb", .pose = "a"}, rows(30.0))},
                                      {hand_case({.body = "limb", .pose = "b"}, rows(30.0))}};
    const auto member = [](const std::string& name, double bound_pct) {
        FamilyRow row;
        row.member.name = name;
        row.outcome = "reached";
        row.error_bound_pct = bound_pct;
        return row;
    };
    cases[0].members = {member("stiffer_springs", 1.0), member("nu_0.3", 2.0)};
    cases[1].members = {member("stiffer_springs", 3.0)};
    cases[0].rows[3].members[0] = 8.0, cases[1].rows[3].members[0] = 10.0;
    const std::vector<Diagram> diagrams = diagrams_of(cases, choose_settings({cases[0].rows, cases[1].rows}));
    const Diagram& mean = of_key(diagrams, "mean_of_2_evaluated_poses");
    EXPECT_TRUE(mean.members[0].takes_part);
    EXPECT_NEAR(mean.members[0].bound_pct.value(), 2.0, mean_error(2, 3.0));
    EXPECT_FALSE(mean.members[3].takes_part);
    EXPECT_NEAR(mean.points[3].members[0].value(), 9.0, mean_error(2, 10.0));
    EXPECT_FALSE(mean.points[2].members[0]);
}

TEST(Diagram, AMeanThrowsNoBodyOfManyPosesTogetherWithOthersOfOne)
{
    std::vector<CaseRows> tables;
    for (const char* pose : {"crouch", "standing", "folded"}) tables.push_back(hand_case({.body = "human", .pose = pose}, rows(30.0)));
    for (const char* body : {"man", "lady"}) tables.push_back(hand_case({.body = body, .pose = "crouch"}, rows(60.0)));
    for (const char* motion : {"twist", "bend"})
        tables.push_back(hand_case({.body = "limb", .motion = motion, .angle_deg = 90.0}, rows(90.0)));
    const std::vector<Diagram> diagrams = hand_diagrams(tables);
    const Diagram &human = of_key(diagrams, "human_mean_of_3_poses"), &crouch = of_key(diagrams, "crouch_mean_of_3_bodies");
    EXPECT_NEAR(human.points[2].error_pct, 30.0, mean_error(3, 30.0));
    EXPECT_NEAR(crouch.points[2].error_pct, 50.0, mean_error(3, 50.0));
    EXPECT_TRUE(says(findings(human), "4 % of the volume, where the reference overlaps itself, is left out"));
    EXPECT_TRUE(says(findings(diagrams[2]), "12 % of the volume, where the reference overlaps itself, is left out"));
    EXPECT_FALSE(says(findings(crouch), "left out"));
}

TEST(Diagram, WithoutAReferenceHasNoPointsAndSaysSo)
{
    std::vector<HandPoint> unreached = rows(30.0);
    for (HandPoint& row : unreached) row.error_pct.reset();
    unreached.back().outcome = "not_reached";
    const Diagram empty = hand_diagrams({hand_case(bent_limb, unreached)}).front();
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

// One against another: outcome, from, decision.
std::vector<std::string> crossing(const Diagram& of, const std::string& one, const std::string& other)
{
    const CsvTable table = analysis::parse_csv(crossings_table({of}).text(), "crossings.csv");
    for (int row = 0; row < table.rows(); ++row)
        if (table.text_at(row, "deformer") == one && table.text_at(row, "other") == other)
            return {table.text_at(row, "outcome"), table.text_at(row, "from_ms"), table.text_at(row, "decision")};
    return {};
}

TEST(DiagramTables, CrossingsTurnRoundWithTheErrors)
{
    EXPECT_EQ(crossing(diagram(33.0), "pbs", "delta_mush"), (std::vector<std::string>{"from", "0.7", "decided"}));
    EXPECT_EQ(crossing(diagram(31.0), "pbs", "delta_mush"),
              (std::vector<std::string>{"from", "0.7", "reference_error"}));  // by less than 12 %
    EXPECT_EQ(crossing(diagram(15.0), "pbs", "delta_mush"), (std::vector<std::string>{"never", "", ""}));
    EXPECT_EQ(crossing(diagram(15.0), "lbs", "dqs")[0], "never");
    EXPECT_EQ(crossing(diagram(15.0), "delta_mush", "pbs")[0], "always");
}

TEST(DiagramTables, WithinABudgetGroupsAreRankedByTheirBestPoints)
{
    const std::vector<BudgetRow> ranked = best_within(diagram(33.0), 1.0);
    std::vector<std::string> groups;
    for (const BudgetRow& row : ranked) groups.push_back(row.group);
    EXPECT_EQ(groups, (std::vector<std::string>{"pbs", "xpbd", "delta_mush", "dqs", "lbs"}));
    EXPECT_EQ(ranked[0].decision, analysis::PairDecision::reference_error);    // 25 - 20 < 2 x 6
    EXPECT_EQ(ranked[0].undecided_against, std::vector<std::string>{"xpbd"});  // 33 - 20 > 2 x 6
    EXPECT_EQ(ranked[2].decision, analysis::PairDecision::decided);            // 50 - 33 > 2 x 6
    EXPECT_TRUE(ranked[2].undecided_against.empty());
    EXPECT_FALSE(ranked.back().decision);
    EXPECT_EQ(ranked.back().rank, 5);
    EXPECT_EQ(best_within(diagram(33.0), 0.01).size(), 1u);
    EXPECT_TRUE(best_within(diagram(33.0), 0.001).empty());
}

// The next group is decided, since all references order the two. The group after it is not, since the order of a further reference is the
// other way round.
TEST(DiagramTables, TheNearestGroupIsComparedWithAllOthersInTablesAndSentences)
{
    CaseRecords records = {hand_case(
        bent_limb, {{pbs_24, 0.7, 20.0}, {in_f64({"xpbd", 8}), 0.65, 40.0}, {in_f64({"delta_mush", 20}), 0.5, 60.0}, hand_reference()})};
    FamilyRow member;
    member.member.name = "nu_0.3";
    member.outcome = "reached";
    member.error_bound_pct = 1.0;
    records.members = {member};
    const double against_pct[] = {20.0, 40.0, 5.0};
    for (std::size_t i = 0; i < 3; ++i) records.rows[i].members[3] = against_pct[i];
    const Diagram of = diagrams_of({records}, choose_settings({records.rows})).front();
    const std::vector<BudgetRow> ranked = best_within(of, 1.0);
    ASSERT_EQ(ranked.size(), 3u);
    EXPECT_EQ(ranked[0].decision, analysis::PairDecision::models_disagree);
    EXPECT_EQ(ranked[0].undecided_against, std::vector<std::string>{"delta_mush"});
    EXPECT_TRUE(says(findings(of),
                     "next is XPBD (xpbd, iterations 8, precision f64: 40.0 %) [undecided against delta mush: the order is the "
                     "other way round for nu_0.3]"));
    const CsvTable fronts = analysis::parse_csv(fronts_table({of}).text(), "fronts.csv");
    for (int row = 0; row < fronts.rows(); ++row) {
        const bool is_pbs = fronts.text_at(row, "deformer") == "pbs", is_of_all = fronts.text_at(row, "front") == "all";
        const bool is_decided_here = is_of_all && fronts.text_at(row, "measure") == "error_joint_pct";
        if (!is_pbs) continue;
        EXPECT_EQ(fronts.text_at(row, "decision"), is_decided_here ? "models_disagree" : "") << row;
    }
}

TEST(DiagramTables, WithinABudgetRowsHaveTheKeyOfTheirSetting)
{
    const std::vector<BudgetRow> ranked = best_within(std::vector{diagram(30.0)});
    const auto xpbd = std::ranges::find(ranked, "xpbd", &BudgetRow::group);
    ASSERT_NE(xpbd, ranked.end());
    const CsvTable table = analysis::parse_csv(table_of(budget_columns, ranked).text(), "best_within.csv");
    const int row = static_cast<int>(xpbd - ranked.begin());
    EXPECT_EQ(table.text_at(row, "deformer"), "xpbd");
    EXPECT_EQ(table.integer(row, "iterations"), 8);
    EXPECT_EQ(rows_of(budget_columns, table)[row].point.key, xpbd->point.key);
    EXPECT_EQ(rows_of(budget_columns, table)[row].decision, xpbd->decision);
}

TEST(DiagramTables, TheFrontOfAllStatesWhetherItsPointsAreDecided)
{
    const CsvTable fronts = analysis::parse_csv(fronts_table({diagram(33.0)}).text(), "fronts.csv");
    std::vector<std::string> decisions;
    for (int row = 0; row < fronts.rows(); ++row)
        if (fronts.text_at(row, "front") == "all" && fronts.text_at(row, "measure") == "error_joint_pct")
            decisions.push_back(fronts.text_at(row, "decision"));
    // LBS is alone; DQS by 10, delta mush by 17, XPBD by 8, PBS by 5 and FEM by 15 points, of which 12 are needed.
    EXPECT_EQ(decisions, (std::vector<std::string>{"", "reference_error", "decided", "reference_error", "reference_error", "decided"}));
}

TEST(Findings, SayWhatTheFiguresSay)
{
    const std::vector<std::string> lines = findings(diagram(33.0));
    EXPECT_TRUE(says(lines,
                     "within 1 ms per frame PBS (pbs, iterations 24, k_stretch 0.2, order ordered, precision f64: 20.0 %) is nearest; "
                     "next is XPBD (xpbd, iterations 8, precision f64: 25.0 %) [undecided against XPBD: within the reference's own error"));
    EXPECT_TRUE(says(lines, "within 0.1 ms per frame DQS (dqs, precision f64: 50.0 %) is nearest; next is LBS"));
    EXPECT_TRUE(says(lines, "within 100 ms per frame nonlinear FEM"));
    EXPECT_TRUE(says(lines, "[decided by 1 reference]"));
    EXPECT_TRUE(says(lines, "below 0.5 ms per frame there are only LBS and DQS; delta mush is next"));
    EXPECT_TRUE(says(lines, "PBS is nearer than delta mush from 0.7 ms on"));
    EXPECT_TRUE(says(lines, "within 1 ms the physics of PBS reduces the error of delta mush, geometry alone, by 39 %"));
    EXPECT_TRUE(says(
        lines, "the reference (reference, element_order 2, refined), which takes 9000 ms, has an error of at most 6 %, and 1 of 7 points"));
    EXPECT_TRUE(says(lines, "linear FEM is not nearer than PBS from any time on (least errors 30.0 and 20.0 %) [undecided: within"));
    const std::vector<std::string> other = findings(diagram(16.0));
    EXPECT_TRUE(says(other, "PBS is not nearer than delta mush"));
    EXPECT_TRUE(says(other, "within 1 ms the physics of PBS increases the error of delta mush, geometry alone, by 25 % [undecided"));
}

TEST(Settings, AreNamedByTheirKeysInOnePlace)
{
    EXPECT_EQ(text_of({"lbs"}), "lbs");
    EXPECT_EQ(text_of({.deformer = "delta_mush", .iterations = 0}), "delta_mush, iterations 0");
    EXPECT_EQ(text_of({.deformer = "pbs", .iterations = 4, .k_stretch = 0.2, .order = "ordered", .precision = "f32"}),
              "pbs, iterations 4, k_stretch 0.2, order ordered, precision f32");
    EXPECT_EQ(text_of({.deformer = "pbs", .iterations = 4, .substeps = 2, .wanted_vertices = 300}),
              "pbs, iterations 4, substeps 2, wanted_vertices 300");
    EXPECT_EQ(text_of({.deformer = "pbs", .iterations = 4, .precision = "f32", .tuned = "k_stretch_0.9", .packed = true}),
              "pbs, iterations 4, precision f32, tuned k_stretch_0.9, packed");
    EXPECT_EQ(text_of({.deformer = "pbs", .iterations = 4, .k_stretch = 0.9, .substeps = 1, .tuned = "k_stretch_0.9"}),
              "pbs, iterations 4, tuned k_stretch_0.9");
    EXPECT_EQ(text_of({.deformer = "fem_linear", .element_order = 1, .refined = true}), "fem_linear, element_order 1, refined");
}

// Its precision is not known, so that it takes part in both comparisons.
TEST(Settings, OfADeformerOfTheUsersOwnHaveNoPrecision)
{
    DeformerSpec spec = default_spec("external");
    spec.name = "mine";
    const SettingKey key = key_of(external_settings({spec}).at(0));
    EXPECT_EQ(text_of(key), "mine");
    for (const Comparison comparison : comparisons) EXPECT_TRUE(takes_part(comparison, key, {{"pbs", 3}}));
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
    std::vector<HandPoint> with = rows(30.0);
    const std::string model = "fem_neo_hookean";
    with.push_back({in_f64({.deformer = model, .element_order = 1}), 90.0, 9.0});
    EXPECT_FALSE(says(findings(hand_diagrams({hand_case(bent_limb, with)}).front()), "refinement"));
    with.push_back({in_f64({.deformer = model, .element_order = 1, .refined = true}), 800.0, 3.0});
    EXPECT_TRUE(says(findings(hand_diagrams({hand_case(bent_limb, with)}).front()),
                     "order 1 has an error of 9.0 % on the case's own tets and of 3.0 %"));
}

}  // namespace
