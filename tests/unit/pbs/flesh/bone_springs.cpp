// Reference: the springs one by one, each with its point carried by the tet that contains it.
#include "pbs/flesh/bone_springs.hpp"

#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/held_bar.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

namespace {

using pbs::Positions;
using pbs::Vec3;

const test_support::TwoBoneLimb bent = test_support::two_bone_limb({12, 3, 3}, Vec3::UnitZ(), 70.0);

double one_by_one(const pbs::BoneSprings& springs, const Positions& x)
{
    const pbs::PointLocation where(bent.mesh);
    double energy = 0.0;
    for (Eigen::Index s = 0; s < springs.points.rows(); ++s) {
        const Vec3 point = springs.points.row(s);
        const pbs::Location at = where.locate(point);
        if (at.tet < 0) continue;
        Vec3 carried = (1.0 - at.barycentric.sum()) * x.row(bent.mesh.tets(at.tet, 0)).transpose();
        for (int c = 0; c < 3; ++c) carried += at.barycentric(c) * x.row(bent.mesh.tets(at.tet, c + 1)).transpose();
        energy += springs.stiffness(s) / 2.0 * (carried - bent.pose[springs.bone[s]] * point).squaredNorm();
    }
    return energy;
}

double summed(const pbs::BoneHold& hold, const Positions& x)
{
    Positions centres;
    hold.centres(bent.pose, centres);
    double energy = hold.constant(bent.pose, centres);
    for (Eigen::Index i = 0; i < x.rows(); ++i) energy += hold.stiffness()(i) / 2.0 * (x.row(i) - centres.row(i)).squaredNorm();
    constexpr int edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    for (Eigen::Index t = 0; t < bent.mesh.tets.rows(); ++t)
        for (int e = 0; e < 6; ++e)
            energy += hold.edge_stiffness()(t, e) / 2.0 *
                      (x.row(bent.mesh.tets(t, edges[e][0])) - x.row(bent.mesh.tets(t, edges[e][1]))).squaredNorm();
    return energy;
}

// Each of the 200 springs goes through some 20 sums of terms of at most k |x|^2, |x| < 2 m, k < 15.
TEST(BoneHold, HasTheEnergyOfItsSprings)
{
    const pbs::BoneSprings springs = test_support::random_springs(200, 10.0);
    const pbs::BoneHold hold(bent.mesh, springs, 2);
    EXPECT_EQ(hold.left_out(), 0);
    for (const double size : {0.0, 0.1, 1.0}) {
        const Positions x = test_support::jittered(bent.lbs, size);
        EXPECT_NEAR(summed(hold, x), one_by_one(springs, x), test_support::rounding_error(20.0 * 200, 15.0 * 16.0));
    }
}

TEST(BoneHold, LeavesSpringsOutsideTheTetsOut)
{
    pbs::BoneSprings springs = test_support::random_springs(10, 1.0);
    springs.points.row(3) << 0.5, 0.5, 0.5;
    const pbs::BoneHold hold(bent.mesh, springs, 2);
    EXPECT_EQ(hold.left_out(), 1);
    EXPECT_NEAR(hold.stiffness().sum(), springs.stiffness.sum() - springs.stiffness(3), test_support::rounding_error(50, 10.0));
}

TEST(BoneHold, PartsOfTheBonesAddUpToTheStiffness)
{
    const pbs::BoneHold hold(bent.mesh, test_support::random_springs(100, 1.0), 2);
    EXPECT_LE((hold.stiffness_of_bones().rowwise().sum() - hold.stiffness()).cwiseAbs().maxCoeff(),
              test_support::rounding_error(100, hold.stiffness().maxCoeff()));
}

TEST(BoneHold, AVertexWithoutSpringsHasNoCentre)
{
    const pbs::BoneHold hold(bent.mesh, test_support::random_springs(1, 1.0), 2);
    Positions centres;
    hold.centres(bent.pose, centres);
    for (Eigen::Index i = 0; i < centres.rows(); ++i)
        if (hold.stiffness()(i) == 0.0) {
            EXPECT_EQ(centres.row(i), Eigen::RowVector3d::Zero());
        }
    EXPECT_EQ((hold.stiffness().array() > 0.0).count(), 4);
}

}  // namespace
