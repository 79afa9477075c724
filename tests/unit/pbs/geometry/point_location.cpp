// Reference: the barycentric coordinates of a point that was placed in a known tet, and a search through all tets.
#include "pbs/geometry/tet_mesh.hpp"

#include "tests/support/rounding_error.hpp"
#include "tests/support/structured_bar.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <random>

namespace {

using pbs::Location;
using pbs::PointLocation;
using pbs::Vec3;

const pbs::TetMesh bar = test_support::structured_bar({-1, -0.15, -0.15}, {1, 0.15, 0.15}, {20, 3, 3});

Vec3 point_in(const pbs::TetMesh& mesh, int tet, const Vec3& barycentric)
{
    Vec3 point = (1.0 - barycentric.sum()) * mesh.rest.row(mesh.tets(tet, 0)).transpose();
    for (int c = 0; c < 3; ++c) point += barycentric(c) * mesh.rest.row(mesh.tets(tet, c + 1)).transpose();
    return point;
}

// The first tet, in order, whose smallest barycentric coordinate is at least -1e-10.
int first_tet_by_search(const pbs::TetMesh& mesh, const Vec3& point)
{
    for (int t = 0; t < mesh.tets.rows(); ++t) {
        Eigen::Matrix4d corners;
        for (int c = 0; c < 4; ++c) corners.col(c) << mesh.rest.row(mesh.tets(t, c)).transpose(), 1.0;
        const Eigen::Vector4d barycentric = corners.lu().solve(Eigen::Vector4d(point(0), point(1), point(2), 1.0));
        if (barycentric.minCoeff() >= -1e-10) return t;
    }
    return -1;
}

TEST(PointLocation, FindsEveryTetByItsOwnInnerPoint)
{
    const PointLocation where(bar);
    const Vec3 barycentric(0.2, 0.3, 0.4);
    // The point, of norm below 1.1, goes through six roundings. The inverse of the edges, of norm sqrt 5 / 0.1 on a Kuhn tet, magnifies
    // them, and goes through a dozen of its own, times the condition number sqrt 6 sqrt 5.
    using test_support::rounding_error;
    const double rounding = rounding_error(6, 1.1) * std::sqrt(5.0) / 0.1 + rounding_error(12 * std::sqrt(30.0) + 3, barycentric.norm());
    for (int t = 0; t < bar.tets.rows(); ++t) {
        const Location found = where.locate(point_in(bar, t, barycentric));
        EXPECT_EQ(found.tet, t);
        EXPECT_LT((found.barycentric - barycentric).norm(), rounding);
    }
}

TEST(PointLocation, AgreesWithASearchThroughAllTetsInsideAndOutside)
{
    const PointLocation where(bar);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> along(-1.1, 1.1), across(-0.18, 0.18);
    for (int i = 0; i < 500; ++i) {
        const Vec3 point(along(random), across(random), across(random));
        EXPECT_EQ(where.locate(point).tet, first_tet_by_search(bar, point)) << point.transpose();
    }
}

TEST(PointLocation, PointsOnVerticesEdgesAndFacesGoToTheLowestTet)
{
    const PointLocation where(bar);
    for (int t = 0; t < bar.tets.rows(); t += 7)
        for (const Vec3& barycentric : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0.5, 0), Vec3(0.25, 0, 0.25), Vec3(0.2, 0.3, 0.5)}) {
            const Vec3 point = point_in(bar, t, barycentric);
            EXPECT_EQ(where.locate(point).tet, first_tet_by_search(bar, point));
        }
}

TEST(PointLocation, PointsFarOutsideOrNotANumberAreInNoTet)
{
    const PointLocation where(bar);
    EXPECT_EQ(where.locate({1e300, 0, 0}).tet, -1);
    EXPECT_EQ(where.locate({0, -1e9, 0}).tet, -1);
    EXPECT_EQ(where.locate({0, 0, 0.1501}).tet, -1);
    EXPECT_EQ(where.locate(Vec3::Constant(std::nan(""))).tet, -1);
}

TEST(PointLocation, OneTetAlone)
{
    pbs::TetMesh tet;
    tet.rest = pbs::Positions::Zero(4, 3);
    tet.rest(1, 0) = tet.rest(2, 1) = tet.rest(3, 2) = 1.0;
    tet.tets.resize(1, 4);
    tet.tets << 0, 1, 2, 3;
    const PointLocation where(tet);
    EXPECT_EQ(where.locate({0.2, 0.2, 0.2}).tet, 0);
    EXPECT_EQ(where.locate({0.4, 0.4, 0.4}).tet, -1);
}

}  // namespace
