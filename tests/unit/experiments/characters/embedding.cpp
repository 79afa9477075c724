// Reference: barycentric coordinates reproduce affine maps exactly, inside and outside; distances of points from a unit
// tet are elementary. Tolerances: barycentric coordinates go through a dozen roundings, times the condition number sqrt
// 6 sqrt 5 of a Kuhn tet's edges.

#include "experiments/characters/embedding.hpp"
#include "tests/support/closed_surfaces.hpp"
#include "tests/support/random_points.hpp"
#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace pbs;
using test_support::rounding_error;
using test_support::unit_tet;

const double of_barycentric = 12.0 * std::sqrt(30.0);

TetMesh cube()
{
    return test_support::structured_bar(Vec3::Zero(), Vec3::Ones(), {1, 1, 1});
}

Positions random_points(int count, double lowest, double highest)
{
    test_support::RandomPoints random(20140528);
    return Positions::NullaryExpr(count, 3, [&] { return random.number(lowest, highest); });
}

double largest_distance(const Vec3& point)
{
    return embed(point.transpose(), Triangles(0, 3), unit_tet()).largest_distance_outside_m;
}

TEST(Embedding, BarycentricCoordinatesSumToOneInsideAndOutside)
{
    const EmbeddedSurface surface = embed(random_points(500, -0.5, 1.5), Triangles(0, 3), cube());
    // The last coordinate is one less the sum of the others, and here is another sum.
    const double magnitude = surface.barycentric.rowwise().lpNorm<1>().maxCoeff();
    EXPECT_LT((surface.barycentric.rowwise().sum().array() - 1.0).abs().maxCoeff(), rounding_error(3 + 3, magnitude));
}

TEST(Embedding, PointsInsideAreCarriedByTheTetThatHoldsThem)
{
    const EmbeddedSurface surface = embed(random_points(500, 0.0, 1.0), Triangles(0, 3), cube());
    EXPECT_GE(surface.barycentric.minCoeff(), -rounding_error(of_barycentric, 1.0));
    EXPECT_EQ(surface.largest_distance_outside_m, 0.0);
}

TEST(Embedding, RestPositionsComeBack)
{
    const TetMesh mesh = cube();
    const Positions points = random_points(200, -0.5, 1.5);
    const EmbeddedSurface surface = embed(points, Triangles(0, 3), mesh);
    EXPECT_LT((embedded_positions(surface, mesh.rest, mesh.tets) - points).cwiseAbs().maxCoeff(),
              rounding_error(of_barycentric + 4 + 3, 3.0));  // points within 3 m
}

TEST(Embedding, AffineMapsAreExact)
{
    const TetMesh mesh = cube();
    const Positions points = random_points(200, -0.5, 1.5);
    Eigen::Matrix3d linear;
    linear << 1.5, 0.2, -0.1, 0.3, 0.8, 0.4, -0.2, 0.1, 2.0;
    const Eigen::RowVector3d shift(3.0, -2.0, 0.5);
    const auto mapped = [&](const Positions& p) -> Positions { return (p * linear.transpose()).rowwise() + shift; };

    const EmbeddedSurface surface = embed(points, Triangles(0, 3), mesh);
    // the sum of terms of both sides
    const double farthest = mapped(points).rowwise().norm().maxCoeff() + linear.norm() * 3.0;
    EXPECT_LT((embedded_positions(surface, mapped(mesh.rest), mesh.tets) - mapped(points)).cwiseAbs().maxCoeff(),
              rounding_error(of_barycentric + 4 + 3 + 4, farthest));
}

