// Reference: angles and sizes of tets known in closed form.
#include "pbs/geometry/quality.hpp"

#include "tests/support/structured_bar.hpp"
#include "tests/support/volume_rounding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

constexpr double degree = 180.0 / std::numbers::pi;

// Angles of tets whose coordinates are whole numbers: normals are exact; their norm, the angle, two conversions and pi are rounded. Those
// of comparison go through seven roundings: a root and a quotient in the cosine, the angle, the conversion and pi.
constexpr double of_angles_deg = test_support::rounding_error(5 + 7, 90.0);

TEST(DihedralAngles, OfARegularTetAreAcosOfAThird)
{
    for (const double angle_deg : pbs::dihedral_angles_deg({1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}))
        EXPECT_NEAR(angle_deg, std::acos(1.0 / 3.0) * degree, of_angles_deg);
}

TEST(DihedralAngles, OfTheUnitCornerAreRightOnTheAxes)
{
    const auto angles_deg = pbs::dihedral_angles_deg({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    for (int e = 0; e < 3; ++e) EXPECT_NEAR(angles_deg[e], 90.0, of_angles_deg);
    for (int e = 3; e < 6; ++e) EXPECT_NEAR(angles_deg[e], std::acos(1.0 / std::sqrt(3.0)) * degree, of_angles_deg);
}

TEST(DihedralAngles, OfAFlatTetAreZeroOr180)
{
    for (const double angle_deg : pbs::dihedral_angles_deg({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}))
        EXPECT_TRUE(angle_deg == 0.0 || angle_deg == 180.0) << angle_deg;
}

TEST(DihedralAngles, OfACollapsedTetAreFinite)
{
    for (const double angle_deg : pbs::dihedral_angles_deg({1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3})) EXPECT_EQ(angle_deg, 0.0);
}

TEST(Quality, OfAKuhnSplitBar)
{
    const pbs::TetMesh bar = test_support::structured_bar({0, 0, 0}, {4, 3, 2}, {4, 3, 2});
    const pbs::Quality quality = pbs::quality_of(bar);
    EXPECT_EQ(quality.vertices, 5 * 4 * 3);
    EXPECT_EQ(quality.boundary_vertices, 5 * 4 * 3 - 3 * 2 * 1);
    EXPECT_EQ(quality.tets, 6 * 4 * 3 * 2);
    EXPECT_EQ(quality.boundary_triangles, 4 * (4 * 3 + 4 * 2 + 3 * 2));
    EXPECT_NEAR(quality.volume_m3, 24.0, test_support::volume_error(bar.rest, bar.tets));
    EXPECT_NEAR(quality.min_dihedral_deg, 45.0, of_angles_deg);  // Kuhn's tet: 45, 60 and 90 degrees
    EXPECT_NEAR(quality.max_dihedral_deg, 90.0, of_angles_deg);
    EXPECT_DOUBLE_EQ(quality.shortest_edge_m, 1.0);
    EXPECT_DOUBLE_EQ(quality.longest_edge_m, std::sqrt(3.0));
    EXPECT_TRUE(quality.topology.boundary_manifold);
    EXPECT_NE(pbs::describe(quality).find("boundary manifold, 1 component(s), Euler characteristic 2"), std::string::npos);
}

TEST(Quality, OfNothingIsZeros)
{
    const pbs::Quality quality = pbs::quality_of(pbs::TetMesh{pbs::Positions(0, 3), pbs::Tets(0, 4)});
    EXPECT_EQ(quality.tets, 0);
    EXPECT_EQ(quality.min_dihedral_deg, 0.0);
    EXPECT_EQ(quality.shortest_edge_m, 0.0);
}

}  // namespace
