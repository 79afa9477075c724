// Reference: the definitions of the attachments (springs of density q E / r^2 over the capsule; whole tets, no vertex
// of two bones; bind stiffness of density q E / R^2 over the flesh).

#include "experiments/characters/character.hpp"
#include "experiments/deformers/fem/bone_attachment.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/rounding_error.hpp"

#include <algorithm>
#include <numbers>

namespace {

using namespace test_support;
using namespace experiments;

FemOptions by(FemAttachment attachment, double spring_factor = 1e3)
{
    return {.young_pa = 2e5, .attachment = attachment, .spring_factor = spring_factor};
}

const FemOptions by_nodes{.attachment = FemAttachment::nodes, .core_radius = 0.6};

// The sum of the stiffness of the forearm's springs [N/m].
double stiffness_of_forearm(const BoneAttachment& bones)
{
    double sum = 0.0;
    for (std::size_t s = 0; s < bones.spring_bone.size(); ++s)
        if (bones.spring_bone[s] == 1) sum += bones.attachment.spring_stiffness(s);
    return sum;
}

// The integral of q E / r^2 over pi r^2 L is q E pi L for any radius.
TEST(EmbeddedAttachment, SpringsAddUpToTheirDensityTimesTheCapsule)
{
    const BoneAttachment bones = bone_attachment(bar_character({24, 2, 2}), by(FemAttachment::embedded));
    const double sum = stiffness_of_forearm(bones);
    // A stiffness goes through a dozen roundings, and then there is the sum over a bone's samples.
    const double roundings = 12 + static_cast<double>(bones.spring_bone.size()) / 2.0;
    EXPECT_NEAR(sum, 1e3 * 2e5 * std::numbers::pi * 4.0 / 6.0, rounding_error(roundings, sum));
}

// Bound vertices are tied to their rest projections. A translation of norm below 4 is added to points of norm
// below 1.1, and the points are taken away again.
TEST(BoneAttachment, TargetsAreCarriedByTheirBones)
{
    const auto character = bar_character({24, 2, 2});
    pbs::Pose pose(2, Eigen::Isometry3d::Identity());
    pose[1].translation() = pbs::Vec3(1, 2, 3);
    for (const FemAttachment kind : {FemAttachment::embedded, FemAttachment::smooth, FemAttachment::bind}) {
        const BoneAttachment bones = bone_attachment(character, by(kind));
        const reference_fem::Targets held = targets(bones, character.mesh.rest, pose);
        const bool bound = kind == FemAttachment::bind;
        const pbs::Positions moved = bound ? pbs::Positions(held.bind_points - character.binding.rest_point)
                                           : pbs::Positions(held.springs - bones.attachment.spring_points);
        const std::vector<int>& bone = bound ? character.binding.bone : bones.spring_bone;
        ASSERT_GT(moved.rows(), 0);
        for (Eigen::Index s = 0; s < moved.rows(); ++s)
            EXPECT_LT(
                (moved.row(s) - (bone[s] == 1 ? Eigen::RowVector3d(1, 2, 3) : Eigen::RowVector3d(0, 0, 0))).norm(),
                rounding_error(2, 4.0 + 1.1));
        EXPECT_EQ(held.springs.rows(), bound ? 0 : moved.rows());
        EXPECT_EQ(held.vertices, character.mesh.rest);
    }
}

// Two bones at the same place claim the same vertices: the later one yields, and has no vertices left. A mesh that is
// too coarse for whole tets is refused with the bone's name.
TEST(NodesAttachment, WholeTetsInsideTheCapsulesAndTheLaterBoneGivesWay)
{
    auto character = bar_character({48, 8, 8});
    const BoneAttachment bones = bone_attachment(character, by_nodes);
    ASSERT_FALSE(bones.tet_bone.empty());
    for (std::size_t k = 0; k < bones.tet_bone.size(); ++k)
        for (const int v : character.mesh.tets.row(bones.attachment.prescribed_tets[k])) {
            EXPECT_EQ(bones.vertex_bone[v], bones.tet_bone[k]);
            EXPECT_TRUE(bones.capsules[bones.tet_bone[k]].contains(character.mesh.rest.row(v)));
        }
    EXPECT_EQ(bones.attachment.spring_points.rows(), 0);
    character.skeleton.bones.push_back(character.skeleton.bones[1]);
    character.skeleton.bones.back().name = "twin";
    expect_refused("twin", [&] { bone_attachment(character, by_nodes); });
    expect_refused("upper", [&] { bone_attachment(bar_character({24, 2, 2}), {.attachment = FemAttachment::nodes}); });
}

// The integral of q E / R^2 over the flesh of both bones, for any mesh: sum k_i R^2 = q E V.
TEST(BindAttachment, StiffnessAddsUpToItsDensityTimesTheFlesh)
{
    for (const auto& cells : {std::array{24, 2, 2}, std::array{16, 4, 4}}) {
        const auto character = bar_character(cells);
        const BoneAttachment bones = bone_attachment(character, by(FemAttachment::bind));
        double sum = 0.0;
        for (Eigen::Index v = 0; v < character.mesh.rest.rows(); ++v) {
            const double radius = bones.capsules[character.binding.bone[v]].radius_m;
            sum += bones.attachment.bind_stiffness(v) * radius * radius;
        }
        // Eight roundings of a tet's volume, sums over at most 24 tets about a vertex and over the vertices, eight
        // roundings of a stiffness.
        const double roundings = 8 + 24 + static_cast<double>(character.mesh.rest.rows()) + 8;
        EXPECT_NEAR(sum, 1e3 * 2e5 * 2.0 * 0.3 * 0.3, rounding_error(roundings, sum));
        EXPECT_EQ(bones.attachment.bind_distance, character.binding.distance);
    }
}

// Springs in tet 5 or outside. A vertex that springs of two bones share belongs to the stiffer ones; springs of less
// than half of the density on the axis do not count.
TEST(GrippingBones, AreThoseOfTheSpringsTetsWhereTheStifferOnesDecide)
{
    const auto character = bar_character({24, 2, 2});
    const auto corners = character.mesh.tets.row(5);
    const auto gripping = [&](const std::vector<int>& bone, const std::vector<double>& density,
                              const std::vector<double>& stiffness, const std::vector<int>& tets) {
        BoneAttachment springs;
        springs.spring_bone = bone;
        springs.spring_density = density;
        springs.attachment.spring_stiffness =
            Eigen::VectorXd::Map(stiffness.data(), static_cast<Eigen::Index>(stiffness.size()));
        springs.vertex_bone.assign(character.mesh.rest.rows(), -1);
        return gripping_bones(springs, character.mesh.tets, tets);
    };
    const std::vector<int> one_inside = gripping({1, 0}, {1.0, 1.0}, {1.0, 1.0}, {5, -1});
    for (int v = 0; v < character.mesh.rest.rows(); ++v)
        EXPECT_EQ(one_inside[v], std::find(corners.begin(), corners.end(), v) != corners.end() ? 1 : -1);
    const std::vector<int> shared = gripping({0, 1, 1, 0}, {1.0, 1.0, 1.0, 0.4}, {3.0, 2.0, 2.0, 100.0}, {5, 5, 5, 5});
    for (const int v : corners) EXPECT_EQ(shared[v], 1);
}

// The integral of q E / r^2 (1 - (rho / r)^2)^2 across a bone is q E pi / 3; the steps of one radius at both ends take
// half a radius each. The midpoint rule in rho^2 and along the axis is exact within h^2 / 8 times the integral of the
// second derivative (its Peano kernel). A ring holds 24 of 193 points, less than 1/8; the difference outweighs that the
// point at the centre, 1/193, stands at the end of its share.
TEST(SmoothAttachment, SpringsAddUpToTheIntegralOfTheirDensityAndLieInTheCapsuleOfTheirBone)
{
    for (const int samples : {1, 2}) {
        const BoneAttachment bones =
            bone_attachment(bar_character({24, 2, 2}), {.young_pa = 2e5, .attachment_samples = samples});
        const double length = 4.0 / 6.0, radius = bones.capsules[1].radius_m;
        const double exact = 10.0 * 2e5 * std::numbers::pi / 3.0 * (length - radius);
        const double station = length / (40 * samples), ring = 1.0 / (8 * samples);
        const double along = station * station / 8.0 * (6.0 / radius) / (length - radius),
                     across = ring * ring / 8.0 * 2.0 * 3.0;
        EXPECT_NEAR(stiffness_of_forearm(bones), exact, (along + across) * exact) << samples;
    }
    // Each spring lies in the capsule of its own bone and has the density that the kernel has there.
    const BoneAttachment bones = bone_attachment(bar_character({24, 2, 2}), {});
    for (std::size_t s = 0; s < bones.spring_bone.size(); ++s) {
        const pbs::BoneCapsule& capsule = bones.capsules[bones.spring_bone[s]];
        const pbs::Vec3 point = bones.attachment.spring_points.row(s);
        EXPECT_TRUE(capsule.contains(point));
        EXPECT_EQ(bones.spring_density[s], pbs::smooth_density(capsule, pbs::AttachmentKernel::biweight, 1.0, point));
    }
}

// The attachment of the flesh is the same on a refined character. Reference: the continuous problem does not depend on
// the mesh.

double volume_of(const pbs::TetMesh& mesh, const std::vector<int>& tets)
{
    const Eigen::VectorXd volumes = pbs::tet_volumes(mesh.rest, mesh.tets);
    double volume = 0.0;
    for (const int tet : tets) volume += volumes(tet);
    return volume;
}

// Skin vertices determine the radius. In the middle of edges and faces they are closer to the bone, so without the
// stored radii of the character the capsules would shrink.
TEST(RefinedAttachment, HasTheSameCapsulesAndSprings)
{
    const pbs::Character coarse = bar_character({24, 2, 2});
    for (const FemAttachment kind : {FemAttachment::smooth, FemAttachment::embedded}) {
        pbs::Character fine = pbs::refined(pbs::refined(coarse));
        const FemOptions options{.attachment = kind};
        const BoneAttachment before = bone_attachment(coarse, options), after = bone_attachment(fine, options);
        ASSERT_GT(before.attachment.spring_points.rows(), 0);
        EXPECT_EQ(after.attachment.spring_points, before.attachment.spring_points);
        EXPECT_EQ(after.attachment.spring_stiffness, before.attachment.spring_stiffness);
        EXPECT_EQ(after.spring_density, before.spring_density);
        EXPECT_EQ(after.spring_bone, before.spring_bone);
        EXPECT_EQ(after.vertex_bone.size(), static_cast<std::size_t>(fine.mesh.rest.rows()));
        fine.unrefined = nullptr;
        const std::vector<pbs::BoneCapsule> shrunk = bone_capsules(fine, options.used_core_radius());
        for (std::size_t j = 0; j < before.capsules.size(); ++j) {
            EXPECT_EQ(after.capsules[j].radius_m, before.capsules[j].radius_m);
            EXPECT_LT(shrunk[j].radius_m, 0.99 * before.capsules[j].radius_m);
        }
    }
}

TEST(RefinedNodes, HoldTheSameFlesh)
{
    const pbs::Character coarse = bar_character({48, 8, 8});
    const BoneAttachment before = bone_attachment(coarse, by_nodes);
    pbs::Character fine = coarse;
    for (int level = 1; level <= 2; ++level) {
        fine = pbs::refined(fine);
        const BoneAttachment after = bone_attachment(fine, by_nodes);
        ASSERT_EQ(after.tet_bone.size(), after.attachment.prescribed_tets.size());
        const double volume = volume_of(coarse.mesh, before.attachment.prescribed_tets);
        // A volume goes through eight roundings of products of edges, and a coordinate of at most 1 m is rounded once,
        // over a cell of 2 m / 48 in each direction. Then both volumes are sums.
        const double roundings = 2 * (8 + 3 * 24) + static_cast<double>(before.tet_bone.size() + after.tet_bone.size());
        EXPECT_NEAR(volume_of(fine.mesh, after.attachment.prescribed_tets), volume, rounding_error(roundings, volume));
        EXPECT_TRUE(std::equal(before.vertex_bone.begin(), before.vertex_bone.end(), after.vertex_bone.begin()));
        for (std::size_t k = 0; k < after.tet_bone.size(); ++k)
            for (const int v : fine.mesh.tets.row(after.attachment.prescribed_tets[k]))
                EXPECT_EQ(after.vertex_bone[v], after.tet_bone[k]);
    }
}

}  // namespace
