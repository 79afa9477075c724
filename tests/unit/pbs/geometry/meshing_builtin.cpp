// Reference: the closed forms of the bodies' volumes, and the specification in the header.
#include "pbs/geometry/meshing.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/quality.hpp"
#include "pbs/geometry/tet_volume.hpp"
#include "tests/support/mesher_error.hpp"
#include "tests/support/volume_rounding.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace {

constexpr double radius = 0.15;
constexpr double capsule_volume = std::numbers::pi * radius * radius * (2.0 + 4.0 / 3.0 * radius);

void expect_sound(const pbs::TetMesh& mesh, int wanted)
{
    const pbs::Quality quality = pbs::quality_of(mesh);
    EXPECT_TRUE(quality.topology.boundary_manifold);
    EXPECT_EQ(quality.topology.boundary_euler, 2);
    EXPECT_EQ(quality.topology.boundary_components, 1);
    EXPECT_EQ(quality.topology.components, 1);
    EXPECT_EQ(quality.topology.unused_vertices, 0);
    EXPECT_GT(pbs::tet_volumes(mesh.rest, mesh.tets).minCoeff(), 0.0);
    EXPECT_GT(quality.min_dihedral_deg, 8.0);
    EXPECT_NEAR(quality.vertices, wanted, 0.1 * wanted);
}

double depth(const pbs::Vec3& p)
{
    return radius - (p - pbs::Vec3(std::clamp(p(0), -1.0, 1.0), 0, 0)).norm();
}

TEST(Limb, IsSoundAtTheWantedSize)
{
    for (const int vertices : {300, 500, 1000}) expect_sound(pbs::mesh_limb(vertices), vertices);
}

TEST(Limb, HasTheDefaultsSize)
{
    const pbs::Quality quality = pbs::quality_of(pbs::mesh_limb(1775));
    EXPECT_NEAR(quality.vertices, 1775, 0.05 * 1775);
    EXPECT_NEAR(quality.tets, 7600, 0.05 * 7600);
}

TEST(Limb, HasItsSkinOnTheCapsule)
{
    const pbs::TetMesh limb = pbs::mesh_limb(500);
    const std::vector<bool> on_skin = pbs::boundary_vertices(limb.tets, limb.rest.rows());
    for (Eigen::Index i = 0; i < limb.rest.rows(); ++i)
        if (on_skin[std::size_t(i)]) {
            EXPECT_NEAR(depth(limb.rest.row(i)), 0.0, test_support::on_skin_m);
        }
}

// The volume that the facets cut off: the depth under a facet is, to leading order, a quadratic form that vanishes at its three corners,
// whose mean is always 3/4 of its value at the middle. The remainder is of the order depth/radius, here 15 % of the cut.
TEST(Limb, HasTheVolumeOfTheCapsuleLessWhatItsFacetsCutOff)
{
    for (const int vertices : {500, 1000}) {
        const pbs::TetMesh limb = pbs::mesh_limb(vertices);
        const pbs::Triangles boundary = pbs::boundary_of(limb.tets);
        double cut = 0.0;
        for (Eigen::Index f = 0; f < boundary.rows(); ++f) {
            const pbs::Vec3 a = limb.rest.row(boundary(f, 0)), b = limb.rest.row(boundary(f, 1)), c = limb.rest.row(boundary(f, 2));
            cut += 0.75 * depth((a + b + c) / 3.0) * 0.5 * (b - a).cross(c - a).norm();
        }
        const double volume = pbs::tet_volumes(limb.rest, limb.tets).sum();
        EXPECT_GT(cut, 0.0);
        EXPECT_LT(cut, 0.06 * capsule_volume);
        EXPECT_NEAR(volume + cut, capsule_volume, 0.15 * cut);
    }
}

// The faces are flat. A point on them goes through some ten roundings where a segment of up to the bar's length meets a plane.
TEST(Bar, IsSoundAtTheWantedSizeAndHasItsExactVolume)
{
    for (const int vertices : {150, 300, 600}) {
        const pbs::TetMesh bar = pbs::mesh_bar(vertices);
        expect_sound(bar, vertices);
        const double of_faces_m = test_support::rounding_error(10, 2.0), area_m2 = 4 * 2.0 * 0.3 + 2 * 0.3 * 0.3;
        EXPECT_NEAR(pbs::tet_volumes(bar.rest, bar.tets).sum(), 2.0 * 0.3 * 0.3,
                    area_m2 * of_faces_m + test_support::volume_error(bar.rest, bar.tets));
        EXPECT_LT((bar.rest.colwise().maxCoeff() - Eigen::RowVector3d(1, 0.15, 0.15)).norm(), std::sqrt(3.0) * of_faces_m);
        EXPECT_LT((bar.rest.colwise().minCoeff() + Eigen::RowVector3d(1, 0.15, 0.15)).norm(), std::sqrt(3.0) * of_faces_m);
    }
}

TEST(BuiltIn, TooFewVerticesAreRefused)
{
    for (const int vertices : {-1, 0, 149}) {
        EXPECT_THROW(pbs::mesh_limb(vertices), pbs::InputError);
        EXPECT_THROW(pbs::mesh_bar(vertices), pbs::InputError);
    }
}

}  // namespace