TEST(Embedding, DistanceOutsideOfAFaceAnEdgeAndACorner)
{
    const double of_distance = rounding_error(8, 1.0);                                  // of points within 1 m
    EXPECT_NEAR(largest_distance({0.2, 0.3, -0.25}), 0.25, of_distance);                // below the face z = 0
    EXPECT_NEAR(largest_distance({0.5, 0.5, 0.5}), 0.5 / std::sqrt(3.0), of_distance);  // above the slanted face
    EXPECT_NEAR(largest_distance({0.5, -0.3, -0.4}), 0.5, of_distance);                 // outside the edge along x
    // outside the corner at the origin
    EXPECT_NEAR(largest_distance({-1.0, -2.0, -2.0}), 3.0, 3.0 * of_distance);
    EXPECT_EQ(largest_distance({0.1, 0.1, 0.1}), 0.0);  // inside
    EXPECT_EQ(largest_distance({0.0, 0.0, 0.0}), 0.0);  // on a corner
}

TEST(Embedding, TheNearestTetCarriesAPointOutside)
{
    // Beyond x = 1, where the first tet, x >= y >= z, has a face.
    const EmbeddedSurface surface = embed(Positions{{1.2, 0.9, 0.1}}, Triangles(0, 3), cube());
    EXPECT_EQ(surface.tet(0), 0);
    EXPECT_NEAR(surface.largest_distance_outside_m, 0.2, rounding_error(8, 1.2));
}

TEST(Embedding, PointsAreAsFarFromTheTetsAsFromTheirCube)
{
    const Positions points = random_points(300, -1.0, 2.0);
    for (Eigen::Index p = 0; p < points.rows(); ++p) {
        const EmbeddedSurface one = embed(points.row(p), Triangles(0, 3), cube());
        const Vec3 point = points.row(p);
        const double expected = Eigen::AlignedBox3d(Vec3::Zero(), Vec3::Ones()).exteriorDistance(point);
        // coordinates within 4 m
        EXPECT_NEAR(one.largest_distance_outside_m, expected, rounding_error(of_barycentric + 8, 4.0));
    }
}

TEST(Embedding, AnEmptySurfaceStaysEmpty)
{
    const TetMesh mesh = cube();
    const EmbeddedSurface surface = embed(Positions(0, 3), Triangles(0, 3), mesh);
    EXPECT_EQ(embedded_positions(surface, mesh.rest, mesh.tets).rows(), 0);
}

// Reference: the regions of one triangle by hand, and all triangles tried one after another on a dense grid of
// barycentric coordinates.

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
    EXPECT_LE((place_of(found, corner_points, corner_triangle) - expected).norm(), nearest_rounding)
        << point.transpose();
    EXPECT_NEAR(found.distance_m, (point - expected).norm(), nearest_rounding);
    EXPECT_GE(found.barycentric.minCoeff(), 0.0);
    EXPECT_NEAR(found.barycentric.sum(), 1.0, nearest_rounding);
}

TEST(NearestTriangle, IsTheFootOfThePerpendicularOnTheTriangleAnEdgeOrACorner)
{
    for (const auto& [point, nearest] : {std::pair(Vec3(1, 2, 3), Vec3(1, 2, 0)),
                                         {{1, 1, -3}, {1, 1, 0}},  // above it
                                         {{1, -2, 1}, {1, 0, 0}},
                                         {{-2, 3, 1}, {0, 3, 0}},
                                         {{4, 4, 1}, {2, 2, 0}},  // beside an edge
                                         {{-1, -2, 1}, {0, 0, 0}},
                                         {{7, -1, 0}, {4, 0, 0}},
                                         {{-1, 9, 0}, {0, 4, 0}}})  // beyond a corner
        expect_nearest(point, nearest);
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
                const Vec3 place =
                    (1.0 - u - v) * points.row(triangle(0)) + u * points.row(triangle(1)) + v * points.row(triangle(2));
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
        EXPECT_NEAR((place_of(found, sphere.points, sphere.triangles) - point).norm(), found.distance_m,
                    nearest_rounding);
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
        EXPECT_NEAR(SurfaceTree(points, corner_triangle).nearest(scale * Vec3(4, 4, 1)).distance_m / scale, 3.0,
                    nearest_rounding);
    }
}

}  // namespace
