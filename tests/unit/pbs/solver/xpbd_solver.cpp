#include "pbs/solver/xpbd_solver.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/scalar_rounding.hpp"
#include "tests/support/two_bone_limb.hpp"
#include "tests/support/xpbd_rounding.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::Positions;
using pbs::XpbdOptions;
using pbs::XpbdSolver;

const test_support::TwoBoneLimb bent = test_support::two_bone_limb({16, 4, 4}, pbs::Vec3::UnitZ(), 60.0);

Positions stepped(const Positions& lbs, const Positions& bind_points, const XpbdOptions& options)
{
    XpbdSolver solver(bent.mesh, bent.binding.distance, {}, options);
    EXPECT_EQ(solver.advance(lbs, bind_points, 0.01).outcome, pbs::Outcome::finished);
    return solver.positions();
}

const XpbdOptions codes[] = {
    {.order = pbs::Order::plain, .precision = pbs::Precision::f32},   {.order = pbs::Order::plain, .precision = pbs::Precision::f64},
    {.order = pbs::Order::ordered, .precision = pbs::Precision::f32}, {.order = pbs::Order::ordered, .precision = pbs::Precision::f64},
    {.order = pbs::Order::grouped, .precision = pbs::Precision::f32}, {.order = pbs::Order::grouped, .precision = pbs::Precision::f64}};

// Each of 24 iterations may add a rounding of the 1 m half length in each of the some 20 constraints at a vertex.
TEST(XpbdSolver, RestStaysAtRest)
{
    const Positions still = stepped(bent.mesh.rest, bent.binding.rest_point, {});
    EXPECT_LT((still - bent.mesh.rest).cwiseAbs().maxCoeff(), test_support::rounding_error(24 * 20, 1.0));
}

// The same in the precision of the projections; the packed code rounds six volumes and their rest value apart, which is as much again.
TEST(XpbdSolver, RestStaysAtRestInEveryCode)
{
    for (const XpbdOptions& code : codes) {
        const double error_m = (stepped(bent.mesh.rest, bent.binding.rest_point, code) - bent.mesh.rest).cwiseAbs().maxCoeff();
        const bool f32 = code.precision == pbs::Precision::f32;
        const int roundings = 2 * 24 * 20;
        EXPECT_LT(error_m, f32 ? test_support::rounding_error_in<float>(roundings, 1.0) : test_support::rounding_error(roundings, 1.0));
    }
}

// Reference: the same order in double precision, within the rounding of a step (xpbd_rounding.hpp).
TEST(XpbdSolver, FloatAgreesWithDouble)
{
    for (const pbs::Order order : {pbs::Order::plain, pbs::Order::ordered, pbs::Order::grouped}) {
        const XpbdOptions f32{.order = order, .precision = pbs::Precision::f32}, f64{.order = order};
        const double difference_m =
            (stepped(bent.lbs, bent.bind_points, f32) - stepped(bent.lbs, bent.bind_points, f64)).cwiseAbs().maxCoeff();
        EXPECT_LT(difference_m, test_support::xpbd_rounding_m(bent, f32)) << int(order);
        EXPECT_GT(difference_m, 0.0) << int(order);
    }
}

TEST(XpbdSolver, FloatKeepsItsDigitsFarFromTheOrigin)
{
    const pbs::Vec3 far(1000.0, -2000.0, 500.0);  // the spacing of floats there is 1e-4 m
    for (const pbs::Order order : {pbs::Order::plain, pbs::Order::ordered, pbs::Order::grouped}) {
        const XpbdOptions f32{.order = order, .precision = pbs::Precision::f32};
        const Positions there = stepped(bent.lbs.rowwise() + far.transpose(), bent.bind_points.rowwise() + far.transpose(), f32);
        const double rounding_m = test_support::xpbd_rounding_m(bent, f32) + test_support::rounding_error(3, far.norm());
        EXPECT_LT(((there.rowwise() - far.transpose()) - stepped(bent.lbs, bent.bind_points, f32)).cwiseAbs().maxCoeff(), rounding_m);
    }
}

// Nothing is integrated, so the substeps have no other state than the positions.
TEST(XpbdSolver, PackedSmallStepsAreNearPlainOnes)
{
    const XpbdOptions plain{.iterations = 1, .substeps = 24};
    for (const pbs::Order order : {pbs::Order::ordered, pbs::Order::grouped}) {
        XpbdOptions packed = plain;
        packed.order = order;
        const Positions expected = stepped(bent.lbs, bent.bind_points, plain), found = stepped(bent.lbs, bent.bind_points, packed);
        EXPECT_LT((found - expected).norm(), 0.1 * (expected - bent.lbs).norm()) << "another order, another limit";
    }
}

