// Stretch and bind constraints. Reference: Eq. 8-10 by hand. Tolerances: the rounding of a projection.
#include "pbs/constraints/bind.hpp"
#include "pbs/constraints/stretch.hpp"

#include "tests/support/projection_rounding.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using pbs::BindConstraint;
using pbs::StretchConstraint;
using pbs::Vec3;
using test_support::rounding_of;

const StretchConstraint<double> rod{{0, 1}, 1.0, 1.0};

TEST(StretchConstraint, ProjectionMeetsHalfWayOrAtThePinnedPoint)
{
    EXPECT_DOUBLE_EQ(value(rod, Vec3(0, 0, 0), Vec3(3, 0, 4)), 4.0);
    EXPECT_DOUBLE_EQ(value(rod, Vec3(1, 1, 1), Vec3(1, 1, 1.25)), -0.75);
    struct Case {
        Vec3 second, to_1, to_2;
        double w1 = 1.0;
    };
    for (const auto& [second, to_1, to_2, w1] :
         {Case{{3, 0, 0}, {1, 0, 0}, {2, 0, 0}}, Case{{0, 0.5, 0}, {0, -0.25, 0}, {0, 0.75, 0}},
          Case{{3, 0, 0}, {0, 0, 0}, {1, 0, 0}, 0.0}}) {
        Vec3 p1(0, 0, 0), p2 = second;
        project(rod, w1, 1.0, p1, p2);
        EXPECT_EQ(p1, to_1);
        EXPECT_EQ(p2, to_2);
    }
    // Nearly coincident points are projected, too.
    Vec3 p1(0, 0, 0), p2(1e-12, 0, 0);
    const double rounding_m = rounding_of(rod, 1.0, 1.0, p1, p2).step;  // of each end
    project(rod, 1.0, 1.0, p1, p2);
    EXPECT_NEAR((p2 - p1).norm(), 1.0, 2.0 * rounding_m);
}

const BindConstraint<double> tether{0, 2.0, 1.0};
const Vec3 q(1, 1, 1);

// A constraint to a position, as BindTo::blended_position has it, is one of distance zero: its gradient feels a turn
// about any axis that does not go through the position, where that of a distance to a bone is zero.
TEST(BindConstraint, ToAPositionResistsTurnsThatADistanceLeavesFree)
{
    const BindConstraint<double> to_position{0, 0.0, 0.25}, to_bone{0, 2.0, 0.25};
    // by a right angle about the bone through q along x
    const Vec3 at_rest = q + Vec3(0, 2, 0), turned = q + Vec3(0, 0, 2);
    EXPECT_EQ(value(to_bone, turned, q), 0.0);
    EXPECT_DOUBLE_EQ(value(to_position, turned, at_rest), std::sqrt(8.0));
    Vec3 p = turned;
    const double rounding_m = rounding_of(to_position, at_rest, p).step;
    project(to_position, 1.0, at_rest, p);
    EXPECT_LT((p - (0.75 * turned + 0.25 * at_rest)).norm(), 2.0 * rounding_m)
        << "a quarter of the way, and the same sum by hand";
}

// Whatever the mass: the bone has an infinite one.
TEST(BindConstraint, ProjectionRestoresTheDistance)
{
    EXPECT_DOUBLE_EQ(value(tether, Vec3(4, 1, 5), q), 3.0);
    EXPECT_DOUBLE_EQ(value(tether, q, q), -2.0);
    for (const double w : {1e-3, 1.0, 1e3})
        for (const auto& [from, to] : {std::pair(Vec3(6, 1, 1), Vec3(3, 1, 1)), {Vec3(1, 1.5, 1), Vec3(1, 3, 1)}}) {
            Vec3 p = from;
            project(tether, w, q, p);
            EXPECT_EQ(p, to);
        }
}

// Momentum is not conserved: that of the vertex equals what the bone would receive as the heavy end of a rod between
// them (Eq. 8-9 at both ends), with 1e8 times the vertex's mass. The two differ by that share of the momentum, and by
// the rounding of the vertex and of the bone, whose step of 1e-8 is rounded with its position. It is along the line
// from the vertex to q and has no moment about q.
TEST(BindConstraint, TheBoneTakesTheMomentum)
{
    test_support::RandomPoints random(32);
    const double vertex = 0.8, bone = 1e-8 * vertex;  // inverse masses
    const BindConstraint<double> bind{0, 0.3, 0.7};
    for (int trial = 0; trial < 50; ++trial) {
        const Vec3 p = random.point(1.0), at = random.point(1.0);
        Vec3 bound = p, heavy = at, rod_p = p;
        project(bind, vertex, at, bound);
        project(StretchConstraint<double>{{0, 1}, 0.3, 0.7}, vertex, bone, rod_p, heavy);
        const Vec3 given = (bound - p) / vertex, taken = (heavy - at) / bone;
        const double of_vertex = rounding_of(bind, at, p).step;
        const double of_bone = std::sqrt(3.0) * test_support::rounding_error(1, at.cwiseAbs().maxCoeff());
        EXPECT_LT((given + taken).norm(), bone / vertex * given.norm() + of_bone / bone + 2.0 * of_vertex / vertex);
        // The cross product of what is parallel goes through five roundings.
        EXPECT_LT((bound - p).cross(at - p).norm(),
                  (of_vertex + test_support::rounding_error(5, (bound - p).norm())) * (at - p).norm());
        EXPECT_GT(given.norm(), 1e-3) << trial;
    }
}

}  // namespace
