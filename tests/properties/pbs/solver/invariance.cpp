// Reference: a step depends only on lengths and volumes, so it commutes with rigid motions, mirrors, changes of unit,
// and every renumbering that keeps the order of projection (another order is another Gauss-Seidel sweep). Tolerance:
// the rounding of two steps (step_rounding.hpp), which is that of 24 iterations of constraints that contradict each
// other; a gentle bend, in which no tet inverts, limits its growth.
#include "pbs/solver/pbs_solver.hpp"

#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/step_rounding.hpp"
#include "tests/support/two_bone_limb.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace solver_invariance_tests {
namespace {

using namespace test_support;
using pbs::PbsOptions;
using pbs::Positions;
using pbs::Precision;
using pbs::Vec3;

const TwoBoneLimb limb = two_bone_limb({12, 3, 3}, Vec3::UnitZ(), 40.0);

Positions stepped(const pbs::TetMesh& mesh, const Eigen::VectorXd& distance, const Positions& lbs,
                  const Positions& bind_points, const PbsOptions& options)
{
    pbs::PbsSolver solver(mesh, distance, {}, options);
    solver.advance(lbs, bind_points, 0.01);
    return solver.positions();
}

Positions stepped(const PbsOptions& options)
{
    return stepped(limb.mesh, limb.binding.distance, limb.lbs, limb.bind_points, options);
}

PbsOptions with(Precision precision)
{
    PbsOptions options;
    options.precision = precision;
    return options;
}

struct Setting {
    Precision precision;
    double tolerance;  // of two steps
};
const std::array<Setting, 2> settings = {{{Precision::f64, 2.0 * step_rounding_m(limb, with(Precision::f64))},
                                          {Precision::f32, 2.0 * step_rounding_m(limb, with(Precision::f32))}}};

TEST(StepInvariance, RigidMotion)
{
    RandomPoints random(61);
    for (const auto& [precision, tolerance] : settings)
        for (int trial = 0; trial < 5; ++trial) {
            const Eigen::Isometry3d motion = random.rigid_motion(1.0);
            const Positions moved = stepped(limb.mesh, limb.binding.distance, transformed(limb.lbs, motion),
                                            transformed(limb.bind_points, motion), with(precision));
            const double farther = 1.0 + motion.translation().norm();  // the limb is 1 m long on either side
            EXPECT_LT((moved - transformed(stepped(with(precision)), motion)).cwiseAbs().maxCoeff(),
                      farther * tolerance);
        }
}

TEST(StepInvariance, Mirror)
{
    Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity();
    mirror(1, 1) = -1.0;
    pbs::TetMesh mesh = limb.mesh;
    mesh.rest = limb.mesh.rest * mirror;
    mesh.tets.col(1).swap(mesh.tets.col(2));
    for (const auto& [precision, tolerance] : settings) {
        const Positions mirrored =
            stepped(mesh, limb.binding.distance, limb.lbs * mirror, limb.bind_points * mirror, with(precision));
        EXPECT_LT((mirrored - stepped(with(precision)) * mirror).cwiseAbs().maxCoeff(), tolerance);
    }
}

TEST(StepInvariance, ScaleFromAMicrometreToAThousandKilometres)
{
    for (const auto& [precision, tolerance] : settings)
        for (const pbs::Masses masses : {pbs::Masses::unit, pbs::Masses::lumped})
            for (const double size : {1e-6, 1e-3, 1e3, 1e6}) {
                PbsOptions options = with(precision);
                options.masses = masses;
                const pbs::TetMesh mesh{size * limb.mesh.rest, limb.mesh.tets};
                const Positions scaled =
                    stepped(mesh, size * limb.binding.distance, size * limb.lbs, size * limb.bind_points, options);
                EXPECT_LT((scaled / size - stepped(options)).cwiseAbs().maxCoeff(), tolerance) << size;
            }
}

TEST(StepInvariance, PowersOfTwoChangeNoBit)
{
    const double size = std::ldexp(1.0, 12);
    const pbs::TetMesh mesh{size * limb.mesh.rest, limb.mesh.tets};
    for (const Precision precision : {Precision::f32, Precision::f64})
        EXPECT_EQ(
            stepped(mesh, size * limb.binding.distance, size * limb.lbs, size * limb.bind_points, with(precision)),
            Positions(size * stepped(with(precision))));
}

// Reversing the numbers of the vertices keeps the order of the tets, but not that of the edges. Without stretch, no bit
// changes in file order.
TEST(StepInvariance, PermutationWithoutStretchChangesNoBit)
{
    pbs::TetMesh mesh{limb.mesh.rest.colwise().reverse(), limb.mesh.tets};
    mesh.tets.array() = int(limb.mesh.rest.rows()) - 1 - limb.mesh.tets.array();
    PbsOptions options = with(Precision::f64);
    options.order = pbs::Order::plain;
    options.k_stretch = 0.0;
    const Positions reversed = stepped(mesh, limb.binding.distance.reverse(), limb.lbs.colwise().reverse(),
                                       limb.bind_points.colwise().reverse(), options);
    EXPECT_EQ(Positions(reversed.colwise().reverse()), stepped(options));
}

// Vertices that no tet uses shift the numbers of the others and keep their order: no bit changes, with all constraints.
TEST(StepInvariance, UnusedVerticesChangeNoBit)
{
    const auto with_leading = [](const auto& array) {
        auto longer = array;
        longer.resize(array.rows() + 1, array.cols());
        longer.row(0).setZero();
        longer.bottomRows(array.rows()) = array;
        return longer;
    };
    pbs::TetMesh mesh{with_leading(limb.mesh.rest), limb.mesh.tets};
    mesh.tets.array() += 1;
    const Positions longer = stepped(mesh, with_leading(limb.binding.distance), with_leading(limb.lbs),
                                     with_leading(limb.bind_points), with(Precision::f64));
    EXPECT_EQ(Positions(longer.bottomRows(limb.mesh.rest.rows())), stepped(with(Precision::f64)));
}

// Eq. 3 for whole iterations of stretch and volume. Bind is left out, since its bone takes the reaction. (Eq. 4 holds
// for each projection about its initial positions, which the previous projections have moved.)
TEST(StepInvariance, LinearMomentumOfStretchAndVolumeIsConserved)
{
    for (const auto& [precision, tolerance] : settings)
        for (const pbs::Masses masses : {pbs::Masses::unit, pbs::Masses::lumped}) {
            PbsOptions options = with(precision);
            options.masses = masses;
            options.k_bind = 0.0;
            Eigen::VectorXd mass = Eigen::VectorXd::Ones(limb.mesh.rest.rows());
            if (masses == pbs::Masses::lumped) mass = pbs::lumped_volumes(limb.mesh.rest, limb.mesh.tets);
            const Positions moved_by = stepped(options) - limb.lbs;
            EXPECT_LT((mass.transpose() * moved_by).norm() / mass.sum(), tolerance);
            EXPECT_GT(moved_by.cwiseAbs().maxCoeff(), 1e-3);
        }
}

}  // namespace
}  // namespace solver_invariance_tests
