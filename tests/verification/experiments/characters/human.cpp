// Reference: the topology of a ball; MakeHuman's own joints; the surface's own volume.
// Needs Debian's assimp-testmodels, which the set-up installs. The mesh comes from the cache if it exists there.
#include "experiments/characters/bodies.hpp"
#include "experiments/characters/named_bodies.hpp"
#include "experiments/characters/skinning_weights.hpp"
#include "experiments/clips/clip.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/skinning/blend.hpp"
#include "tests/support/closed_surfaces.hpp"
#include "tests/support/expect_ball.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/weight_sums.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using namespace pbs;

const Character& human()
{
    static const Character character = make_character({.body = "human"});
    return character;
}

double area(const Positions& points, const Triangles& triangles)
{
    double area_m2 = 0.0;
    for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
        const Vec3 a = points.row(triangles(t, 0)), b = points.row(triangles(t, 1)), c = points.row(triangles(t, 2));
        area_m2 += 0.5 * (b - a).cross(c - a).norm();
    }
    return area_m2;
}

TEST(Human, IsABallOfGoodTets)
{
    const Quality quality = quality_of(human().mesh);
    RecordProperty("vertices", quality.vertices);
    RecordProperty("edges", quality.edges);
    RecordProperty("tets", quality.tets);
    RecordProperty("min_dihedral_deg", std::to_string(quality.min_dihedral_deg));
    test_support::expect_ball(quality);
    // The paper's Table 1 has 1,654 (Man) and 2,645 (ManHQ) vertices.
    EXPECT_GT(quality.vertices, 1654);
    EXPECT_LT(quality.vertices, 2645);
}

TEST(Human, HasTheVolumeOfItsSurfaceAndTheWrapsOffset)
{
    const EmbeddedSurface& surface = human().surface.value();
    const Positions skin = embedded_positions(surface, human().mesh.rest, human().mesh.tets);
    const double inside_m3 = test_support::enclosed_volume(skin, surface.triangles);
    const double tets_m3 = quality_of(human().mesh).volume_m3;
    RecordProperty("surface_litres", std::to_string(1000.0 * inside_m3));
    RecordProperty("tets_litres", std::to_string(1000.0 * tets_m3));
    // The wrap lies an offset of the diagonal / 510 outside the skin; chords of facets cut off some of that.
    const double diagonal_m = (skin.colwise().maxCoeff() - skin.colwise().minCoeff()).norm();
    EXPECT_GT(tets_m3, inside_m3);
    EXPECT_LT(tets_m3, inside_m3 + diagonal_m / 510.0 * area(skin, surface.triangles));
}

TEST(Human, JointsLieInside)
{
    Positions heads(static_cast<Eigen::Index>(human().skeleton.bones.size()), 3);
    for (Eigen::Index bone = 0; bone < heads.rows(); ++bone) heads.row(bone) = human().skeleton.bones[bone].head;
    EXPECT_EQ(embed(heads, Triangles(0, 3), human().mesh).largest_distance_outside_m, 0.0);
}

TEST(Human, TheSkeletonIsOneTreeOfJoinedBones)
{
    const Skeleton& skeleton = human().skeleton;
    ASSERT_EQ(skeleton.bones.size(), 23u);
    for (std::size_t bone = 1; bone < 23; ++bone) {
        EXPECT_GE(skeleton.bones[bone].parent, 0);
        const std::string& name = skeleton.bones[bone].name;
        const Bone& parent = skeleton.bones[skeleton.bones[bone].parent];
        if (name.starts_with("clavicle") || name.starts_with("hip")) continue;  // they branch off from their parents
        EXPECT_EQ(skeleton.bones[bone].head, parent.tail) << name;
    }
}

TEST(Human, LeftAndRightAreMirrored)
{
    for (const Bone& bone : human().skeleton.bones) {
        if (!bone.name.ends_with(".L")) continue;
        const Bone& other =
            human().skeleton.bones[find_bone(human().skeleton, bone.name.substr(0, bone.name.size() - 1) + "R")];
        EXPECT_EQ(other.head, bone.head.cwiseProduct(Vec3(-1, 1, 1))) << bone.name;
        EXPECT_EQ(other.tail, bone.tail.cwiseProduct(Vec3(-1, 1, 1))) << bone.name;
    }
}

TEST(Human, TheSurfaceIsMakeHumansWholeAndNearTheTets)
{
    const EmbeddedSurface& surface = human().surface.value();
    EXPECT_EQ(surface.tet.rows(), 13380);
    EXPECT_EQ(surface.triangles.rows(), 2 * 13378);
    RecordProperty("largest_distance_outside_m", std::to_string(surface.largest_distance_outside_m));
    EXPECT_LT(surface.largest_distance_outside_m, 0.02);
}

// Smooth weights on the real body, as a control of Eq. 2. Reference: the definition of weights (they are not negative
// and sum up to one) and the tets' own orientation. In the crouch of clip 01_01 LBS with Eq. 2's weights, which jump
// between vertices, turns tets inside out.

const Pose& crouch()
{
    static const Motion motion = [] {
        ClipSampling sampling;
        sampling.time_step_s = 0.01;
        sampling.rate_hz = 100.0;
        return retarget(read_clip(find_clip("01_01.bvh", ".")), human().skeleton, sampling);
    }();
    return motion.steps.at(164);
}

template <class Blend>
int inverted_tets(WeightKind kind, const Blend& blend)
{
    Positions posed;
    blend(human().mesh.rest, weights_by(kind, human()), crouch(), posed);
    return static_cast<int>((tet_volumes(posed, human().mesh.tets).array() <= 0.0).count());
}

TEST(SmoothWeightsOfTheHuman, SumUpToOneAndAreNotNegative)
{
    const Weights weights = weights_by(WeightKind::diffused, human());
    ASSERT_EQ(weights.vertices(), human().mesh.rest.rows());
    int blended = 0;
    for (const double weight : weights.weight) EXPECT_GE(weight, 0.0);
    for (int v = 0; v < weights.vertices(); ++v) {
        EXPECT_NEAR(test_support::sum_of_weights(weights, v), 1.0,
                    test_support::mean_error(weights.first[v + 1] - weights.first[v], 1.0));
        blended += weights.blended(v);
    }
    EXPECT_GT(blended, weights.vertices() / 10);
}

// Both blends have the same pose and the same mesh, and the counts are whole numbers: no tolerance. The blends with
// smooth weights leave at most a tenth of the inverted tets.
TEST(SmoothWeightsOfTheHuman, LeaveFewerTetsInverted)
{
    const int paper = inverted_tets(WeightKind::paper, linear_blend_skinning),
              smooth = inverted_tets(WeightKind::diffused, linear_blend_skinning);
    RecordProperty("inverted_by_lbs_with_paper_weights", paper);
    RecordProperty("inverted_by_lbs_with_smooth_weights", smooth);
    EXPECT_GT(paper, 50);
    EXPECT_LT(10 * smooth, paper);
    EXPECT_LT(inverted_tets(WeightKind::diffused, dual_quaternion_skinning),
              inverted_tets(WeightKind::paper, dual_quaternion_skinning));
}

}  // namespace
