// The attachment of the flesh is the same on a refined character. Reference: the continuous problem does not depend on the mesh.
#include "experiments/deformers/fem/bone_attachment.hpp"
#include "pbs/character/character.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace experiments;

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
