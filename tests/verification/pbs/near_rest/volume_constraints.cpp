// Reference: for one tet and two, counting by hand; for a bar, the paper's solver itself, whose projections converge to the nearest point
// of the set (S. Kaczmarz 1937, for consistent linear equations). The locking table compares the equilibrium with the linear tets of the
// reference.
#include "pbs/near_rest/volume_constraints.hpp"

#include "pbs/solver/pbs_solver.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

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
    EXPECT_LT((volumes.nearest(rigid) - rigid).cwiseAbs().maxCoeff(), 1e-12);
}

// 4,000 iterations of the solver with k_volume = 1 and no other constraints, from a bend of 1e-6: they end at the nearest point, up to the
// second order in the bend over a cell (1e-5 of it), and up to 1e-6 of the bend by their own convergence on this mesh.
TEST(VolumeConstraints, NearestIsWhereTheSolverEnds)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, -0.5, -0.5}, {5, 0.5, 0.5}, {10, 2, 2});
    const Positions motion = bent(bar), nearest = VolumeConstraints(bar, none_of(bar)).nearest(motion);
    pbs::PbsOptions options;
    options.iterations = 4000;
    options.k_stretch = options.k_bind = 0.0;
    options.precision = pbs::Precision::f64;
    pbs::PbsSolver solver(bar, Eigen::VectorXd::Zero(bar.rest.rows()), {}, options);
    const double amplitude = 1e-6 / motion.cwiseAbs().maxCoeff();
    solver.advance(bar.rest + amplitude * motion, bar.rest, 1.0);
    const Positions reached = (solver.positions() - bar.rest) / amplitude;
    EXPECT_LT((reached - nearest).norm(), 1e-5 * motion.norm());
    EXPECT_GT((reached - motion).norm(), 0.05 * motion.norm());  // the body did move
    // It is a projection: the part that was removed is orthogonal to the rest.
    EXPECT_NEAR((motion - nearest).cwiseProduct(nearest).sum(), 0.0, 1e-9 * motion.squaredNorm());
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
    const Positions u = volumes.equilibrium(load, 2.0);
    EXPECT_LT((volumes.nearest(u) - u).norm(), 1e-8 * u.norm());
    EXPECT_LT(u.col(2).minCoeff(), 0.0);
    // Twice the shear modulus gives half the motion.
    EXPECT_LT((volumes.equilibrium(load, 4.0) - 0.5 * u).norm(), 1e-9 * u.norm());
}

}  // namespace
