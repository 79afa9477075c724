// Reference: 4/3 for the octahedron, the tets inside a boundary, and s^3. Tolerances: the roundings of volumes. Each volume between an
// octahedron's triangle and one of its vertices is rounded once, by its division by 6; the sum is compensated.
#include "analysis/metrics/frame_metrics.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "tests/support/structured_bar.hpp"
#include "tests/support/volume_rounding.hpp"

#include <gtest/gtest.h>

namespace {

using analysis::enclosed_volume;
using pbs::Positions;
using pbs::Triangles;
using test_support::rounding_error;

Positions octahedron_points()
{
    Positions points(6, 3);
    points << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
    return points;
}

Triangles octahedron_triangles()
{
    Triangles triangles(8, 3);
    triangles << 0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5;
    return triangles;
}

TEST(SurfaceVolume, OfAnOctahedron)
{
    EXPECT_NEAR(enclosed_volume(octahedron_points(), octahedron_triangles()), 4.0 / 3.0, rounding_error(3, 4.0 / 3.0));
}

TEST(SurfaceVolume, FarFromTheOriginLosesNoDigits)
{
    const Positions far = octahedron_points().rowwise() + Eigen::RowVector3d(1e8, -1e8, 1e8);
    EXPECT_EQ(enclosed_volume(far, octahedron_triangles()), enclosed_volume(octahedron_points(), octahedron_triangles()));
}

TEST(SurfaceVolume, InsideOutIsNegative)
{
    const Triangles inward = octahedron_triangles().rowwise().reverse();
    EXPECT_NEAR(enclosed_volume(octahedron_points(), inward), -4.0 / 3.0, rounding_error(3, 4.0 / 3.0));
    EXPECT_THROW(analysis::surface_volume_change_pct(octahedron_points(), octahedron_points(), inward), pbs::InputError);
}

TEST(SurfaceVolume, OfABoundaryIsThatOfTheTetsInside)
{
    const auto bar = test_support::structured_bar({-1.0, -0.15, -0.15}, {1.0, 0.15, 0.15}, {6, 2, 2});
    Positions bent = bar.rest;
    bent.col(2).array() += 0.3 * bent.col(0).array().square();
    const Triangles skin = pbs::boundary_of(bar.tets);
    pbs::Tets between(skin.rows(), 4);  // the triangles and one vertex
    between << Eigen::VectorXi::Constant(skin.rows(), skin(0, 0)), skin;
    EXPECT_NEAR(enclosed_volume(bent, skin), pbs::tet_volumes(bent, bar.tets).sum(),
                test_support::volume_error(bent, bar.tets) + test_support::volume_error(bent, between));
}

TEST(SurfaceVolume, ChangeOfAScaledSurface)
{
    const Positions rest = octahedron_points();
    // 1.1 is rounded, three times as a factor; its products, the volumes and their ratio go through ten more roundings.
    EXPECT_NEAR(analysis::surface_volume_change_pct(rest, 1.1 * rest, octahedron_triangles()), 33.1, rounding_error(3 + 10, 133.1));
}

TEST(SurfaceVolume, RefusesSurfacesThatAreNotClosed)
{
    const Positions points = octahedron_points();
    Triangles flipped = octahedron_triangles();
    std::swap(flipped(3, 0), flipped(3, 1));
    Triangles out_of_range = octahedron_triangles();
    out_of_range(0, 0) = 6;
    EXPECT_THROW(enclosed_volume(points, octahedron_triangles().topRows(7)), pbs::InputError);
    EXPECT_THROW(enclosed_volume(points, flipped), pbs::InputError);
    EXPECT_THROW(enclosed_volume(points, out_of_range), pbs::InputError);
    EXPECT_THROW(enclosed_volume(points, Triangles(0, 3)), pbs::InputError);
    EXPECT_THROW(analysis::surface_volume_change_pct(points, points.topRows(5), octahedron_triangles()), pbs::InputError);
}

}  // namespace