TEST(XpbdSolver, RestoresTheVolumeThatBlendingLost)
{
    const auto lost = [&](const Positions& positions) {
        return (pbs::tet_volumes(positions, bent.mesh.tets) - pbs::tet_volumes(bent.mesh.rest, bent.mesh.tets)).cwiseAbs().sum();
    };
    EXPECT_LT(lost(stepped(bent.lbs, bent.bind_points, {.poisson = 0.49})), 0.5 * lost(bent.lbs));
}

// Reference: one bind constraint per vertex, one spring per edge, one volume constraint per tet, in each iteration of each substep.
TEST(XpbdSolver, CountsItsProjections)
{
    const Eigen::Index tets = bent.mesh.tets.rows(), edges = pbs::edges_of(bent.mesh.tets).rows(), vertices = bent.mesh.rest.rows();
    const pbs::WorkCounters expected{.tet_visits = 6 * tets, .projections = 6 * (vertices + edges + tets)};
    for (XpbdOptions options : codes) {
        options.iterations = 3;
        options.substeps = 2;
        XpbdSolver solver(bent.mesh, bent.binding.distance, {}, options);
        EXPECT_EQ(solver.advance(bent.lbs, bent.bind_points, 0.01).work, expected);
    }
}

TEST(XpbdSolver, HeldVerticesStayToTheBit)
{
    std::vector<bool> held(bent.mesh.rest.rows(), false);
    held[5] = held[40] = true;
    for (const XpbdOptions& code : codes) {
        if (code.precision == pbs::Precision::f32) continue;  // positions are rounded
        XpbdSolver solver(bent.mesh, bent.binding.distance, {}, code, held);
        solver.advance(bent.lbs, bent.bind_points, 0.01);
        EXPECT_EQ(solver.positions().row(5), bent.lbs.row(5));
        EXPECT_EQ(solver.positions().row(40), bent.lbs.row(40));
    }
}

TEST(XpbdSolver, CollapsedToAPointStaysFinite)
{
    const Positions point = Positions::Zero(bent.mesh.rest.rows(), 3);
    for (const XpbdOptions& code : codes) stepped(point, bent.bind_points, code);
}

TEST(XpbdSolver, MirroredStaysFinite)
{
    const Positions mirrored = bent.lbs * pbs::Vec3(1.0, 1.0, -1.0).asDiagonal();
    for (const XpbdOptions& code : codes) stepped(mirrored, bent.bind_points, code);
}

TEST(XpbdSolver, ReportsThatItIsNotFiniteAndRecovers)
{
    Positions broken = bent.lbs;
    broken(5, 1) = std::numeric_limits<double>::quiet_NaN();
    for (const XpbdOptions& code : codes) {
        XpbdSolver solver(bent.mesh, bent.binding.distance, {}, code);
        EXPECT_EQ(solver.advance(broken, bent.bind_points, 0.01).outcome, pbs::Outcome::not_finite);
        EXPECT_EQ(solver.advance(bent.lbs, bent.bind_points, 0.01).outcome, pbs::Outcome::finished);
        EXPECT_EQ(solver.positions(), stepped(bent.lbs, bent.bind_points, code));
    }
}

TEST(XpbdSolver, RefusesNumbersBelowOne)
{
    EXPECT_THROW(XpbdSolver(bent.mesh, bent.binding.distance, {}, {.substeps = 0}), pbs::InputError);
    EXPECT_THROW(XpbdSolver(bent.mesh, bent.binding.distance, {}, {.threads = 0}), pbs::InputError);
}

TEST(XpbdSolver, RefusesPoissonsRatiosThatSpringsCannotHave)
{
    EXPECT_THROW(XpbdSolver(bent.mesh, bent.binding.distance, {}, {.poisson = 0.2}), pbs::InputError);
    EXPECT_THROW(XpbdSolver(bent.mesh, bent.binding.distance, {}, {.poisson = 0.5}), pbs::InputError);
}

TEST(XpbdSolver, WithoutSubstepsOrIterationsItIsLbs)
{
    EXPECT_EQ(stepped(bent.lbs, bent.bind_points, {.iterations = 0}), bent.lbs);
}

}  // namespace
