// Reference: order `plain`, and that bind keeps a body within reach of its bones. The initial states are ones that no
// pose produces and in which other solvers diverge: flattened, mirrored, random, collapsed.
#include "pbs/solver/pbs_solver.hpp"

#include "tests/support/random_points.hpp"
#include "tests/support/step_rounding.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using namespace test_support;
using pbs::Order;
using pbs::Outcome;
using pbs::PbsOptions;
using pbs::Positions;
using pbs::Precision;
using pbs::Vec3;

const TwoBoneLimb limb = two_bone_limb({20, 4, 4}, Vec3::UnitZ(), 0.0);

struct Start {
    std::string name;
    Positions positions;
};

Positions scaled(double x, double y, double z)
{
    return limb.lbs * Vec3(x, y, z).asDiagonal();
}

Positions random_positions()
{
    RandomPoints random(51);
    Positions positions(limb.lbs.rows(), 3);
    for (Eigen::Index i = 0; i < positions.rows(); ++i) positions.row(i) = random.point(1.0).transpose();
    return positions;
}

Positions two_points()
{
    Positions positions(limb.lbs.rows(), 3);
    for (Eigen::Index i = 0; i < positions.rows(); ++i)
        positions.row(i) = i % 2 ? Eigen::RowVector3d(0.1, 0.2, 0.3) : Eigen::RowVector3d(1.1, -0.4, 0.7);
    return positions;
}

std::vector<Start> starts()
{
    return {{"flattened", scaled(1, 1, 0)},
            {"mirrored", scaled(1, 1, -1)},
            {"turned inside out about a point", scaled(-1, -1, -1)},
            {"a line", scaled(1, 0, 0)},
            {"an oblique line", limb.lbs.col(0) * Eigen::RowVector3d(0.8, 0.33, 0.51)},
            {"two points", two_points()},
            {"a point", scaled(0, 0, 0)},
            {"a point away from the bones", scaled(0, 0, 0).rowwise() + Eigen::RowVector3d(0.3, 0.4, 0.5)},
            {"random", random_positions()},
            {"a tenth of its size", scaled(0.1, 0.1, 0.1)},
            {"ten times its size", scaled(10, 10, 10)}};
}

Stepped stepped(const Positions& start, Order order, Precision precision, double k_bind)
{
    PbsOptions options;
    options.order = order;
    options.precision = precision;
    options.k_bind = k_bind;
    return test_support::stepped(blended_to(limb, start), options);
}

double farthest(const Positions& positions)
{
    return positions.cwiseAbs().maxCoeff();
}

template <typename Expect>
void for_each_start_and_order(Expect expect, const std::vector<Start>& from = starts())
{
    for (const auto& [name, start] : from)
        for (const Order order : {Order::plain, Order::ordered})
            for (const Precision precision : {Precision::f32, Precision::f64}) {
                SCOPED_TRACE(testing::Message() << name << " order " << int(order) << " precision " << int(precision));
                expect(start, order, precision);
            }
}

// The body is 2 m long, and its farthest vertex at rest is 1 m from the middle.
TEST(Starts, ComeBackWithinReachOfTheBones)
{
    for_each_start_and_order([](const Positions& start, Order order, Precision precision) {
        const Stepped result = stepped(start, order, precision, 1.0);
        EXPECT_EQ(result.summary.outcome, Outcome::finished);
        EXPECT_LT(farthest(result.positions), 1.5);
        EXPECT_GT(farthest(result.positions), 0.9);
    });
}

// Without bind a body may stay collapsed or, if every tet is flat up to rounding, fly apart. The order plain does so
// too.
TEST(Starts, WithoutBindAreFiniteWherePlainIs)
{
    for_each_start_and_order([](const Positions& start, Order order, Precision precision) {
        const Stepped result = stepped(start, order, precision, 0.0),
                      plain = stepped(start, Order::plain, precision, 0.0);
        EXPECT_EQ(result.summary.outcome, plain.summary.outcome);
        EXPECT_EQ(result.summary.outcome, Outcome::finished);
        EXPECT_TRUE(result.positions.allFinite());
    });
}

// In a point, the corrections of edges and tets have no direction; the result has the same bits.
TEST(Starts, APointWithoutBindStays)
{
    for_each_start_and_order(
        [](const Positions& point, Order order, Precision precision) {
            EXPECT_EQ(stepped(point, order, precision, 0.0).positions, point);
        },
        {{"a point", scaled(0, 0, 0)}});
}

// The outcome is that of plain, never a hang or an exception.
TEST(Starts, WhatIsNotFiniteIsAnOutcomeInEveryOrder)
{
    Positions not_a_number = limb.lbs, infinite = limb.lbs;
    not_a_number(100, 2) = std::numeric_limits<double>::quiet_NaN();
    infinite(100, 2) = std::numeric_limits<double>::infinity();
    for_each_start_and_order(
        [](const Positions& start, Order order, Precision precision) {
            EXPECT_EQ(stepped(start, order, precision, 1.0).summary.outcome, Outcome::not_finite);
        },
        {{"not a number", not_a_number}, {"infinite", infinite}});
}

}  // namespace
