// Reference: for one tet and two, counting by hand; for a bar, the tets' volumes and the balance of work. The locking
// table compares the equilibrium with the linear tets of the reference.

#include "pbs/near_rest/near_rest.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/hanging_tet.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <cmath>

namespace {

using pbs::Positions;
using pbs::Vec3;
using pbs::VolumeConstraints;

std::vector<bool> none_of(const pbs::TetMesh& mesh)
{
    return std::vector<bool>(mesh.rest.rows(), false);
}

// The gradients of a tet's volume, which are those of its shape functions times the volume, and the volume.
struct TetVolume {
    std::array<Vec3, 4> gradient;
    double rest;
};

TetVolume volume_of(const pbs::TetMesh& mesh, const auto& tet)
{
    const auto corner = [&](int c) -> Vec3 { return mesh.rest.row(tet(c)); };
    const pbs::VolumeConstraint<double> volume{};
    return {gradient(volume, corner(0), corner(1), corner(2), corner(3)),
            value(volume, corner(0), corner(1), corner(2), corner(3))};
}

// |G u|: the root of the sum of squares of the tets' changes of volume, to first order, over the roots of their
// volumes. magnitude: the same with the magnitudes of all terms.
struct VolumeChange {
    double change = 0.0, magnitude = 0.0;
};

VolumeChange volume_change(const pbs::TetMesh& mesh, const Positions& motion)
{
    VolumeChange result;
    for (const auto& tet : mesh.tets.rowwise()) {
        const auto [gradient, rest] = volume_of(mesh, tet);
        double change = 0.0, magnitude = 0.0;
        for (int c = 0; c < 4; ++c) {
            change += gradient[c].dot(motion.row(tet(c)));
            magnitude += gradient[c].norm() * motion.row(tet(c)).norm();
        }
        result = {std::hypot(result.change, change / std::sqrt(rest)),
                  std::hypot(result.magnitude, magnitude / std::sqrt(rest))};
    }
    return result;
}

// load . u [J m^3 / N] of the same body with a shear modulus of 1 Pa and no constraints.
double work_without_constraints(const pbs::TetMesh& mesh, const std::vector<bool>& held, const Positions& load)
{
    Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(mesh.rest.size(), mesh.rest.size());
    for (const auto& tet : mesh.tets.rowwise()) {
        const auto [g, rest] = volume_of(mesh, tet);
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b)
                stiffness.block<3, 3>(3 * tet(a), 3 * tet(b)) +=
                    (g[a].dot(g[b]) * Eigen::Matrix3d::Identity() + g[b] * g[a].transpose()) / rest;
    }
    Eigen::VectorXd force(mesh.rest.size());
    for (Eigen::Index v = 0; v < mesh.rest.rows(); ++v) {
        force.segment<3>(3 * v) = load.row(v);
        if (!held[v]) continue;
        force.segment<3>(3 * v).setZero();
        stiffness.middleRows(3 * v, 3).setZero();
        stiffness.middleCols(3 * v, 3).setZero();
        stiffness.block<3, 3>(3 * v, 3 * v).setIdentity();
    }
    return force.dot(stiffness.ldlt().solve(force));
}

TEST(VolumeConstraints, OneTetHasOneConstraintOnTwelveMotions)
{
    const pbs::TetMesh cube = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    const pbs::TetMesh tet{cube.rest, cube.tets.topRows(1)};
    std::vector<bool> held(8, true);
    for (const int v : tet.tets.row(0)) held[v] = false;
    const VolumeConstraints volumes(tet, held);
    EXPECT_EQ(volumes.constraints(), 1);
    EXPECT_EQ(volumes.dofs(), 12);
    EXPECT_EQ(volumes.rank(), 1);
}

// Six tets around a cube's diagonal: with all vertices free, the six volumes are independent (each tet has an own edge
// of the cube's boundary). A tet whose four corners are held is not a constraint.
TEST(VolumeConstraints, RankOfACube)
{
    const pbs::TetMesh cube = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    EXPECT_EQ(VolumeConstraints(cube, none_of(cube)).rank(), 6);
    std::vector<bool> held(8, false);
    for (const int v : cube.tets.row(2)) held[v] = true;
    EXPECT_EQ(VolumeConstraints(cube, held).rank(), 5);
}

