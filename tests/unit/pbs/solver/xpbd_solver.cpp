#include "pbs/solver/xpbd_solver.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_volume.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/two_bone_limb.hpp"

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

// Each of 24 iterations may add a rounding of the 1 m half length in each of the some 20 constraints at a vertex.
TEST(XpbdSolver, RestStaysAtRest)
{
    const Positions still = stepped(bent.mesh.rest, bent.binding.rest_point, {});
    EXPECT_LT((still - bent.mesh.rest).cwiseAbs().maxCoeff(), test_support::rounding_error(24 * 20, 1.0));
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
    XpbdSolver solver(bent.mesh, bent.binding.distance, {}, {.poisson = 0.45, .iterations = 3, .substeps = 2});
    const Eigen::Index tets = bent.mesh.tets.rows(), edges = pbs::edges_of(bent.mesh.tets).rows(), vertices = bent.mesh.rest.rows();
    const pbs::WorkCounters expected{.tet_visits = 6 * tets, .projections = 6 * (vertices + edges + tets)};
    EXPECT_EQ(solver.advance(bent.lbs, bent.bind_points, 0.01).work, expected);
}

TEST(XpbdSolver, HeldVerticesStayToTheBit)
{
    std::vector<bool> held(bent.mesh.rest.rows(), false);
    held[5] = held[40] = true;
    XpbdSolver solver(bent.mesh, bent.binding.distance, {}, {}, held);
    solver.advance(bent.lbs, bent.bind_points, 0.01);
    EXPECT_EQ(solver.positions().row(5), bent.lbs.row(5));
    EXPECT_EQ(solver.positions().row(40), bent.lbs.row(40));
}

TEST(XpbdSolver, CollapsedToAPointStaysFinite)
{
    const Positions point = Positions::Zero(bent.mesh.rest.rows(), 3);
    stepped(point, bent.bind_points, {});
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
