// Reference: the regions of one triangle by hand, and all triangles tried one after another on a dense grid of barycentric coordinates.
#include "pbs/character/nearest_triangle.hpp"

#include "tests/support/closed_surfaces.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"

#include <gtest/gtest.h>

namespace {

using namespace pbs;

const double nearest_rounding = test_support::rounding_error(64, 8.0);

const Positions corner_points = (Positions(3, 3) << 0, 0, 0, 4, 0, 0, 0, 4, 0).finished();
const Triangles corner_triangle = (Triangles(1, 3) << 0, 1, 2).finished();

Vec3 place_of(const SurfacePoint& found, const Positions& points, const Triangles& triangles)
{
    Vec3 place = Vec3::Zero();
    for (int k = 0; k < 3; ++k) place += found.barycentric(k) * points.row(triangles(found.triangle, k)).transpose();
    return place;
}

void expect_nearest(const Vec3& point, const Vec3& expected)
{
    const SurfacePoint found = SurfaceTree(corner_points, corner_triangle).nearest(point);
    EXPECT_EQ(found.triangle, 0);
    EXPECT_LE((place_of(found, corner_points, corner_triangle) - expected).norm(), nearest_rounding) << point.transpose();
    EXPECT_NEAR(found.distance_m, (point - expected).norm(), nearest_rounding);
    EXPECT_GE(found.barycentric.minCoeff(), 0.0);
    EXPECT_NEAR(found.barycentric.sum(), 1.0, nearest_rounding);
}

TEST(NearestTriangle, AboveATriangleIsTheFootOfThePerpendicular)
{
    expect_nearest({1, 2, 3}, {1, 2, 0});
    expect_nearest({1, 1, -3}, {1, 1, 0});
}

TEST(NearestTriangle, BesideATriangleIsAnEdge)
{
    expect_nearest({1, -2, 1}, {1, 0, 0});
    expect_nearest({-2, 3, 1}, {0, 3, 0});
    expect_nearest({4, 4, 1}, {2, 2, 0});
}

TEST(NearestTriangle, BeyondACornerIsTheCorner)
{
    expect_nearest({-1, -2, 1}, {0, 0, 0});
    expect_nearest({7, -1, 0}, {4, 0, 0});
    expect_nearest({-1, 9, 0}, {0, 4, 0});
}

TEST(NearestTriangle, OnATriangleIsThePointItself)
{
    for (const Vec3& point : {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 2, 0), Vec3(1, 1, 0)}) expect_nearest(point, point);
}

TEST(NearestTriangle, TrianglesWithoutAreaAreSegmentsAndPoints)
{
    const Positions points = (Positions(3, 3) << 0, 0, 0, 4, 0, 0, 1, 0, 0).finished();
    const Triangles line = (Triangles(1, 3) << 0, 1, 2).finished(), dot = (Triangles(1, 3) << 1, 1, 1).finished();
    EXPECT_NEAR(SurfaceTree(points, line).nearest({3, 2, 0}).distance_m, 2.0, nearest_rounding);
    EXPECT_NEAR(SurfaceTree(points, dot).nearest({4, 3, 4}).distance_m, 5.0, nearest_rounding);
    EXPECT_NEAR(SurfaceTree(points, dot).nearest({4, 3, 4}).barycentric.sum(), 1.0, nearest_rounding);
}

// Walks over the triangle in steps that are finer than the tolerance of the comparison.
double distance_by_sampling(const Vec3& point, const Positions& points, const Triangles& triangles, int steps)
{
    double least = 1e300;
    for (const auto& triangle : triangles.rowwise())
        for (int i = 0; i <= steps; ++i)
            for (int j = 0; j <= steps - i; ++j) {
                const double u = double(i) / steps, v = double(j) / steps;
                const Vec3 place = (1.0 - u - v) * points.row(triangle(0)) + u * points.row(triangle(1)) + v * points.row(triangle(2));
                least = std::min(least, (place - point).norm());
            }
    return least;
}

TEST(NearestTriangle, OfManyIsThatOfAllTriedOneByOne)
{
    const SurfaceMesh sphere = test_support::icosphere(1.0, 1);  // 80 triangles
    const SurfaceTree tree(sphere.points, sphere.triangles);
    test_support::RandomPoints random(1);
    for (int trial = 0; trial < 50; ++trial) {
        const Vec3 point = random.point(2.0);
        const SurfacePoint found = tree.nearest(point);
        EXPECT_NEAR((place_of(found, sphere.points, sphere.triangles) - point).norm(), found.distance_m, nearest_rounding);
        // A sample is at most one step of the longest edge, 0.62 / 30, from the nearest point.
        const double sampled = distance_by_sampling(point, sphere.points, sphere.triangles, 30);
        EXPECT_LE(found.distance_m, sampled + nearest_rounding);
        EXPECT_GE(found.distance_m, sampled - 0.62 / 30.0);
    }
}

TEST(NearestTriangle, OfManyIsNeverFartherThanAnyAlone)
{
    const SurfaceMesh torus = test_support::torus(1.0, 0.3, 12, 8);
    const SurfaceTree tree(torus.points, torus.triangles);
    test_support::RandomPoints random(2);
    for (int trial = 0; trial < 20; ++trial) {
        const Vec3 point = random.point(1.5);
        double least = 1e300;
        for (Eigen::Index f = 0; f < torus.triangles.rows(); ++f) {
            const Triangles one = torus.triangles.row(f);
            least = std::min(least, SurfaceTree(torus.points, one).nearest(point).distance_m);
        }
        EXPECT_EQ(tree.nearest(point).distance_m, least);
    }
}

TEST(NearestTriangle, DoesNotDependOnTheScale)
{
    for (const double scale : {1e-6, 1e6}) {
        const Positions points = scale * corner_points;
        EXPECT_NEAR(SurfaceTree(points, corner_triangle).nearest(scale * Vec3(4, 4, 1)).distance_m / scale, 3.0, nearest_rounding);
    }
}

}  // namespace
