// The nearest class, and the shapes of a case's points, whose distances decide. Reference: analysis::ErrorMetrics for a distance,
// and the rule of pair_order.hpp by hand for an order.
#include "experiments/studies/work_precision/diagram.hpp"

#include "analysis/metrics/error_norms.hpp"
#include "pbs/geometry/input_error.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/comparison_records.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace experiments;
using namespace test_support;

TEST(RecordedShapes, HaveTheDistancesOfTheNormAtTheJoints)
{
    const pbs::Character bar = bar_character({6, 2, 2});
    analysis::ErrorDomain domain{bar.mesh.rest, bar.mesh.tets, {}, {}, bar.binding.distance};
    for (int v = 0; v < bar.mesh.rest.rows(); v += 2) domain.blended.push_back(v);
    const analysis::ErrorMetrics metrics(domain);
    std::vector<bool> all(bar.mesh.rest.rows(), false), fewer = all;
    fewer[domain.blended.front()] = fewer[domain.blended.back()] = true;
    pbs::Positions one = bar.mesh.rest, other = 1.1 * bar.mesh.rest;
    one.col(1) += 0.03 * one.col(0).cwiseAbs2();
    RecordedShapes shapes({metrics.joint_weights(all), {}, metrics.joint_weights(fewer)});
    for (const pbs::Positions* shape : {&one, static_cast<pbs::Positions*>(nullptr), &other}) shapes.add(shape);
    const RecordedShapes read = RecordedShapes::read(shapes.text());
    constexpr double in_f32 = 1e-5;  // relative: positions of 1 m have roundings of 6e-8 m, and the distance is 3 cm
    for (const auto& [reference, left_out] : {std::pair<std::size_t, std::vector<bool>>{0, all}, {2, fewer}}) {
        const double expected = metrics.measure(one, other, left_out).joint_pct;
        EXPECT_NEAR(read.distance_pct(0, 2, reference).value(), expected, in_f32 * expected);
        EXPECT_NEAR(read.distance_pct(2, 0, reference).value(), expected, in_f32 * expected);
    }
    EXPECT_NE(read.distance_pct(0, 2, 0), read.distance_pct(0, 2, 2));
    EXPECT_FALSE(read.distance_pct(0, 1, 0)) << "a row without a shape";
    EXPECT_FALSE(read.distance_pct(0, 2, 1)) << "a reference that was not reached";
    EXPECT_FALSE(read.distance_pct(0, 3, 0)) << "no such row";
    EXPECT_THROW(RecordedShapes::read(shapes.text().substr(0, 99)), pbs::InputError);
}

// One vertex at x of a line, of weight 1e-4, so that the distance in per cent is that of x.
std::shared_ptr<const RecordedShapes> on_a_line(const std::vector<double>& x_pct)
{
    RecordedShapes shapes({Eigen::VectorXd::Constant(1, 1e-4), Eigen::VectorXd::Constant(1, 1e-4)});
    for (const double x : x_pct) {
        const pbs::Positions at = pbs::Positions::Constant(1, 3, 0.0) + Eigen::RowVector3d(x, 0.0, 0.0);
        shapes.add(&at);
    }
    return std::make_shared<RecordedShapes>(shapes);
}

const SettingKey lbs = in_f64({"lbs"}), mush = in_f64({"delta_mush", 20}), xpbd = in_f64({"xpbd", 8});
SettingKey tuned(SettingKey key)
{
    key.tuned = "a";
    return key;
}

// LBS, delta mush, XPBD and PBS on one side of the reference at 30, 14, 13 and 10 %. PBS has a further setting, which training chooses, on
// `tuned_pct`, and its default one. The bound is 0.4 %.
CaseRecords on_one_side(double tuned_pct)
{
    const std::vector<double> x_pct = {30.0, 14.0, 13.0, 10.0, tuned_pct};
    const std::vector<SettingKey> keys = {lbs, mush, xpbd, pbs_24, tuned(pbs_24)};
    std::vector<HandPoint> points;
    for (std::size_t i = 0; i < keys.size(); ++i) points.push_back({keys[i], keys[i] == lbs ? 0.05 : 0.5, x_pct[i]});
    points.push_back(hand_reference());
    CaseRecords records{hand_case({.body = "limb", .pose = "a"}, points, Half::evaluation, 0.4)};
    records.shapes = on_a_line(x_pct);
    return records;
}

// A training pose in which the further setting is the better one.
CaseRows training()
{
    return hand_case({.body = "limb", .pose = "t"}, {{pbs_24, 0.5, 20.0}, {tuned(pbs_24), 0.5, 10.0}, hand_reference()}, Half::training);
}

NearestAnswers answers_of(const CaseRecords& records, const std::vector<CaseRecords>& further = {})
{
    std::vector<CaseRecords> cases = {records, {training()}};
    cases.insert(cases.end(), further.begin(), further.end());
    std::vector<CaseRows> rows;
    for (const CaseRecords& one : cases) rows.push_back(one.rows);
    return nearest_classes(diagrams_of(cases, choose_settings(rows)), diagrams_of(cases, default_settings(rows)));
}

