// Reference: rigid motions of two bones and the artist's points, by hand. A rotation from a singular value decomposition is in error by
// some hundred roundings.
#include "pbs/rig/rig_pose.hpp"
#include "pbs/rig/rigged_body.hpp"

#include "tests/support/rounding_error.hpp"
#include "tests/support/two_joint_rig.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

const double rigid_rounding = test_support::rounding_error(256, 8.0);

struct PosedBody {
    Rig rig;
    RiggedBody body;
    std::vector<Eigen::Affine3d> nodes;
};

// The rig of two joints at a time of its animation, after its root was scaled at rest and in the animation.
PosedBody posed_body(double time_s, const Vec3& scale = Vec3::Ones(), double metres = 1.0)
{
    PosedBody made{test_support::two_joint_rig(), {}, {}};
    made.body = make_rigged_body(made.rig, nullptr, metres);
    made.rig.nodes[0].rest.scale = scale;
    made.nodes = node_transforms(made.rig, &made.rig.animations[0], time_s);
    return made;
}

TEST(RigidPose, OfTheRestPoseIsTheIdentity)
{
    for (const Eigen::Isometry3d& bone : rigid_pose(posed_body(0.0).body, posed_body(0.0).nodes))
        EXPECT_LE((bone.matrix() - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff(), rigid_rounding);
}

TEST(RigidPose, CarriesRestPointsToTheirPlacesInMetres)
{
    const PosedBody half_round = posed_body(1.0, Vec3::Ones(), 0.5);
    const Pose pose = rigid_pose(half_round.body, half_round.nodes);
    EXPECT_LE((pose[0] * Vec3(0.5, 2, 0) - Vec3(0.5, 2, 0)).norm(), rigid_rounding);
    EXPECT_LE((pose[1] * Vec3(0.5, 2, 0) - Vec3(0.5, 0, 0)).norm(), rigid_rounding);  // about (0.5, 1, 0)
}

TEST(RigidPose, LeavesOutScaleAndReportsIt)
{
    double stretch = 0.0;
    const PosedBody scaled = posed_body(0.0, Vec3(1, 1.5, 1));
    const Pose pose = rigid_pose(scaled.body, scaled.nodes, &stretch);
    EXPECT_NEAR(stretch, 0.5, rigid_rounding);
    EXPECT_LE((pose[0].linear() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), rigid_rounding);
    EXPECT_LE((pose[1] * Vec3(1, 2, 0) - Vec3(1, 3, 0)).norm(), rigid_rounding) << "the head follows the joint";
}

TEST(RigidPose, OfAMirroredBoneIsARotation)
{
    const PosedBody mirrored = posed_body(0.0, Vec3(-1, 1, 1));
    for (const Eigen::Isometry3d& bone : rigid_pose(mirrored.body, mirrored.nodes))
        EXPECT_NEAR(bone.linear().determinant(), 1.0, rigid_rounding);
}

TEST(ArtistPoints, AreTheFormatsFormulaInMetres)
{
    const PosedBody half_round = posed_body(1.0, Vec3::Ones(), 0.5);
    Positions expected(4, 3);
    expected << 1, 0, 0, 1, 2, 0, 1, 0, 0, 0.5, 2, 0;
    const Positions points = artist_points(half_round.body, half_round.nodes);
    EXPECT_LE((points - 0.5 * expected).cwiseAbs().maxCoeff(), rigid_rounding);
}

TEST(ArtistPoints, KeepTheScaleThatABoneLoses)
{
    const PosedBody scaled = posed_body(0.0, Vec3(1, 1.5, 1));
    Positions expected = scaled.rig.meshes[0].points;
    expected.col(1) *= 1.5;
    EXPECT_LE((artist_points(scaled.body, scaled.nodes) - expected).cwiseAbs().maxCoeff(), rigid_rounding);
}

}  // namespace
