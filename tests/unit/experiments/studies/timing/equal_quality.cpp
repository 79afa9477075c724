// The rows and the report by hand, the orders against random ones, and the tapered limb.
#include "experiments/studies/timing/timing.hpp"

#include "analysis/statistics/statistics.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/iteration_paths.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

namespace {

using namespace test_support;
using namespace experiments;

// Reference: paths of iterations that are defined by formulas, whose times and targets are found by hand.

MeasuredOrder measured(const std::string& order, const std::string& sequence, IterationPath path, double ms)
{
    return {order, "f32", sequence, std::move(path), {ms, ms, ms, 5}};
}

// 4, 2, 4/3, 1 ...: at or below 1 from iteration 3 on.
IterationPath falling(int most)
{
    return path_by(most, [](int n) { return 4.0 / (n + 1); });
}

TEST(FirstWithin, IsTheFirstLookNotAboveTheBound)
{
    const auto first = [](const IterationPath& path, double bound) {
        return first_within(path, &Look::combined, bound);
    };
    EXPECT_EQ(first(falling(10), 1.0), 3);
    EXPECT_EQ(first(falling(10), 4.0), 0);
    EXPECT_EQ(first(falling(10), 0.1), std::nullopt);
    EXPECT_EQ(first({}, 1.0), std::nullopt);
    EXPECT_EQ(first(path_by(10, [](int n) { return std::abs(n - 5.0); }), 1.0), 4)
        << "it rises again and has reached it";
    EXPECT_EQ(first(path_by(3, [](int) { return std::numeric_limits<double>::quiet_NaN(); }), 1.0), std::nullopt);
}

TEST(TargetRows, IterationsAndTimeToPlainsResidual)
{
    const analysis::CaseKey of = {.body = "limb"};
    // plain: 4 / 25 = 0.16 after 24 iterations; the other order halves its value in each iteration: 4, 2, 1, 1/2, 1/4,
    // 1/8.
    const std::vector<MeasuredOrder> all = {measured("plain", file_sequence, falling(100), 2.0),
                                            measured("ordered", "random_1", path_to_floor(100, 0.0, 4.0, 0.5), 0.25)};
    const std::vector<TargetRow> rows = target_rows(of, all);
    ASSERT_EQ(rows.size(), 2u * 4);
    EXPECT_EQ(rows[0].target, "residual_of_plain");
    EXPECT_DOUBLE_EQ(rows[0].bound, 0.16);
    EXPECT_EQ(rows[0].iterations, 24);
    EXPECT_DOUBLE_EQ(*rows[0].ms, 48.0);
    EXPECT_EQ(rows[4].of.order, "ordered");
    EXPECT_EQ(rows[4].sequence, "random_1");
    EXPECT_EQ(rows[4].iterations, 5);
    EXPECT_DOUBLE_EQ(*rows[4].ms, 1.25);
}

TEST(TargetRows, AnOrderWithAHigherLimitNeverReachesIt)
{
    const std::vector<MeasuredOrder> all = {measured("plain", file_sequence, falling(100), 2.0),
                                            measured("ordered", file_sequence, path_to_floor(100, 1.0, 3.0, 0.5), 0.2)};
    const std::vector<TargetRow> rows = target_rows({}, all);
    ASSERT_EQ(rows.size(), 8u);
    for (std::size_t i = 4; i < 8; ++i) {
        const bool within = rows[i].bound >= 1.0;  // 2 % alone is above its limit
        EXPECT_EQ(rows[i].reached, within) << rows[i].target;
        EXPECT_EQ(rows[i].iterations.has_value(), within);
        EXPECT_EQ(rows[i].ms.has_value(), within);
        EXPECT_NEAR(rows[i].limit, 1.0, 1e-15);
    }
}

// The table is read as it was written.
TEST(TargetRows, AreReadBackAndThereAreNoneWithoutPlainInFileOrder)
{
    const std::vector<MeasuredOrder> all = {measured("plain", file_sequence, falling(30), 2.0)};
    const std::vector<TargetRow> read =
        rows_of(target_columns, table_of(target_columns, target_rows({.body = "limb"}, all)));
    ASSERT_EQ(read.size(), 4u);
    EXPECT_EQ(read[0].iterations, 24);
    EXPECT_EQ(read[3].iterations, 7);  // 4 / 8 = 0.5
    EXPECT_THROW(target_rows({}, {measured("plain", spread_sequence, falling(30), 1.0)}), std::logic_error);
}

TEST(OrderRows, ValuesAfter24AndInTheLimit)
{
    const std::vector<OrderRow> rows =
        order_rows({.body = "limb"}, {measured("plain", file_sequence, falling(100), 2.0)});
    ASSERT_EQ(rows.size(), 1u);
    const analysis::CsvTable table = table_of(order_columns, rows);
    EXPECT_DOUBLE_EQ(table.number(0, "residual_24"), 4.0 / 25);
    EXPECT_DOUBLE_EQ(table.number(0, "volume_abs_change_limit_pct"), 4.0 / 101);
    EXPECT_DOUBLE_EQ(table.number(0, "volume_abs_change_half_pct"), 4.0 / 51);
    EXPECT_EQ(table.integer(0, "iterations"), 100);
    EXPECT_EQ(table.text_at(0, "order"), "plain");
}

// Reference: ratios and medians found by hand.

TargetRow target_row(const std::string& order, const std::string& sequence, std::optional<double> ms)
{
    TargetRow row{{.body = "limb", .order = order, .precision = "f32"}, sequence, "volume_2_pct", 2.0};
    row.reached = ms.has_value();
    row.ms = ms;
    if (ms) row.iterations = 10;
    return row;
}

// Where either never reaches the target, there is no speed-up.
TEST(EqualAnswers, SpeedUpsAreRatiosOfTimesToTheTarget)
{
    const auto answers = [](const std::vector<TargetRow>& rows) {
        return equal_answers(table_of(target_columns, rows));
    };
    const analysis::CsvTable all = answers({target_row("plain", "file", 80.0), target_row("plain", "spread", 40.0),
                                            target_row("plain", "random_1", 60.0), target_row("ordered", "file", 10.0),
                                            target_row("ordered", "random_1", 11.0)});
    ASSERT_EQ(all.rows(), 2);
    EXPECT_TRUE(all[1].has({{"order", "ordered"}, {"speedup_to_plain", 8.0}, {"speedup_to_plain_spread", 4.0}}));
    const analysis::CsvTable unreached =
        answers({target_row("plain", "file", 80.0), target_row("plain", "spread", {}),
                 target_row("ordered", "file", 10.0), target_row("poses", "file", {})});
    ASSERT_EQ(unreached.rows(), 3);
    EXPECT_TRUE(unreached[1].has({{"speedup_to_plain", 8.0}, {"speedup_to_plain_spread", ""}}));
    EXPECT_EQ(unreached.text_at(2, "speedup_to_plain"), "");
    EXPECT_THROW(answers({target_row("plain", "file", 80.0)}), pbs::InputError) << "there is no spread baseline";
}

// The order `ordered` gives an answer that is no worse than the median of random orders. Reference: `plain` in the five
// random sequences of the study, on two of its bodies.

// The absolute volume change after 24 iterations in file order over the median of `plain` in random orders, by order
// and precision.
std::map<std::pair<std::string, std::string>, double> volume_to_random_plain(const std::string& body, double angle_deg)
{
    EqualQualityCase of;
    of.of = {.body = body, .motion = "twist", .angle_deg = angle_deg};
    of.scene = read_scene("limb_twist", {"motion.angle_deg=" + std::to_string(angle_deg), "motion.frames=2"});
    of.frame = 1;
    of.random = {1, 2, 3, 4, 5};
    of.most_iterations = paper_iterations;
    of.rounds = {.seconds = 0.0, .fewest = 1, .most = 1};
    const std::vector<OrderRow> rows = order_rows(of.of, measure_orders(of));
    std::map<std::pair<std::string, std::string>, double> ratios;
    for (const OrderRow& row : rows) {
        if (row.sequence != file_sequence) continue;
        std::vector<double> random;
        for (const OrderRow& one : rows)
            if (one.of.order == "plain" && one.of.precision == row.of.precision && one.sequence.starts_with("random_"))
                random.push_back(one.after_24.volume_abs_change_pct);
        EXPECT_EQ(random.size(), 5u);
        ratios[{row.of.order, row.of.precision}] = row.after_24.volume_abs_change_pct / analysis::median(random);
    }
    return ratios;
}

// `poses` has the bits of `ordered`.
TEST(RandomOrders, OrderedIsNoWorseThanTheirMedian)
{
    for (const auto& [body, angle_deg] : {std::pair("limb", 150.0), std::pair("tapered_limb", 165.0)}) {
        const auto ratios = volume_to_random_plain(body, angle_deg);
        for (const std::string precision : {"f32", "f64"}) {
            SCOPED_TRACE(std::string(body) + ", " + precision);
            for (const std::string order : {"ordered", "poses"}) EXPECT_LE(ratios.at({order, precision}), 1.0) << order;
        }
    }
}

TEST(TaperedLimb, IsAGridOfPositiveTetsOnTwoBonesAndNearlyAFrustum)
{
    const pbs::Character limb = tapered_limb();
    EXPECT_EQ(limb.mesh.rest.rows(), 25 * 9 * 9);
    EXPECT_EQ(limb.mesh.tets.rows(), 6 * 24 * 8 * 8);
    // V - E + F - T = 1 of a ball, with 2 F = 4 T + B; each outer square has two of the B triangles.
    const int boundary = 2 * (2 * 8 * 8 + 4 * 24 * 8);
    EXPECT_EQ(pbs::edges_of(limb.mesh.tets).rows(), 2025 + 9216 + boundary / 2 - 1);
    EXPECT_GT(pbs::tet_volumes(limb.mesh.rest, limb.mesh.tets).minCoeff(), 0.0);
    EXPECT_EQ(limb.skeleton.bones.size(), 2u);
    EXPECT_EQ(limb.weights.vertices(), 2025);
    EXPECT_EQ(limb.binding.distance.size(), 2025);

    // The outline of a layer has 32 points on a circle: u^2 (1 - v^2 / 2) + v^2 (1 - u^2 / 2) = 1 where |u| = 1. Its
    // area is below that of the disc and above that of the inscribed square, which has the share 2 / pi of the disc.
    // Frustum: pi (R^2 + R r + r^2) / 3 times its length.
    for (const int i : {0, 12, 24})
        for (int k = 0; k < 9; ++k) {
            const Eigen::RowVector3d point = limb.mesh.rest.row(i * 81 + k);  // u = -1
            EXPECT_NEAR(std::hypot(point(1), point(2)), 0.24 - 0.12 * i / 24, 1e-15);
        }
    const double frustum = std::numbers::pi * (0.24 * 0.24 + 0.24 * 0.12 + 0.12 * 0.12) / 3.0 * 2.0;
    const double volume = pbs::tet_volumes(limb.mesh.rest, limb.mesh.tets).sum();
    EXPECT_LT(volume, frustum);
    EXPECT_GT(volume, 2.0 / std::numbers::pi * frustum);
}

}  // namespace
