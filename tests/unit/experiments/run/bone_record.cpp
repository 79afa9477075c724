// bones.csv, bones_rest.csv and binding.csv. Truth: rigid motion by hand, and the limb's own geometry.
#include "experiments/run/bone_record.hpp"

#include "pbs/character/bodies.hpp"

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
    analysis::CsvTable bones = empty_bone_table();
    pbs::Pose pose(2, Eigen::Isometry3d::Identity());
    pose[1].rotate(Eigen::AngleAxisd(0.5 * std::numbers::pi, pbs::Vec3::UnitZ()));
    add_bones(bones, 7, 0.28, arm(), pose);
    ASSERT_EQ(bones.rows(), 2);
    EXPECT_EQ(bones.text_at(0, "parent"), "");
    EXPECT_EQ(bones.text_at(1, "parent"), "upper");
    EXPECT_EQ(bones.integer(1, "frame"), 7);
    EXPECT_NEAR(bones.number(1, "tail_x_m"), 0.0, 1e-15);
    EXPECT_NEAR(bones.number(1, "tail_y_m"), 1.0, 1e-15);
    EXPECT_DOUBLE_EQ(bones.number(0, "head_x_m"), -1.0);
}

TEST(BoneRecord, AtRestABoneStandsWhereItsSkeletonHasIt)
{
    const analysis::CsvTable bones = rest_bone_table(arm());
    ASSERT_EQ(bones.rows(), 2);
    EXPECT_EQ(bones.text_at(0, "bone"), "upper");
    EXPECT_EQ(bones.text_at(0, "parent"), "");
    EXPECT_EQ(bones.text_at(1, "parent"), "upper");
    EXPECT_EQ(bones.number(0, "head_x_m"), -1.0);
    EXPECT_EQ(bones.number(1, "tail_x_m"), 1.0);
    EXPECT_EQ(bones.number(1, "tail_y_m"), 0.0);
}

TEST(BoneRecord, WithoutBonesThereIsNoRow)
{
    analysis::CsvTable bones = empty_bone_table();
    add_bones(bones, 0, 0.0, {}, {});
    EXPECT_EQ(bones.rows(), 0);
}

TEST(BoneRecord, AVertexHangsWhereItIsNearest)
{
    const pbs::Character limb = pbs::make_character({.body = "limb", .vertices = 300});
    const analysis::CsvTable binding = binding_table(limb);
    ASSERT_EQ(binding.rows(), limb.mesh.rest.rows());
    int blended = 0;
    for (int v = 0; v < binding.rows(); ++v) {
        if (std::abs(limb.mesh.rest(v, 0)) < 1e-9) continue;  // as near to one bone as to the other
        const double x = limb.mesh.rest(v, 0), across = limb.mesh.rest.row(v).tail(2).norm();
        const double beyond = std::max(0.0, std::abs(x) - 1.0);
        EXPECT_EQ(binding.text_at(v, "bone"), x <= 0.0 ? "upper" : "forearm") << x;
        EXPECT_NEAR(binding.number(v, "rest_distance_m"), std::hypot(across, beyond), 1e-12);
        blended += static_cast<int>(binding.integer(v, "blended"));
    }
    EXPECT_GT(blended, 0);
    EXPECT_LT(blended, binding.rows());
}

}  // namespace
