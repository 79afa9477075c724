// Reference: for one tet and two, counting by hand; for a bar, the paper's solver itself, whose projections converge to the nearest point
// of the set (S. Kaczmarz 1937, for consistent linear equations). The locking table compares the equilibrium with the linear tets of the
// reference.

#include "pbs/near_rest/near_rest.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/hanging_tet.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using pbs::Positions;
using pbs::Vec3;
using pbs::VolumeConstraints;

std::vector<bool> none_of(const pbs::TetMesh& mesh)
{
    return std::vector<bool>(mesh.rest.rows(), false);
}

// A bend in the plane of x and y that preserves volume: u = (-x y, x^2 / 2 + (y^2 - z^2) / 4, y z / 2).
Positions bent(const pbs::TetMesh& mesh)
{
    Positions motion(mesh.rest.rows(), 3);
    for (Eigen::Index v = 0; v < motion.rows(); ++v) {
        const double x = mesh.rest(v, 0), y = mesh.rest(v, 1), z = mesh.rest(v, 2);
        motion.row(v) << -x * y, x * x / 2.0 + (y * y - z * z) / 4.0, y * z / 2.0;
    }
    return motion;
}

// Singular values of the matrix of constraints, gradients over the root of the rest volume; zeros left out.
struct SingularValues {
    double smallest, largest;
    double condition() const { return largest / smallest; }
};

SingularValues singular_values(const pbs::TetMesh& mesh, const std::vector<bool>& held)
{
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(mesh.tets.rows(), mesh.rest.size());
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
        const auto corner = [&](int c) -> Vec3 { return mesh.rest.row(mesh.tets(t, c)); };
        const pbs::VolumeConstraint<double> volume{};
        const auto gradients = gradient(volume, corner(0), corner(1), corner(2), corner(3));
        const double root = std::sqrt(value(volume, corner(0), corner(1), corner(2), corner(3)));
        for (int c = 0; c < 4; ++c)
            if (!held[mesh.tets(t, c)]) matrix.block<1, 3>(t, 3 * mesh.tets(t, c)) = gradients[c].transpose() / root;
    }
    const Eigen::VectorXd squares =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix * matrix.transpose(), Eigen::EigenvaluesOnly).eigenvalues();
    const double largest = squares.maxCoeff();
    const double smallest = *std::find_if(squares.begin(), squares.end(), [&](double square) { return square > 1e-10 * largest; });
    return {std::sqrt(smallest), std::sqrt(largest)};
}

// load . u [J m^3 / N] of the same body with a shear modulus of 1 Pa and no constraints.
double work_without_constraints(const pbs::TetMesh& mesh, const std::vector<bool>& held, const Positions& load)
{
    Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(mesh.rest.size(), mesh.rest.size());
    for (const auto& tet : mesh.tets.rowwise()) {
        const auto corner = [&](int c) -> Vec3 { return mesh.rest.row(tet(c)); };
        const pbs::VolumeConstraint<double> volume{};
        const auto g = gradient(volume, corner(0), corner(1), corner(2), corner(3));  // of a shape function, times the volume
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b)
                stiffness.block<3, 3>(3 * tet(a), 3 * tet(b)) += (g[a].dot(g[b]) * Eigen::Matrix3d::Identity() + g[b] * g[a].transpose()) /
                                                                 value(volume, corner(0), corner(1), corner(2), corner(3));
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

// Six tets around a cube's diagonal: with all vertices free, the six volumes are independent (each tet has an own edge of the cube's
// boundary). A tet whose four corners are held is not a constraint.
TEST(VolumeConstraints, RankOfACube)
{
    const pbs::TetMesh cube = test_support::structured_bar({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    EXPECT_EQ(VolumeConstraints(cube, none_of(cube)).rank(), 6);
    std::vector<bool> held(8, false);
    for (const int v : cube.tets.row(2)) held[v] = true;
    EXPECT_EQ(VolumeConstraints(cube, held).rank(), 5);
}

TEST(VolumeConstraints, TranslationsAndRotationsAreNotTouched)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, -0.5, -0.5}, {4, 0.5, 0.5}, {4, 1, 1});
    const VolumeConstraints volumes(bar, none_of(bar));
    Positions rigid(bar.rest.rows(), 3);
    for (Eigen::Index v = 0; v < rigid.rows(); ++v)
        rigid.row(v) = (Vec3(0.3, -0.2, 0.5) + Vec3(1.0, 2.0, -1.0).cross(Vec3(bar.rest.row(v)))).transpose();
    // G u is zero up to six roundings of a coordinate, four of an entry of G and 12 of a sum; G^T y with G u = G G^T y is as large, times
    // the condition number of G.
    const double rounding = test_support::rounding_error(6 + 4 + 12, singular_values(bar, none_of(bar)).condition() * rigid.norm());
    EXPECT_LT((volumes.nearest(rigid) - rigid).norm(), rounding);
}

