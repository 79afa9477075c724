// The step of the published code. Reference: the rules in author_solver.hpp, by hand.
#include "pbs/author/author_solver.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using pbs::AuthorOptions;
using pbs::AuthorSolver;
using pbs::Positions;
using pbs::Vec3;
using test_support::rounding_error;

const test_support::TwoBoneLimb limb = test_support::two_bone_limb({16, 4, 4}, Vec3::UnitZ(), 60.0);
constexpr int constraints_at_a_vertex = 50;

AuthorSolver solver_with(const AuthorOptions& options)
{
    return {limb.mesh, limb.skeleton, limb.binding, options};
}

pbs::Pose moved(const Vec3& offset_m)
{
    return pbs::Pose(2, Eigen::Isometry3d(Eigen::Translation3d(offset_m)));
}

Positions rest_moved(const Vec3& offset_m)
{
    return limb.mesh.rest.rowwise() + offset_m.transpose();
}

double largest(const Positions& difference)
{
    return difference.cwiseAbs().maxCoeff();
}

// Each iteration may add a rounding of the 1 m half length in each constraint at a vertex.
TEST(AuthorSolver, RestStaysAtRest)
{
    AuthorSolver solver = solver_with({});
    EXPECT_EQ(solver.positions(), limb.mesh.rest);
    EXPECT_EQ(solver.advance(moved(Vec3::Zero())).iterations, 12);
    EXPECT_LT(largest(solver.positions() - limb.mesh.rest), rounding_error(12 * constraints_at_a_vertex, 1.0));
}

TEST(AuthorSolver, WithoutIterationsTheFirstFrameIsLbs)
{
    AuthorSolver solver = solver_with({.iterations = 0});
    solver.advance(limb.pose);
    Positions lbs;
    pbs::linear_blend_skinning(limb.mesh.rest, pbs::author_weights(limb.binding, limb.skeleton), limb.pose, lbs);
    EXPECT_LT(largest(solver.positions() - lbs), rounding_error(20, 2.0));  // blends of another order of operations
}

TEST(AuthorSolver, RestoresVolumeThatBlendingLost)
{
    const auto lost = [](const Positions& positions) {
        return pbs::tet_volumes(limb.mesh.rest, limb.mesh.tets).sum() - pbs::tet_volumes(positions, limb.mesh.tets).sum();
    };
    const pbs::Pose twisted = pbs::joint_sweep(limb.skeleton, 1, Vec3::UnitX(), 90.0, 2, 0.01).steps.back();
    AuthorSolver blended = solver_with({.iterations = 0}), projected = solver_with({});
    blended.advance(twisted), projected.advance(twisted);
    EXPECT_GT(lost(blended.positions()), 0.0);
    EXPECT_LT(lost(projected.positions()), 0.5 * lost(blended.positions()));
}

// Without projections, a body that moves by u(n) is at y(n) = u(n) + y(n - 1) - y(n - 2): motion counts twice. A single jolt then rings
// between 0 and 2 with period 6. The small further motion keeps the poses different; after 12
// frames it amounts to 14 / 1024 at most.
TEST(AuthorSolver, CountsMotionTwice)
{
    AuthorSolver solver = solver_with({.iterations = 0, .time_step_s = 0.125});
    double last = 0.0, before_last = 0.0;
    for (int frame = 1; frame <= 12; ++frame) {
        const double u = 1.0 + frame / 1024.0, expected = u + (frame == 1 ? 0.0 : last - before_last);
        solver.advance(moved({u, 0.0, 0.0}));
        EXPECT_LT(largest(solver.positions() - rest_moved({expected, 0.0, 0.0})), rounding_error(20 * frame, 4.0)) << frame;
        before_last = last, last = expected;
        const int phase = frame % 6;
        EXPECT_NEAR(expected, phase == 0 || phase == 5 ? 0.0 : phase == 2 || phase == 3 ? 2.0 : 1.0, 14.0 / 1024.0) << frame;
    }
}

TEST(AuthorSolver, GravityMovesEveryParticleByGHSquared)
{
    AuthorSolver solver = solver_with({.iterations = 0, .gravity_m_s2 = {0.0, -9.81, 0.0}});
    solver.advance(moved(Vec3::Zero()));
    EXPECT_LT(largest(solver.positions() - rest_moved({0.0, -0.0981, 0.0})), rounding_error(20, 1.0));
}

TEST(AuthorSolver, TheTimeStepCancelsWithoutGravity)
{
    AuthorSolver one = solver_with({.time_step_s = 0.125}), other = solver_with({.time_step_s = 0.5});  // powers of two are exact
    for (AuthorSolver* solver : {&one, &other}) {
        solver->advance(limb.pose);
        solver->advance(moved({0.0, 0.5, 0.0}));
    }
    EXPECT_EQ(one.positions(), other.positions());
}

TEST(AuthorSolver, DoesNotStepAPoseThatEqualsTheLastOne)
{
    AuthorSolver solver = solver_with({});
    solver.advance(limb.pose);
    const Positions before = solver.positions();
    EXPECT_EQ(solver.advance(limb.pose).iterations, 0);
    EXPECT_EQ(solver.positions(), before);
    EXPECT_EQ(solver.advance(moved(Vec3::Zero())).iterations, 12);
    EXPECT_NE(solver.positions(), before);
}

// The threshold for a unit of 100 m is 100 m^4. No tet of the limb, 2 m long, has faces of 1 m^2, so that its squared gradients add up to
// less than 4 x 2^2 m^4. Volume constraints are then left out, whatever their stiffness is.
TEST(AuthorSolver, TheUnitOfLengthDecidesWhichTetsAreLeftOut)
{
    const auto bent_with = [](double length_unit_m, double k_volume) {
        AuthorSolver solver = solver_with({.length_unit_m = length_unit_m, .k_volume_inverted = k_volume, .k_volume = k_volume});
        solver.advance(limb.pose);
        return solver.positions();
    };
    EXPECT_EQ(bent_with(100.0, 1.0), bent_with(100.0, 0.0));
    EXPECT_NE(bent_with(0.01, 1.0), bent_with(0.01, 0.0));
}

TEST(AuthorSolver, ReportsPositionsThatAreNotFinite)
{
    AuthorSolver solver = solver_with({});
    const double nothing = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(solver.advance(moved({nothing, 0.0, 0.0})).outcome, pbs::Outcome::not_finite);
}

TEST(AuthorSolver, RefusesOptionsOutOfRangeAndOtherBindings)
{
    for (const AuthorOptions& options :
         {AuthorOptions{.iterations = -1}, AuthorOptions{.time_step_s = 0.0}, AuthorOptions{.length_unit_m = 0.0},
          AuthorOptions{.k_compression = 1.1}, AuthorOptions{.k_stretch = -0.1}, AuthorOptions{.k_volume_inverted = 6.1},
          AuthorOptions{.k_volume = std::numeric_limits<double>::quiet_NaN()}})
        EXPECT_THROW(solver_with(options), pbs::InputError);
    const pbs::BoneBinding of_fewer = pbs::bind_to_nearest_bone(limb.mesh.rest.topRows(3), limb.skeleton);
    EXPECT_THROW(AuthorSolver(limb.mesh, limb.skeleton, of_fewer, {}), pbs::InputError);
}

}  // namespace
