// bones.csv, bones_rest.csv and binding.csv. Reference: rigid motion by hand, and the limb's own geometry. Tolerances: the rounding of
// motions and of distances.
#include "experiments/run/run_records.hpp"

#include "pbs/character/bodies.hpp"
#include "tests/support/motion_rounding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using namespace experiments;

pbs::Skeleton arm()
{
    return {{{"upper", -1, pbs::Vec3(-1.0, 0.0, 0.0), pbs::Vec3::Zero()}, {"forearm", 0, pbs::Vec3::Zero(), pbs::Vec3(1.0, 0.0, 0.0)}}};
}

TEST(BoneRecord, ABoneStandsWhereThePosePutsIt)
{
    std::vector<PosedBone> bones;
    pbs::Pose pose(2, Eigen::Isometry3d::Identity());
    pose[1].rotate(Eigen::AngleAxisd(0.5 * std::numbers::pi, pbs::Vec3::UnitZ()));
    add_bones(bones, 7, 0.28, arm(), pose);
    ASSERT_EQ(bones.size(), 2u);
    EXPECT_EQ(bones[0].place.parent, "");
    EXPECT_EQ(bones[1].place.parent, "upper");
    EXPECT_EQ(bones[1].frame, 7);
    EXPECT_LE((bones[1].place.tail - pbs::Vec3::UnitY()).norm(), test_support::motion_error(1, 1.0));
    EXPECT_EQ(bones[0].place.head, pbs::Vec3(-1.0, 0.0, 0.0));
}

TEST(BoneRecord, AtRestABoneStandsWhereItsSkeletonHasIt)
{
    const analysis::CsvTable bones = table_of(bone_columns, bones_at_rest(arm()));
    EXPECT_EQ(bones.text(),
              "bone,parent,head_x_m,head_y_m,head_z_m,tail_x_m,tail_y_m,tail_z_m\n"
              "upper,,-1,0,0,0,0,0\n"
              "forearm,upper,0,0,0,1,0,0\n");
}

TEST(BoneRecord, WithoutBonesThereIsNoRow)
{
    std::vector<PosedBone> bones;
    add_bones(bones, 0, 0.0, {}, {});
    EXPECT_TRUE(bones.empty());
}

TEST(BoneRecord, AVertexBelongsToItsNearestBone)
{
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 300});
    const std::vector<BoundVertex> vertices = bound_vertices(limb);
    ASSERT_EQ(std::ssize(vertices), limb.mesh.rest.rows());
    // The foot of a vertex on a bone goes through two roundings of coordinates of at most 1, and its distance through six, on both sides.
    const double rounding_m = test_support::rounding_error(2 + 6, 1.0);
    int blended = 0;
    for (const BoundVertex& bound : vertices) {
        const double x = limb.mesh.rest(bound.vertex, 0), across = limb.mesh.rest.row(bound.vertex).tail(2).norm();
        // The distances sqrt(across^2 + x^2) and across to the two bones differ by at most x^2 / (2 across).
        if (x * x <= 2.0 * across * rounding_m) continue;
        const double beyond = std::max(0.0, std::abs(x) - 1.0);
        EXPECT_EQ(bound.bone, x <= 0.0 ? "upper" : "forearm") << x;
        EXPECT_NEAR(bound.rest_distance_m, std::hypot(across, beyond), rounding_m);
        blended += bound.blended;
    }
    EXPECT_GT(blended, 0);
    EXPECT_LT(blended, std::ssize(vertices));
}

}  // namespace
