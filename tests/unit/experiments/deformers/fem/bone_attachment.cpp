// Truth: the definitions of the two attachments (springs of density q E / r^2 over the capsule; whole tets, no vertex of two bones).
#include "experiments/deformers/fem/bone_attachment.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/unit/experiments/deformers/fem/bar_character.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace {

using namespace experiments;

const FemOptions options{.young_pa = 2e5, .spring_factor = 1e3};

// The integral of q E / r^2 over pi r^2 L is q E pi L, whatever the radius.
TEST(EmbeddedAttachment, SpringsAddUpToTheirDensityTimesTheCapsule)
{
    const BoneAttachment bones = embedded_attachment(test_support::bar_character({24, 2, 2}), options);
    double of_forearm = 0.0;
    for (std::size_t s = 0; s < bones.spring_bone.size(); ++s)
        if (bones.spring_bone[s] == 1) of_forearm += bones.attachment.spring_stiffness(s);
    EXPECT_NEAR(of_forearm, 1e3 * 2e5 * std::numbers::pi * 4.0 / 6.0, 1e-6 * of_forearm);
}

TEST(EmbeddedAttachment, TargetsFollowTheirBones)
{
    const auto character = test_support::bar_character({24, 2, 2});
    const BoneAttachment bones = embedded_attachment(character, options);
    pbs::Pose pose(2, Eigen::Isometry3d::Identity());
    pose[1].translation() = pbs::Vec3(1, 2, 3);
    const pbs::Positions moved = spring_targets(bones, pose) - bones.attachment.spring_points;
    for (Eigen::Index s = 0; s < moved.rows(); ++s)
        EXPECT_LT((moved.row(s) - (bones.spring_bone[s] == 1 ? Eigen::RowVector3d(1, 2, 3) : Eigen::RowVector3d(0, 0, 0))).norm(), 1e-14);
    EXPECT_EQ(vertex_targets(bones, character.mesh.rest, pose), character.mesh.rest);
}

TEST(NodesAttachment, WholeTetsInsideTheCapsulesAndNoVertexOfTwoBones)
{
    const auto character = test_support::bar_character({48, 8, 8});
    const BoneAttachment bones = nodes_attachment(character, {.core_radius = 0.6});
    ASSERT_FALSE(bones.tet_bone.empty());
    for (std::size_t k = 0; k < bones.tet_bone.size(); ++k)
        for (const int v : character.mesh.tets.row(bones.attachment.prescribed_tets[k])) {
            EXPECT_EQ(bones.vertex_bone[v], bones.tet_bone[k]);
            EXPECT_TRUE(bones.capsules[bones.tet_bone[k]].contains(character.mesh.rest.row(v)));
        }
    EXPECT_EQ(bones.attachment.spring_points.rows(), 0);
}

// Two bones on the same place claim the same vertices: the later one gives way, and is then left with nothing.
TEST(NodesAttachment, TheLaterBoneGivesWay)
{
    auto character = test_support::bar_character({48, 8, 8});
    auto twin = character.skeleton.bones[1];
    twin.name = "twin";
    character.skeleton.bones.push_back(twin);
    try {
        nodes_attachment(character, {.core_radius = 0.6});
        FAIL();
    } catch (const pbs::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("twin"), std::string::npos) << error.what();
    }
}

TEST(NodesAttachment, AMeshTooCoarseForWholeTetsIsRefusedWithTheBonesName)
{
    try {
        nodes_attachment(test_support::bar_character({24, 2, 2}), {});
        FAIL();
    } catch (const pbs::InputError& error) {
        EXPECT_NE(std::string(error.what()).find("upper"), std::string::npos) << error.what();
    }
}

}  // namespace
