// Reference: volumes known in closed form.
#include "pbs/geometry/tet_volume.hpp"

#include "tests/support/structured_bar.hpp"
#include "tests/support/volume_rounding.hpp"

#include <gtest/gtest.h>

namespace {

const pbs::Vec3 origin(0, 0, 0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);

TEST(TetVolume, OfTheUnitCornerIsASixth)
{
    EXPECT_DOUBLE_EQ(pbs::tet_volume(origin, x, y, z), 1.0 / 6.0);
}

TEST(TetVolume, OfAMirroredTetIsNegative)
{
    EXPECT_DOUBLE_EQ(pbs::tet_volume(origin, y, x, z), -1.0 / 6.0);
}

TEST(TetVolume, OfAFlatTetIsZero)
{
    EXPECT_EQ(pbs::tet_volume(origin, x, y, x + y), 0.0);
}

TEST(TetVolume, OfACollapsedTetIsZero)
{
    EXPECT_EQ(pbs::tet_volume(x, x, x, x), 0.0);
}

TEST(TetVolume, ScalesWithTheCube)
{
    for (const double size : {1e-6, 1e-3, 1e3, 1e6})
        EXPECT_NEAR(pbs::tet_volume(origin, size * x, size * y, size * z) * 6.0 / (size * size * size), 1.0,
                    test_support::rounding_error(8, 1.0));
}

TEST(TetVolumes, AddUpToTheBar)
{
    const pbs::TetMesh bar = test_support::structured_bar({-1, -0.15, -0.15}, {1, 0.15, 0.15}, {10, 3, 3});
    const Eigen::VectorXd volumes = pbs::tet_volumes(bar.rest, bar.tets);
    EXPECT_EQ(volumes.size(), 6 * 10 * 3 * 3);
    EXPECT_GT(volumes.minCoeff(), 0.0);
    const double rounding_m3 = test_support::volume_error(bar.rest, bar.tets);
    EXPECT_NEAR(volumes.sum(), 0.18, rounding_m3);
    // Sums over at most 24 tets about a vertex, and over the vertices.
    const double of_sums = test_support::rounding_error(24.0 + static_cast<double>(bar.rest.rows()), 0.18);
    EXPECT_NEAR(pbs::lumped_volumes(bar.rest, bar.tets).sum(), 0.18, rounding_m3 + of_sums);
}

TEST(LumpedVolumes, AreAQuarterOfEachTetAround)
{
    pbs::Positions rest(5, 3);
    rest << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 9, 9, 9;
    pbs::Tets tets(1, 4);
    tets << 0, 1, 2, 3;
    const Eigen::VectorXd lumped = pbs::lumped_volumes(rest, tets);
    for (int corner = 0; corner < 4; ++corner) EXPECT_DOUBLE_EQ(lumped(corner), 1.0 / 24.0);
    EXPECT_EQ(lumped(4), 0.0);
}

}  // namespace
