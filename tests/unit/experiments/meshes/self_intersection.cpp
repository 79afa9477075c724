// Reference: bodies whose contact is obvious.
#include "experiments/meshes/meshing.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/closed_surfaces.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

// Two spheres side by side along x, `distance` between their middles.
pbs::SurfaceMesh two_spheres(double distance)
{
    const pbs::SurfaceMesh one = test_support::icosphere(1.0, 2);
    pbs::SurfaceMesh two{pbs::Positions(2 * one.points.rows(), 3), pbs::Triangles(2 * one.triangles.rows(), 3)};
    two.points << one.points, one.points.rowwise() + Eigen::RowVector3d(distance, 0, 0);
    two.triangles << one.triangles, one.triangles.array() + static_cast<int>(one.points.rows());
    return two;
}

TEST(SelfIntersection, NeighboursAlongEdgesAndVerticesDoNotCount)
{
    const pbs::SurfaceMesh sphere = test_support::icosphere(1.0, 2);
    EXPECT_FALSE(pbs::self_intersects(sphere.points, sphere.triangles));
    EXPECT_EQ(pbs::count_self_intersections(sphere.points, sphere.triangles), 0);
}

TEST(SelfIntersection, SpheresThroughEachOtherAreFoundAndApartAreNot)
{
    const pbs::SurfaceMesh apart = two_spheres(2.1), through = two_spheres(1.0);
    EXPECT_FALSE(pbs::self_intersects(apart.points, apart.triangles));
    EXPECT_TRUE(pbs::self_intersects(through.points, through.triangles));
    EXPECT_GT(pbs::count_self_intersections(through.points, through.triangles), 0);
}

TEST(SelfIntersection, PairsOfTrianglesAreToldByTheirPlaces)
{
    pbs::SurfaceMesh two{pbs::Positions(6, 3), pbs::Triangles(2, 3)};
    two.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.2, 0.2, -1, 0.3, 0.2, 1, 0.2, 0.3, 1;
    two.triangles << 0, 1, 2, 3, 4, 5;
    const std::vector<std::array<int, 2>> pair = {{0, 1}};
    EXPECT_EQ(pbs::self_intersections(two.points, two.triangles), pair);
}

TEST(SelfIntersection, ABarBentThroughItselfIsFound)
{
    pbs::TetMesh bar = test_support::structured_bar({-1, -0.1, -0.1}, {1, 0.1, 0.1}, {20, 2, 2});
    const pbs::Triangles boundary = pbs::boundary_of(bar.tets);
    EXPECT_FALSE(pbs::self_intersects(bar.rest, boundary));
    // bend the bar to a circle whose circumference is shorter than the bar
    for (Eigen::Index i = 0; i < bar.rest.rows(); ++i) {
        const double angle = 4.0 * bar.rest(i, 0), r = 0.3 + bar.rest(i, 1);
        bar.rest.row(i) << r * std::sin(angle), r * std::cos(angle), bar.rest(i, 2);
    }
    EXPECT_TRUE(pbs::self_intersects(bar.rest, boundary));
}

// A torus around z: a cut through its axis gives two circles of the tube's radius, one across its axis two concentric
// circles, and one outside it none. A point of a cut goes through some twelve roundings of coordinates up to 1.4. The
// tube's 20 sides lie up to 0.4 (1 - cos pi / 20) inside it, the 40 sides around the axis up to 1.4 (1 - cos pi / 40),
// and the cut passes the axis at 0.01.
TEST(SectionOutlines, OfATorus)
{
    const pbs::SurfaceMesh torus = test_support::torus(1.0, 0.4, 40, 20);
    const auto sections =
        pbs::section_outlines(torus.points, torus.triangles,
                              {{{0, 0.01, 0}, {0, 2, 0}}, {{0, 0, 0.01}, {0, 0, 1}}, {{0, 0, 0.5}, {0, 0, 1}}});
    ASSERT_EQ(sections.size(), 3u);
    ASSERT_EQ(sections[0].size(), 2u);
    for (const pbs::Positions& circle : sections[0])
        for (Eigen::Index i = 0; i < circle.rows(); ++i) {
            EXPECT_NEAR(circle(i, 1), 0.01, test_support::rounding_error(12, 1.4));
            EXPECT_NEAR(std::hypot(std::abs(circle(i, 0)) - 1.0, circle(i, 2)), 0.4,
                        0.005 + 0.0044 + 0.01 * 0.01 / (2.0 * 0.6));
        }
    EXPECT_EQ(sections[1].size(), 2u);
    EXPECT_TRUE(sections[2].empty());
}

TEST(SectionOutlines, ASurfaceThroughItselfIsCutAndANormalOfZeroIsRefused)
{
    const pbs::SurfaceMesh through = two_spheres(1.0);
    EXPECT_EQ(pbs::section_outlines(through.points, through.triangles, {{{0.5, 0, 0.01}, {0, 0, 1}}})[0].size(), 2u);
    EXPECT_THROW(pbs::section_outlines(through.points, through.triangles, {{{0, 0, 0}, {0, 0, 0}}}), pbs::InputError);
}

TEST(PointsInside, AreToldFromThoseOutside)
{
    const pbs::SurfaceMesh torus = test_support::torus(1.0, 0.4, 40, 20);
    const std::vector<bool> inside =
        pbs::points_inside(torus.points, torus.triangles, {{1, 0, 0}, {0, 0, 0}, {0, -1.1, 0.1}, {2, 0, 0}});
    EXPECT_EQ(inside, (std::vector<bool>{true, false, true, false}));
}

TEST(PointsInside, AskAClosedSurface)
{
    pbs::SurfaceMesh sphere = test_support::icosphere(1.0, 1);
    sphere.triangles = sphere.triangles.bottomRows(10).eval();
    EXPECT_THROW(pbs::points_inside(sphere.points, sphere.triangles, {{0, 0, 0}}), pbs::InputError);
    EXPECT_THROW(pbs::points_inside(sphere.points, pbs::Triangles(0, 3), {{0, 0, 0}}), pbs::InputError);
}

}  // namespace
