// Reference: the definitions of the attachments (springs of density q E / r^2 over the capsule; whole tets, no vertex of two bones; bind
// stiffness of density q E / R^2 over the flesh).

#include "experiments/deformers/fem/bone_attachment.hpp"
#include "pbs/character/character.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace {

using namespace experiments;

const FemOptions options{.young_pa = 2e5, .spring_factor = 1e3};
// A translation of norm below 4 is added to points of norm below 1.1, and the points are taken away again.
const double of_sums = test_support::rounding_error(2, 4.0 + 1.1);

// The integral of q E / r^2 over pi r^2 L is q E pi L for any radius.
TEST(EmbeddedAttachment, SpringsAddUpToTheirDensityTimesTheCapsule)
{
    const BoneAttachment bones = embedded_attachment(test_support::bar_character({24, 2, 2}), options);
    double of_forearm = 0.0;
    for (std::size_t s = 0; s < bones.spring_bone.size(); ++s)
        if (bones.spring_bone[s] == 1) of_forearm += bones.attachment.spring_stiffness(s);
    // A stiffness goes through a dozen roundings, and then there is the sum over a bone's samples.
    const double roundings = 12 + static_cast<double>(bones.spring_bone.size()) / 2.0;
    EXPECT_NEAR(of_forearm, 1e3 * 2e5 * std::numbers::pi * 4.0 / 6.0, test_support::rounding_error(roundings, of_forearm));
}