TEST(VolumeConstraints, EquilibriumKeepsEveryVolumeAndBalancesTheLoad)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {3, 1, 1}, {6, 2, 2});
    std::vector<bool> held;
    Positions load = Positions::Zero(bar.rest.rows(), 3);
    for (Eigen::Index v = 0; v < bar.rest.rows(); ++v) {
        held.push_back(bar.rest(v, 0) == 0.0);
        if (bar.rest(v, 0) == 3.0) load(v, 2) = -1.0;
    }
    const VolumeConstraints volumes(bar, held);
    const double shear_pa = 2.0, penalty = 1e4;
    const Positions u = volumes.equilibrium(load, shear_pa);
    // Its rounds end at |G u| <= 1e-9 |G u0|. The first solution u0 minimises u^T K u / 2 + penalty |G u|^2 / 2 - f . u
    // with f = load / shear modulus, so that penalty |G u0|^2 is at most the work f . u0. Without the penalty the body
    // is softer, and that work is larger.
    const double first = std::sqrt(work_without_constraints(bar, held, load) / shear_pa / penalty);
    // Each tet's change goes through six roundings of an entry of G, of a motion and of a product, and twelve of a sum.
    const auto [change, magnitude] = volume_change(bar, u);
    EXPECT_LT(change, 1e-9 * first + test_support::rounding_error(6 + 12, magnitude));
    EXPECT_LT(u.col(2).minCoeff(), 0.0);
    // Twice the shear modulus gives half the motion, to the bit.
    EXPECT_EQ(volumes.equilibrium(load, 2.0 * shear_pa), 0.5 * u);
}

// Reference: linear algebra for one hanging particle; for a bar, the time stepper itself, which stays in the state of
// rest.

using pbs::settle;

TEST(SettledState, OfAHangingParticleIsTheFixedPoint)
{
    const auto tet = test_support::hanging_tet();
    const Vec3 acceleration(1.0, 2.0, -10.0);
    for (const int iterations : {1, 4, 24}) {
        const auto state = settle(tet.mesh, tet.held, test_support::stretch_alone(iterations, 0.2), acceleration);
        const Eigen::Matrix3d S = test_support::step_matrix(tet, iterations, 0.2);
        const Vec3 expected = (Eigen::Matrix3d::Identity() - S).inverse() * S * acceleration;
        EXPECT_TRUE(state.converged);
        // The residual is required to be at most 1e-7 of the right-hand side.
        const double of_residual =
            (Eigen::Matrix3d::Identity() - S).inverse().norm() * 1e-7 * (S * acceleration).norm();
        EXPECT_LT((state.displacement.row(3).transpose() - expected).norm(), of_residual) << iterations;
        EXPECT_EQ(state.displacement.topRows(3), Positions::Zero(3, 3));
    }
}

// A bar held at one end, with stretch and volume constraints. A time step with gravity does not move it away from its
// state of rest: the first step is S (x + a dt^2) = x. Only the second order may move it, a share of deflection over
// edge of the deflection.
TEST(SettledState, OfABarIsWhereTheTimeStepperStays)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {1.0, 0.2, 0.2}, {10, 2, 2});
    std::vector<bool> held, free;
    for (const auto& vertex : bar.rest.rowwise()) held.push_back(vertex(0) == 0.0), free.push_back(vertex(0) != 0.0);
    pbs::PbsOptions options;
    options.iterations = 8;
    options.k_stretch = 0.3;
    options.masses = pbs::Masses::lumped;
    const auto state = settle(bar, held, options, -Vec3::UnitZ());
    ASSERT_TRUE(state.converged);

    const double deflection_m = 1e-5, tip = state.displacement.cwiseAbs().maxCoeff();
    for (const double dt_s : {0.01, 0.002}) {
        pbs::PbsOptions stepping = options;
        stepping.precision = pbs::Precision::f64;
        stepping.order = pbs::Order::plain;  // the order of the settled state
        stepping.k_bind = 0.0;
        stepping.jiggle = pbs::Jiggle{options.k_stretch};
        // the same deflection at any time step
        stepping.gravity_m_s2 = -deflection_m / (tip * dt_s * dt_s) * Vec3::UnitZ();
        pbs::PbsSolver solver(bar, Eigen::VectorXd::Zero(bar.rest.rows()), free, stepping, held);
        const Positions start = bar.rest + deflection_m / tip * state.displacement;
        for (int step = 0; step < 200; ++step) solver.advance(step == 0 ? start : bar.rest, bar.rest, dt_s);
        EXPECT_LT((solver.positions() - start).cwiseAbs().maxCoeff(), deflection_m / 0.1 * deflection_m) << dt_s;
    }
}

TEST(SettledState, SaysThatItDidNotConverge)
{
    // Nothing draws the particle back, so it never rests.
    const auto tet = test_support::hanging_tet();
    EXPECT_FALSE(settle(tet.mesh, tet.held, test_support::stretch_alone(0, 0.2), -Vec3::UnitZ()).converged);
}

}  // namespace