// 4,000 iterations of the solver with k_volume = 1 and no other constraints, from a bend of 1e-6 m: they end at the nearest point, up to
// the second order, a share of the bend over a cell, and up to their own convergence: where 2,000 iterations leave at most half the error
// of the 2,000 before, the error is at most the last change.
TEST(VolumeConstraints, NearestIsWhereTheSolverEnds)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, -0.5, -0.5}, {5, 0.5, 0.5}, {10, 2, 2});
    const Positions motion = bent(bar), nearest = VolumeConstraints(bar, none_of(bar)).nearest(motion);
    const double bend_m = 1e-6, cell_m = 0.5, amplitude = bend_m / motion.cwiseAbs().maxCoeff();
    const auto after = [&](int iterations) -> Positions {
        pbs::PbsOptions options;
        options.iterations = iterations;
        options.k_stretch = options.k_bind = 0.0;
        options.precision = pbs::Precision::f64;
        pbs::PbsSolver solver(bar, Eigen::VectorXd::Zero(bar.rest.rows()), {}, options);
        solver.advance(bar.rest + amplitude * motion, bar.rest, 1.0);
        return (solver.positions() - bar.rest) / amplitude;
    };
    const Positions reached = after(4000);
    const double last_change = (reached - after(2000)).norm();
    EXPECT_LT((reached - nearest).norm(), bend_m / cell_m * motion.norm() + last_change);
    EXPECT_LT(last_change, 1e-5 * motion.norm()) << "a bound that would let another point pass proves nothing";
    EXPECT_GT((reached - motion).norm(), 0.05 * motion.norm());  // the body did move
    // It is a projection: the part G^T y that was removed is orthogonal to the rest n, since conjugate gradients end at |G n| <= 1e-13 |G
    // u|.
    const double of_residual = 1e-13 * singular_values(bar, none_of(bar)).condition() * motion.squaredNorm();
    EXPECT_NEAR((motion - nearest).cwiseProduct(nearest).sum(), 0.0, of_residual);
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
    // Its rounds end at |G u| <= 1e-9 |G u0|. The first solution u0 minimises u^T K u / 2 + penalty |G u|^2 / 2 - f . u with f = load /
    // shear modulus, so that penalty |G u0|^2 is at most the work f . u0. Without the penalty the body is softer, and that work is larger.
    const double first = std::sqrt(work_without_constraints(bar, held, load) / shear_pa / penalty);
    EXPECT_LT((volumes.nearest(u) - u).norm(), 1e-9 * first / singular_values(bar, held).smallest);
    EXPECT_LT(u.col(2).minCoeff(), 0.0);
    // Twice the shear modulus gives half the motion, to the bit.
    EXPECT_EQ(volumes.equilibrium(load, 2.0 * shear_pa), 0.5 * u);
}

// Reference: linear algebra for one hanging particle; for a bar, the time stepper itself, which stays in the state of rest.

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
        const double of_residual = (Eigen::Matrix3d::Identity() - S).inverse().norm() * 1e-7 * (S * acceleration).norm();
        EXPECT_LT((state.displacement.row(3).transpose() - expected).norm(), of_residual) << iterations;
        EXPECT_EQ(state.displacement.topRows(3), Positions::Zero(3, 3));
    }
}

// A bar held at one end, with stretch and volume constraints. A time step with gravity does not move it away from its state of rest: the
// first step is S (x + a dt^2) = x. Only the second order may move it, a share of deflection over edge of the deflection.
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
        stepping.gravity_m_s2 = -deflection_m / (tip * dt_s * dt_s) * Vec3::UnitZ();  // the same deflection at any time step
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
