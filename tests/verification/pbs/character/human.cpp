// Reference: the topology of a ball; MakeHuman's own joints; the surface's own volume.
// Needs Debian's assimp-testmodels, which the set-up installs. The mesh comes from the cache if it exists there.
#include "pbs/character/bodies.hpp"
#include "pbs/character/named_bodies.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/closed_surfaces.hpp"
#include "tests/support/expect_ball.hpp"

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
        const Bone& other = human().skeleton.bones[find_bone(human().skeleton, bone.name.substr(0, bone.name.size() - 1) + "R")];
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

}  // namespace
