// Reference: counts and volumes of a regular grid, and the formula of its cross-section.
#include "experiments/studies/equal_quality/tapered_limb.hpp"

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

const pbs::Character limb = experiments::tapered_limb();

TEST(TaperedLimb, Counts)
{
    EXPECT_EQ(limb.mesh.rest.rows(), 25 * 9 * 9);
    EXPECT_EQ(limb.mesh.tets.rows(), 6 * 24 * 8 * 8);
    // V - E + F - T = 1 of a ball, with 2 F = 4 T + B; each outer square has two of the B triangles.
    const int boundary = 2 * (2 * 8 * 8 + 4 * 24 * 8);
    EXPECT_EQ(pbs::edges_of(limb.mesh.tets).rows(), 2025 + 9216 + boundary / 2 - 1);
}

TEST(TaperedLimb, EveryTetHasAPositiveVolume)
{
    EXPECT_GT(pbs::tet_volumes(limb.mesh.rest, limb.mesh.tets).minCoeff(), 0.0);
}

// The outline of a layer has 32 points on a circle. Its area is below that of the disc and above that of the inscribed square, which has
// the share 2 / pi of the disc. Frustum: pi (R^2 + R r + r^2) / 3 times its length.
TEST(TaperedLimb, VolumeIsNearlyThatOfTheFrustum)
{
    const double frustum = std::numbers::pi * (0.24 * 0.24 + 0.24 * 0.12 + 0.12 * 0.12) / 3.0 * 2.0;
    const double volume = pbs::tet_volumes(limb.mesh.rest, limb.mesh.tets).sum();
    EXPECT_LT(volume, frustum);
    EXPECT_GT(volume, 2.0 / std::numbers::pi * frustum);
}

// The outline lies on the circle to the last digits: u^2 (1 - v^2 / 2) + v^2 (1 - u^2 / 2) = 1 where |u| = 1.
TEST(TaperedLimb, TheOutlineOfALayerIsACircle)
{
    for (const int i : {0, 12, 24})
        for (int k = 0; k < 9; ++k) {
            const Eigen::RowVector3d point = limb.mesh.rest.row(i * 81 + k);  // u = -1
            EXPECT_NEAR(std::hypot(point(1), point(2)), 0.24 - 0.12 * i / 24, 1e-15);
        }
}

TEST(TaperedLimb, BindsToTwoBones)
{
    EXPECT_EQ(limb.skeleton.bones.size(), 2u);
    EXPECT_EQ(limb.weights.vertices(), 2025);
    EXPECT_EQ(limb.binding.distance.size(), 2025);
}

}  // namespace
