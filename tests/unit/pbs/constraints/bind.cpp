// Reference: the distance to a fixed point, by hand. Tolerances: the rounding of a projection.
#include "pbs/constraints/bind.hpp"

#include "tests/support/projection_rounding.hpp"
#include "tests/support/random_points.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using pbs::BindConstraint;
using pbs::Vec3;

const BindConstraint<double> tether{0, 2.0, 1.0};
const Vec3 q(1, 1, 1);

TEST(BindConstraint, ValueIsDistanceMinusRestDistance)
{
    EXPECT_DOUBLE_EQ(value(tether, Vec3(4, 1, 5), q), 3.0);
    EXPECT_DOUBLE_EQ(value(tether, q, q), -2.0);
}

// A constraint to a position, as BindTo::blended_position has it, is one of distance zero: its gradient feels a turn about any axis that
// does not go through the position, where that of a distance to a bone is zero.
TEST(BindConstraint, ToAPositionResistsTurnsThatADistanceLeavesFree)
{
    const BindConstraint<double> to_position{0, 0.0, 0.25}, to_bone{0, 2.0, 0.25};
    const Vec3 at_rest = q + Vec3(0, 2, 0), turned = q + Vec3(0, 0, 2);  // by a right angle about the bone through q along x
    EXPECT_EQ(value(to_bone, turned, q), 0.0);
    EXPECT_DOUBLE_EQ(value(to_position, turned, at_rest), std::sqrt(8.0));
    Vec3 p = turned;
    const double rounding_m = test_support::rounding_of(to_position, at_rest, p).step;
    project(to_position, 1.0, at_rest, p);
    EXPECT_LT((p - (0.75 * turned + 0.25 * at_rest)).norm(), 2.0 * rounding_m) << "a quarter of the way, and the same sum by hand";
}

TEST(BindConstraint, ProjectionRestoresTheDistance)
{
    Vec3 p(6, 1, 1);
    project(tether, 1.0, q, p);
    EXPECT_EQ(p, Vec3(3, 1, 1));
    p = Vec3(1, 1.5, 1);
    project(tether, 1.0, q, p);
    EXPECT_EQ(p, Vec3(1, 3, 1));
}

TEST(BindConstraint, MassDoesNotMatterAgainstABoneOfInfiniteMass)
{
    Vec3 light(5, 4, 3), heavy = light;
    project(tether, 1e3, q, light);
    project(tether, 1e-3, q, heavy);
    EXPECT_EQ(light, heavy);
}

// Momentum is not conserved: the bone takes -m dp along the line from the vertex to q, which has no moment about q.
TEST(BindConstraint, ReactionOfTheBoneRunsThroughTheBindPoint)
{
    test_support::RandomPoints random(10);
    for (int trial = 0; trial < 20; ++trial) {
        Vec3 p = q + random.point(1.0);
        const Vec3 before = p;
        project(tether, 1.0, q, p);
        const Vec3 reaction = -(p - before);
        const double rounding_m = test_support::rounding_of(tether, q, before).step;
        EXPECT_NEAR(reaction.norm(), std::abs(value(tether, before, q)), rounding_m);
        EXPECT_LT((before - q).cross(reaction).norm(), (before - q).norm() * rounding_m);
    }
}

TEST(BindConstraint, VertexOnTheBoneIsPutOnItsMaterialPoint)
{
    const BindConstraint<double> on_the_bone{0, 0.0, 1.0};
    Vec3 p(0.4, -0.3, 0.2);
    const double rounding_m = test_support::rounding_of(on_the_bone, q, p).step;
    project(on_the_bone, 1.0, q, p);
    EXPECT_LT((p - q).norm(), rounding_m);
    p = q;
    project(on_the_bone, 1.0, q, p);
    EXPECT_EQ(p, q);
}

}  // namespace