const NearestAnswer& answer_within(const NearestAnswers& answers, double budget_ms, const std::string& among)
{
    return *std::ranges::find_if(answers.answers,
                                 [&](const NearestAnswer& one) { return one.of.budget_ms == budget_ms && one.of.among == among; });
}

TEST(NearestClass, IsDecidedIfBothSettingsDecideByTheDistanceOfTheShapes)
{
    // Between 9 and 14 % the gap of the squares is 115 and 2 x 5 x 0.4 = 4.
    const NearestAnswers answers = answers_of(on_one_side(9.0));
    const NearestAnswer& classes = answer_within(answers, 1.0, "classes");
    EXPECT_EQ(classes.nearest, "constraints");
    EXPECT_EQ(classes.point.key, tuned(pbs_24));
    EXPECT_EQ(classes.others, 2);
    EXPECT_EQ(classes.either_of, std::vector<std::string>{});
    EXPECT_EQ(answer_within(answers, 1.0, "constraints").nearest, "pbs");
    EXPECT_EQ(answer_within(answers, 1.0, "constraints").others, 1);
    EXPECT_EQ(answer_within(answers, 0.1, "classes").nearest, "blend");
    EXPECT_EQ(answer_within(answers, 0.1, "classes").others, 0);
    EXPECT_FALSE(answer_within(answers, 0.1, "classes").decision) << "nothing to decide";
    const auto pairs = std::ranges::count_if(
        answers.pairs, [](const NearestPair& one) { return one.of.comparison == Comparison::packed_f32 && one.of.budget_ms == 1.0; });
    EXPECT_EQ(pairs, 2 * 2 + 2) << "against blend, mush and XPBD in both settings";
}

// With a bound of 2 %, the sum of the errors of mush and PBS by default needs 14 - 10 > 2 x 2, and their distance needs 96 > 2 x 4 x 2.
TEST(NearestClass, NeedsNoMoreThanTheDistanceOfTwoShapesOnOneSide)
{
    CaseRecords records = on_one_side(9.0);
    for (PointRow& row : records.rows) row.reference_error_joint_pct = 2.0;
    EXPECT_EQ(answer_within(answers_of(records), 1.0, "classes").either_of, std::vector<std::string>{});
    records.shapes = nullptr;
    EXPECT_EQ(answer_within(answers_of(records), 1.0, "classes").either_of, std::vector<std::string>{"mush"});
}

// With the sum of the errors the mean difference of 4 may shift by 2 x 2, with the distance by 2 x 4 / (24 - 4) x 2.
TEST(NearestClass, OfAMeanNeedsTheDistancesToo)
{
    CaseRecords one = on_one_side(9.0);
    for (PointRow& row : one.rows) row.reference_error_joint_pct = 2.0;
    CaseRecords other = one;
    for (PointRow& row : other.rows) row.of.pose = "b";
    for (const bool are_known : {true, false}) {
        if (!are_known) one.shapes = other.shapes = nullptr;
        const NearestAnswers answers = answers_of(one, {other});
        const auto mean = std::ranges::find_if(answers.answers, [](const NearestAnswer& answer) {
            return answer.of.diagram == "mean_of_2_evaluated_poses" && answer.of.budget_ms == 1.0;
        });
        ASSERT_NE(mean, answers.answers.end());
        EXPECT_EQ(mean->either_of, are_known ? std::vector<std::string>{} : std::vector<std::string>{"mush"});
    }
}

TEST(NearestClass, IsEitherOfTwoWhereTheDefaultSettingsSayOtherwise)
{
    CaseRecords records = on_one_side(9.0);
    records.rows[3].error->joint_pct = 20.0;  // PBS by default
    records.shapes = on_a_line({30.0, 14.0, 13.0, 20.0, 9.0});
    const NearestAnswers answers = answers_of(records);
    EXPECT_EQ(answer_within(answers, 1.0, "classes").either_of, std::vector<std::string>{}) << "XPBD is the default of its class";
    EXPECT_EQ(answer_within(answers, 1.0, "constraints").either_of, std::vector<std::string>{"xpbd"});
    EXPECT_EQ(answer_within(answers, 1.0, "constraints").decision, analysis::PairDecision::models_disagree);
    const auto of_defaults = std::ranges::find_if(answers.pairs, [](const NearestPair& one) {
        return one.of.budget_ms == 1.0 && one.first == "pbs" && one.settings == SettingsOf::defaults;
    });
    EXPECT_EQ(of_defaults->by.order, analysis::PairOrder::second_is_closer);
    EXPECT_NEAR(of_defaults->by.distances.distance.value(), 7.0, 1e-6);
}

}  // namespace