TEST(SpringTargets, FollowTheirBones)
{
    const auto character = test_support::bar_character({24, 2, 2});
    pbs::Pose pose(2, Eigen::Isometry3d::Identity());
    pose[1].translation() = pbs::Vec3(1, 2, 3);
    for (const BoneAttachment& bones : {embedded_attachment(character, options), smooth_attachment(character, options)}) {
        const pbs::Positions moved = spring_targets(bones, pose) - bones.attachment.spring_points;
        for (Eigen::Index s = 0; s < moved.rows(); ++s)
            EXPECT_LT((moved.row(s) - (bones.spring_bone[s] == 1 ? Eigen::RowVector3d(1, 2, 3) : Eigen::RowVector3d(0, 0, 0))).norm(),
                      of_sums);
        EXPECT_EQ(vertex_targets(bones, character.mesh.rest, pose), character.mesh.rest);
    }
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

// Two bones at the same place claim the same vertices: the later one yields, and has no vertices left.
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

// The integral of q E / R^2 over the flesh of both bones, for any mesh: sum k_i R^2 = q E V.
TEST(BindAttachment, StiffnessAddsUpToItsDensityTimesTheFlesh)
{
    for (const auto& cells : {std::array{24, 2, 2}, std::array{16, 4, 4}}) {
        const auto character = test_support::bar_character(cells);
        const BoneAttachment bones = bind_attachment(character, options);
        double sum = 0.0;
        for (Eigen::Index v = 0; v < character.mesh.rest.rows(); ++v) {
            const double radius = bones.capsules[character.binding.bone[v]].radius_m;
            sum += bones.attachment.bind_stiffness(v) * radius * radius;
        }
        // Eight roundings of a tet's volume, sums over at most 24 tets about a vertex and over the vertices, eight roundings of a
        // stiffness.
        const double roundings = 8 + 24 + static_cast<double>(character.mesh.rest.rows()) + 8;
        EXPECT_NEAR(sum, 1e3 * 2e5 * 2.0 * 0.3 * 0.3, test_support::rounding_error(roundings, sum));
        EXPECT_EQ(bones.attachment.bind_distance, character.binding.distance);
    }
}

TEST(BindAttachment, TargetsAreTheRestProjectionsCarriedByTheirBones)
{
    const auto character = test_support::bar_character({24, 2, 2});
    const BoneAttachment bones = bind_attachment(character, options);
    pbs::Pose pose(2, Eigen::Isometry3d::Identity());
    pose[1].translation() = pbs::Vec3(1, 2, 3);
    const reference_fem::Targets held = targets(bones, character.mesh.rest, pose);
    for (Eigen::Index v = 0; v < held.bind_points.rows(); ++v) {
        const pbs::Vec3 moved = held.bind_points.row(v) - character.binding.rest_point.row(v);
        EXPECT_LT((moved - (character.binding.bone[v] == 1 ? pbs::Vec3(1, 2, 3) : pbs::Vec3(0, 0, 0))).norm(), of_sums);
    }
    EXPECT_EQ(held.springs.rows(), 0);
    EXPECT_EQ(held.vertices, character.mesh.rest);
}

TEST(GrippingBones, AreThoseOfTheSpringsTets)
{
    const auto character = test_support::bar_character({24, 2, 2});
    BoneAttachment springs;
    springs.spring_bone = {1, 0};
    springs.spring_density = {1.0, 1.0};
    springs.attachment.spring_stiffness = Eigen::Vector2d(1.0, 1.0);
    springs.vertex_bone.assign(character.mesh.rest.rows(), -1);
    const std::vector<int> gripping = gripping_bones(springs, character.mesh.tets, {5, -1});
    const auto corners = character.mesh.tets.row(5);
    for (int v = 0; v < character.mesh.rest.rows(); ++v)
        EXPECT_EQ(gripping[v], std::find(corners.begin(), corners.end(), v) != corners.end() ? 1 : -1);
}

// A vertex that springs of two bones share belongs to the stiffer ones; springs of less than half of the density on the axis do not count.
TEST(GrippingBones, TheStifferSpringsDecideAndWeakOnesDoNotCount)
{
    const auto character = test_support::bar_character({24, 2, 2});
    BoneAttachment springs;
    springs.spring_bone = {0, 1, 1, 0};
    springs.spring_density = {1.0, 1.0, 1.0, 0.4};
    springs.attachment.spring_stiffness = Eigen::Vector4d(3.0, 2.0, 2.0, 100.0);
    springs.vertex_bone.assign(character.mesh.rest.rows(), -1);
    const std::vector<int> gripping = gripping_bones(springs, character.mesh.tets, {5, 5, 5, 5});
    for (const int v : character.mesh.tets.row(5)) EXPECT_EQ(gripping[v], 1);
}

// The integral of q E / r^2 (1 - (rho / r)^2)^2 across a bone is q E pi / 3; the steps of one radius at both ends take half a radius each.
// The midpoint rule in rho^2 and along the axis is exact within h^2 / 8 times the integral of the second derivative (its Peano kernel). A
// ring holds 24 of 193 points, less than 1/8; the difference outweighs that the point at the centre, 1/193, stands at the end of its share.
TEST(SmoothAttachment, SpringsAddUpToTheIntegralOfTheirDensity)
{
    for (const int samples : {1, 2}) {
        FemOptions smooth{.young_pa = 2e5, .attachment = FemAttachment::smooth, .attachment_samples = samples};
        const BoneAttachment bones = smooth_attachment(test_support::bar_character({24, 2, 2}), smooth);
        const double length = 4.0 / 6.0, radius = bones.capsules[1].radius_m;
        double of_forearm = 0.0;
        for (std::size_t s = 0; s < bones.spring_bone.size(); ++s)
            if (bones.spring_bone[s] == 1) of_forearm += bones.attachment.spring_stiffness(s);
        const double exact = 10.0 * 2e5 * std::numbers::pi / 3.0 * (length - radius);
        const double station = length / (40 * samples), ring = 1.0 / (8 * samples);
        const double along = station * station / 8.0 * (6.0 / radius) / (length - radius), across = ring * ring / 8.0 * 2.0 * 3.0;
        EXPECT_NEAR(of_forearm, exact, (along + across) * exact) << samples;
    }
}

// Each spring lies in the capsule of its own bone and has the density that the kernel has there.
TEST(SmoothAttachment, SpringsLieInTheCapsuleOfTheirBoneAndHaveItsDensity)
{
    const BoneAttachment bones = smooth_attachment(test_support::bar_character({24, 2, 2}), {.attachment = FemAttachment::smooth});
    for (std::size_t s = 0; s < bones.spring_bone.size(); ++s) {
        const pbs::BoneCapsule& capsule = bones.capsules[bones.spring_bone[s]];
        const pbs::Vec3 point = bones.attachment.spring_points.row(s);
        EXPECT_TRUE(capsule.contains(point));
        EXPECT_EQ(bones.spring_density[s], pbs::smooth_density(capsule, pbs::AttachmentKernel::biweight, 1.0, point));
    }
}

// The attachment of the flesh is the same on a refined character. Reference: the continuous problem does not depend on the mesh.

double volume_of(const pbs::TetMesh& mesh, const std::vector<int>& tets)
{
    const Eigen::VectorXd volumes = pbs::tet_volumes(mesh.rest, mesh.tets);
    double volume = 0.0;
    for (const int tet : tets) volume += volumes(tet);
    return volume;
}

// Skin vertices determine the radius. In the middle of edges and faces they are closer to the bone, so without the stored radii of the
// character the capsules would shrink.
class RefinedAttachment : public testing::TestWithParam<FemAttachment> {};

TEST_P(RefinedAttachment, HasTheSameCapsulesAndSprings)
{
    const pbs::Character coarse = test_support::bar_character({24, 2, 2});
    pbs::Character fine = pbs::refined(pbs::refined(coarse));
    const FemOptions options{.attachment = GetParam()};
    const BoneAttachment before = bone_attachment(coarse, options), after = bone_attachment(fine, options);
    ASSERT_GT(before.attachment.spring_points.rows(), 0);
    EXPECT_EQ(after.attachment.spring_points, before.attachment.spring_points);
    EXPECT_EQ(after.attachment.spring_stiffness, before.attachment.spring_stiffness);
    EXPECT_EQ(after.spring_density, before.spring_density);
    EXPECT_EQ(after.spring_bone, before.spring_bone);
    EXPECT_EQ(after.vertex_bone.size(), static_cast<std::size_t>(fine.mesh.rest.rows()));
    for (std::size_t j = 0; j < before.capsules.size(); ++j) EXPECT_EQ(after.capsules[j].radius_m, before.capsules[j].radius_m);
    fine.unrefined = nullptr;
    for (std::size_t j = 0; j < before.capsules.size(); ++j)
        EXPECT_LT(bone_capsules(fine, core_radius_of(options))[j].radius_m, 0.99 * before.capsules[j].radius_m);
}

INSTANTIATE_TEST_SUITE_P(Of, RefinedAttachment, testing::Values(FemAttachment::smooth, FemAttachment::embedded),
                         [](const auto& name) { return name.param == FemAttachment::smooth ? "smooth" : "embedded"; });

TEST(RefinedNodes, HoldTheSameFlesh)
{
    const pbs::Character coarse = test_support::bar_character({48, 8, 8});
    const FemOptions options{.core_radius = 0.6};
    const BoneAttachment before = nodes_attachment(coarse, options);
    pbs::Character fine = coarse;
    for (int level = 1; level <= 2; ++level) {
        fine = pbs::refined(fine);
        const BoneAttachment after = nodes_attachment(fine, options);
        ASSERT_EQ(after.tet_bone.size(), after.attachment.prescribed_tets.size());
        const double volume = volume_of(coarse.mesh, before.attachment.prescribed_tets);
        // A volume goes through eight roundings of products of edges, and a coordinate of at most 1 m is rounded once, over a cell of 2 m /
        // 48 in each direction. Then both volumes are sums.
        const double roundings = 2 * (8 + 3 * 24) + static_cast<double>(before.tet_bone.size() + after.tet_bone.size());
        EXPECT_NEAR(volume_of(fine.mesh, after.attachment.prescribed_tets), volume, test_support::rounding_error(roundings, volume));
        EXPECT_TRUE(std::equal(before.vertex_bone.begin(), before.vertex_bone.end(), after.vertex_bone.begin()));
        for (std::size_t k = 0; k < after.tet_bone.size(); ++k)
            for (const int v : fine.mesh.tets.row(after.attachment.prescribed_tets[k])) EXPECT_EQ(after.vertex_bone[v], after.tet_bone[k]);
    }
}

}  // namespace
