// Reference: the jiggle zone as the paper defines it: vertices farther from the nearest bone than the mean over all
// vertices (Sec. 4).

#include "experiments/characters/character.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "tests/support/bar_character.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/weight_sums.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>

namespace character_tests {
namespace {

using namespace pbs;
using test_support::weight_in;

std::vector<bool> zone_of(const std::vector<double>& distances)
{
    BoneBinding binding;
    binding.distance = Eigen::Map<const Eigen::VectorXd>(distances.data(), static_cast<Eigen::Index>(distances.size()));
    return jiggle_zone(binding);
}

TEST(JiggleZone, IsFartherThanTheMean)
{
    EXPECT_EQ(zone_of({1.0, 2.0, 3.0, 10.0}), (std::vector<bool>{false, false, false, true}));
    EXPECT_EQ(zone_of({1.0, 2.0, 3.0}), (std::vector<bool>{false, false, true})) << "at the mean is outside";
    EXPECT_EQ(zone_of({0.25, 0.25}), (std::vector<bool>{false, false}));
    EXPECT_TRUE(zone_of({}).empty());
}

// Bone 0 has the mean 2, bone 1 the mean 15; the mean over all vertices would be 8.5.
TEST(JiggleZoneByBone, IsFartherThanTheMeanOfItsOwnBone)
{
    BoneBinding binding;
    binding.bone = {0, 1, 0, 1};
    binding.distance = Eigen::Vector4d(1.0, 10.0, 3.0, 20.0);
    EXPECT_EQ(jiggle_zone_by_bone(binding), (std::vector<bool>{false, false, true, true}));
    EXPECT_EQ(jiggle_zone(binding), (std::vector<bool>{false, true, false, true}));
    EXPECT_TRUE(jiggle_zone_by_bone({}).empty());
}

// Reference: the rules of binding and weights themselves, applied to the finer mesh; and that refinement moves no
// vertex.

Character bar(WeightKind kind = WeightKind::paper)
{
    Character character = test_support::bar_character({12, 2, 2});
    if (kind == WeightKind::rigid) character.weights = rigid_weights(character.binding);
    character.weight_kind = kind;
    return character;
}

Positions lbs(const Character& character)
{
    Positions positions;
    const Pose pose = joint_sweep(character.skeleton, 1, Vec3::UnitZ(), 60.0, 2, 0.01).steps.back();
    linear_blend_skinning(character.mesh.rest, character.weights, pose, positions);
    return positions;
}

TEST(RefinedCharacter, KeepsTheVerticesItHad)
{
    for (const WeightKind kind : {WeightKind::paper, WeightKind::rigid, WeightKind::file}) {
        const Character coarse = bar(kind), fine = refined(coarse);
        const Eigen::Index vertices = coarse.mesh.rest.rows();
        EXPECT_EQ(fine.mesh.rest.topRows(vertices), coarse.mesh.rest);
        EXPECT_EQ(fine.mesh.tets.rows(), 8 * coarse.mesh.tets.rows());
        EXPECT_EQ(fine.binding.distance.head(vertices), coarse.binding.distance);
        EXPECT_TRUE(std::equal(coarse.blended.begin(), coarse.blended.end(), fine.blended.begin()));
        EXPECT_EQ(lbs(fine).topRows(vertices), lbs(coarse));
    }
}

TEST(RefinedCharacter, FollowsTheRulesOnTheNewVertices)
{
    const Character fine = refined(bar());
    const BoneBinding binding = bind_to_nearest_bone(fine.mesh.rest, fine.skeleton);
    const Weights paper = paper_weights(binding, fine.skeleton);
    EXPECT_EQ(fine.binding.bone, binding.bone);
    EXPECT_EQ(fine.weights.bone, paper.bone);
    EXPECT_EQ(fine.weights.weight, paper.weight);
    for (int v = 0; v < paper.vertices(); ++v) EXPECT_EQ(fine.blended[v], paper.blended(v));
    const Character rigid = refined(bar(WeightKind::rigid));
    EXPECT_EQ(rigid.weights.bone, binding.bone);
    EXPECT_EQ(rigid.blended, fine.blended);  // whatever the weights
}

TEST(RefinedCharacter, TakesTheMeanOfWeightsFromAFile)
{
    const Character coarse = bar(WeightKind::file), fine = refined(coarse);
    const Edges parents = refine(coarse.mesh).parents;
    ASSERT_EQ(fine.weights.vertices(), fine.mesh.rest.rows());
    for (int e = 0; e < parents.rows(); ++e) {
        const int vertex = static_cast<int>(coarse.mesh.rest.rows()) + e;
        EXPECT_DOUBLE_EQ(weight_in(fine.weights, vertex, 0), 0.5 * (weight_in(coarse.weights, parents(e, 0), 0) +
                                                                    weight_in(coarse.weights, parents(e, 1), 0)));
        const int entries = fine.weights.first[vertex + 1] - fine.weights.first[vertex];
        EXPECT_NEAR(test_support::sum_of_weights(fine.weights, vertex), 1.0,
                    // of two parents, whose weights are rounded themselves
                    test_support::mean_error(2 * entries, 1.0));
    }
}

TEST(RefinedCharacter, RemembersWhatItIsARefinementOf)
{
    const Character coarse = bar(), fine = refined(coarse), finer = refined(fine);
    EXPECT_EQ(coarse.unrefined, nullptr);
    EXPECT_EQ(fine.refinements, 1);
    EXPECT_EQ(finer.refinements, 2);
    ASSERT_NE(finer.unrefined, nullptr);
    EXPECT_EQ(finer.unrefined->mesh.rest, coarse.mesh.rest);
    EXPECT_EQ(finer.mesh.rest.topRows(coarse.mesh.rest.rows()), coarse.mesh.rest);
}

// Over all tets: the norm of the inverse of the edges' matrix [1/m], and its condition number.
struct EdgeCondition {
    double inverse_per_m = 0.0, condition = 0.0;
};

EdgeCondition edge_condition(const TetMesh& mesh)
{
    EdgeCondition worst;
    for (const auto& tet : mesh.tets.rowwise()) {
        Eigen::Matrix3d edges;
        for (int corner = 1; corner < 4; ++corner)
            edges.row(corner - 1) = mesh.rest.row(tet(corner)) - mesh.rest.row(tet(0));
        worst.inverse_per_m = std::max(worst.inverse_per_m, edges.inverse().norm());
        worst.condition = std::max(worst.condition, edges.norm() * edges.inverse().norm());
    }
    return worst;
}

// Points inside and around the flesh: an affine map of the rest pose moves them equally whichever tet holds them.
TEST(RefinedCharacter, CarriesTheSameSurface)
{
    Character coarse = bar();
    test_support::RandomPoints random(4);
    Positions points(300, 3);
    for (Eigen::Index s = 0; s < points.rows(); ++s)
        points.row(s) = random.point(1.0).cwiseProduct(Vec3(1.1, 0.17, 0.17)).transpose();
    coarse.surface = embed(points, Triangles(0, 3), coarse.mesh);
    const Character fine = refined(coarse);
    ASSERT_TRUE(fine.surface);
    const Eigen::Matrix3d map = (Eigen::Matrix3d() << 1, 0.2, 0, -0.4, 1.5, 0.1, 0, 0.3, 0.9).finished();
    // Barycentric coordinates go through a dozen roundings, times the condition number; a position is a sum of four
    // products with them. The finer mesh takes over positions of the coarse one. All points are within 1.2 m.
    const EdgeCondition of_coarse = edge_condition(coarse.mesh), of_fine = edge_condition(fine.mesh);
    const double coarse_roundings = 12.0 * of_coarse.condition + 4 + 3,
                 fine_roundings = 12.0 * of_fine.condition + 4 + 3;
    const double rounding_m =
        test_support::rounding_error(coarse_roundings + fine_roundings + 4, 2.0 * 1.2 * map.norm());
    const double of_barycentric = of_fine.inverse_per_m * test_support::rounding_error(coarse_roundings, 1.2) +
                                  test_support::rounding_error(fine_roundings, 1.0);
    EXPECT_LT(
        (embedded_positions(*fine.surface, fine.mesh.rest * map, fine.mesh.tets) - points * map).cwiseAbs().maxCoeff(),
        rounding_m);
    for (Eigen::Index s = 0; s < points.rows(); ++s) {
        EXPECT_EQ(fine.surface->tet(s) / 8, coarse.surface->tet(s));
        if (coarse.surface->barycentric.row(s).minCoeff() >= 0.0) {
            EXPECT_GE(fine.surface->barycentric.row(s).minCoeff(), -of_barycentric);  // the child that contains it
        }
    }
    EXPECT_EQ(fine.surface->largest_distance_outside_m, coarse.surface->largest_distance_outside_m);
}

}  // namespace
}  // namespace character_tests
